"""A campaign of runs or of chains of runs: each is computed once, and recorded the moment it ends."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lithobrake.campaign.coordinator import Coordinator, PendingRun
from lithobrake.campaign.executors import LocalExecutor
from lithobrake.campaign.ledger import Ledger
from lithobrake.campaign.record import Record, RunStatus, Tally
from lithobrake.campaign.single_run import Limits, Model, run_key, run_seed
from lithobrake.vocabulary.quantities import Row

if TYPE_CHECKING:
    import numpy as np

Inputs = Mapping[str, float]
# Inputs of the next run of a chain, by its number and its records so far; None: it has ended.
Next = Callable[[int, Sequence[Record]], Inputs | None]


@dataclass(frozen=True)
class Runs:
    """The runs of a campaign in the order of its rows; reused_count: of the distinct ones, known before it began."""

    records: list[Record]
    reused_count: int

    @property
    def outcomes(self) -> list[str]:
        """How each run ended: in the model's own word, or "failed"."""
        return [record.outcome or RunStatus.FAILED.value for record in self.records]

    @property
    def reasons(self) -> list[str | None]:
        """Why each run failed; None where it has not."""
        return [record.reason if record.status == RunStatus.FAILED else None for record in self.records]

    def outputs(self, names: Sequence[str]) -> "np.ndarray":
        """Outputs, shape [run_count, len(names)]; NaN where a run has failed or has no such output."""
        import numpy as np

        rows = [[record.outputs.get(name, math.nan) for name in names] for record in self.records]
        return np.array(rows, dtype=float).reshape(len(rows), len(names))


@dataclass(frozen=True)
class RunOptions:
    """Seed, replicate, retries and log folder of a campaign.

    seed: of the random numbers of all runs; replicate: another one repeats the same inputs with other random numbers.
    retry_count: how often a failed run is tried again. log_folder: takes what each run prints; None keeps nothing.
    """

    seed: int = 0
    replicate: int = 0
    retry_count: int = 0
    log_folder: Path | None = None


def run(
    model: Model,
    x: "np.ndarray",
    *,
    names: Sequence[str],
    ledger: Ledger,
    context: Mapping[str, Any] | None = None,
    executor: Executor | None = None,
    limits: Limits | None = None,
    options: RunOptions | None = None,
    progress: Callable[[Tally], None] | None = None,
) -> Runs:
    """Run a model on every row of an array; read runs that the ledger has from it.

    x: inputs, shape [run_count, len(names)]. context: whatever else the results depend on, as JSON values; "version"
    stands in the ledger. executor: with the interface of concurrent.futures (None: the cores of this machine). limits:
    of one run. progress: called as the campaign goes on.
    A run that raises, or whose process dies, is recorded as failed with its reason, and the campaign goes on.
    Raises ValueError for a model that is none, and when the first ten of more than ten new runs all fail.
    """
    rows, chosen = _inputs_of(x, names), options or RunOptions()
    chains = _Chains(model, _ends_at_once, ledger, context or {}, chosen, in_order=False)
    keys = [chains.key(row) for row in rows]
    distinct = dict(zip(keys, rows, strict=True))
    made = chains.compute(list(distinct.values()), executor, limits, progress)
    records = {key: record for key, (record,) in zip(distinct, made, strict=True)}
    return Runs([records[key] for key in keys], reused_count=chains.state.reused)


def _ends_at_once(chain: int, records: Sequence[Record]) -> None:
    """A run on its own is a chain of one."""


def _callable(model: Model) -> Model:
    """The model. Raises ValueError for what cannot be called."""
    if not callable(model):
        raise ValueError(f"model is {model!r}; allowed: a function of the inputs by name and a seed")
    return model


def _inputs_of(x: "np.ndarray", names: Sequence[str]) -> list[Row]:
    """The inputs of each row by name. Raises ValueError for rows that do not fit the names or are not finite."""
    import numpy as np

    table = np.asarray(x, dtype=float)
    if table.ndim != 2 or table.shape[1] != len(names):
        raise ValueError(
            f"x has shape {table.shape}; allowed: [run_count, {len(names)}], one column for each of the names"
        )
    if repeated := [name for number, name in enumerate(names) if name in names[:number]]:
        raise ValueError(f"names has {repeated[0]!r} twice; allowed: a name of its own for each column of x")
    if not np.isfinite(table).all():
        raise ValueError("x holds values that are not finite; every input of a run must be a number")
    return [dict(zip(names, row.tolist(), strict=True)) for row in table]


@dataclass
class _Chains:
    """Chains of runs under way: records of each so far, and the number of the chain of each run that is to be made.

    in_order: whether chains are ended in the order of their numbers, as far as there are workers.
    """

    model: Model
    then: Next
    ledger: Ledger
    context: Mapping[str, Any]
    options: RunOptions
    in_order: bool
    records: list[list[Record]] = field(default_factory=list)
    state: Tally = field(default_factory=lambda: Tally(0))
    chains: dict[str, int] = field(default_factory=dict)

    def compute(
        self,
        first: Sequence[Inputs],
        executor: Executor | None,
        limits: Limits | None,
        progress: Callable[[Tally], None] | None,
    ) -> list[list[Record]]:
        """Make the chains that begin with these inputs; give the records of each."""
        self.records = [[] for _ in first]
        pending = self._walk(dict(enumerate(first)))
        self._queue(pending, adds=False)
        with nullcontext(executor) if executor is not None else _own_executor() as workers:
            Coordinator(
                *(self.ledger, workers, pending, self.state, limits or Limits(), self.options.retry_count),
                *(progress or (lambda state: None), self._follow),
            ).compute()
        return self.records

    def key(self, row: Inputs) -> str:
        """The key of the run of these inputs."""
        return run_key(row, self.options.seed, self.options.replicate, self.context)

    def _walk(self, rows: Mapping[int, Inputs]) -> dict[str, PendingRun]:
        """Follow chains from their next inputs on through all that the ledger knows; give the runs to make then."""
        pending: dict[str, PendingRun] = {}
        while rows:
            keys = {self.key(row): (chain, row) for chain, row in rows.items()}
            if len(keys) < len(rows) or not keys.keys().isdisjoint(self.chains):
                raise ValueError("two chains have runs with the same inputs; give each an input of its own")
            # All chains go one link further together.
            found, rows = self.ledger.find(keys), {}
            for key, (chain, row) in keys.items():
                entry = found.get(key)
                if entry is not None and (entry.status == RunStatus.DONE or entry.attempts > self.options.retry_count):
                    self.state.reused += 1
                    self.state.total += 1
                    self.state.add(entry.status, entry.outputs)
                    rows |= self._after(chain, entry)
                else:
                    self.chains[key] = chain
                    rank, attempts = chain if self.in_order else 0, 0 if entry is None else entry.attempts
                    pending[key] = self._pending(key, dict(row), attempts, rank)
        self.state.total += len(pending)
        return pending

    def _pending(self, key: str, row: Row, attempts: int, rank: int) -> PendingRun:
        options = self.options
        log = options.log_folder and options.log_folder / f"{key}.log"
        return PendingRun(
            _callable(self.model), row, run_seed(row, options.seed, options.replicate), log, attempts, rank
        )

    def _queue(self, pending: Mapping[str, PendingRun], *, adds: bool) -> None:
        """Enter runs that are to be made into the ledger; adds: beside those that were queued before."""
        entries = [(key, entry.inputs, entry.seed, self.options.replicate) for key, entry in pending.items()]
        self.ledger.queue(entries, version=str(self.context.get("version", "")), adds=adds)

    def _follow(self, key: str) -> dict[str, PendingRun]:
        record = self.ledger.find([key]).get(key)
        if record is None:
            raise ValueError(f"{self.ledger.path} lost run {key} while it was open; give the same command again")
        pending = self._walk(self._after(self.chains.pop(key), record))
        if pending:
            self._queue(pending, adds=True)
        return pending

    def _after(self, chain: int, record: Record) -> dict[int, Inputs]:
        self.records[chain].append(record)
        row = self.then(chain, self.records[chain])
        return {} if row is None else {chain: row}


@contextmanager
def _own_executor() -> Iterator[Executor]:
    own = LocalExecutor()
    try:
        yield own
    finally:
        own.shutdown(cancel_futures=True)


def run_chains(
    model: Model,
    first: Sequence[Inputs],
    then: Next,
    *,
    ledger: Ledger,
    context: Mapping[str, Any] | None = None,
    executor: Executor | None = None,
    limits: Limits | None = None,
    options: RunOptions | None = None,
    progress: Callable[[Tally], None] | None = None,
) -> list[list[Record]]:
    """Run a model along chains, and give the records of each; read runs that the ledger has from it.

    first: inputs of the first run of each. then: called in this process each time that a run has ended, failed ones
    included; it must give the same inputs for the same records. A chain that has begun goes on before another begins:
    those that have ended at any time are then the first ones, and not the shortest. All else is as of `run`.
    Raises ValueError where two chains ask for the same run, and as `run` does.
    """
    return _Chains(model, then, ledger, context or {}, options or RunOptions(), in_order=True).compute(
        first, executor, limits, progress
    )
