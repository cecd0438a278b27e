"""A campaign of runs or of chains of runs: each is computed once, and recorded the moment it ends."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lithobrake.campaign.coordinator import Coordinator, PendingRun
from lithobrake.campaign.executors import LocalExecutor
from lithobrake.campaign.ledger import Ledger
from lithobrake.campaign.record import Record, RunStatus, Tally
from lithobrake.campaign.single_run import Limits, Model, run_key, run_seed

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
    """Settings that few campaigns need.

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
    rows, context, options = _inputs_of(x, names), context or {}, options or RunOptions()
    keys = [run_key(row, options.seed, options.replicate, context) for row in rows]
    found = ledger.find(keys)
    known = {key: entry for key, entry in found.items() if is_known(entry, options)}
    pending = {
        key: pending_run(model, key, row, found.get(key), options)
        for key, row in zip(keys, rows, strict=True)
        if key not in known
    }
    queue_runs(ledger, pending, context, options)
    state, show = _state(keys, known), progress or (lambda state: None)
    with given_or_own(executor) as workers:
        Coordinator(ledger, workers, pending, state, limits or Limits(), options.retry_count, show).compute()
    records = ledger.find(keys)
    if lost := [key for key in keys if key not in records]:
        raise ValueError(f"{ledger.path} lost run {lost[0]} while it was open; give the same command again")
    return Runs([records[key] for key in keys], reused_count=len(known))


def is_known(entry: Record, options: RunOptions) -> bool:
    """Whether a run that the ledger has is not made again."""
    return entry.status == RunStatus.DONE or entry.attempts > options.retry_count


def pending_run(
    model: Model, key: str, row: dict[str, float], found: Record | None, options: RunOptions
) -> PendingRun:  # fmt: skip
    """A run that is to be made, of which the ledger has found nothing, or a failed try."""
    seed = run_seed(row, options.seed, options.replicate)
    log = options.log_folder and options.log_folder / f"{key}.log"
    return PendingRun(_callable(model), row, seed, log, 0 if found is None else found.attempts)


def queue_runs(
    ledger: Ledger, pending: Mapping[str, PendingRun], context: Mapping[str, Any], options: RunOptions, *,
    adds: bool = False,
) -> None:  # fmt: skip
    """Enter runs that are to be made into the ledger; adds: beside those that were queued before."""
    entries = [(key, entry.inputs, entry.seed, options.replicate) for key, entry in pending.items()]
    ledger.queue(entries, version=str(context.get("version", "")), adds=adds)


def _state(keys: Sequence[str], known: Mapping[str, Record]) -> Tally:
    state = Tally(len(set(keys)), reused=len(known))
    for entry in known.values():
        state.add(entry.status, entry.outputs)
    return state


def _callable(model: Model) -> Model:
    """The model. Raises ValueError for what cannot be called."""
    if not callable(model):
        raise ValueError(f"model is {model!r}; allowed: a function of the inputs by name and a seed")
    return model


def _inputs_of(x: "np.ndarray", names: Sequence[str]) -> list[dict[str, float]]:
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


@contextmanager
def given_or_own(executor: Executor | None) -> Iterator[Executor]:
    if executor is not None:
        yield executor
        return
    own = LocalExecutor()
    try:
        yield own
    finally:
        own.shutdown(cancel_futures=True)


@dataclass
class _Links:
    """Chains under way: records of each so far, and the number of the chain of each run that is to be made."""

    model: Model
    then: Next
    ledger: Ledger
    context: Mapping[str, Any]
    options: RunOptions
    records: list[list[Record]]
    state: Tally
    chains: dict[str, int] = field(default_factory=dict)

    def walk(self, rows: Mapping[int, Inputs]) -> dict[str, PendingRun]:
        """Follow chains from their next inputs on through all that the ledger knows; give the runs to make then."""
        pending: dict[str, PendingRun] = {}
        while rows:
            keys = {self._key(row): (chain, row) for chain, row in rows.items()}
            if len(keys) < len(rows) or not keys.keys().isdisjoint(self.chains):
                raise ValueError("two chains have runs with the same inputs; give each an input of its own")
            # All chains go one link further together, with one query for all of them.
            found, rows = self.ledger.find(keys), {}
            for key, (chain, row) in keys.items():
                entry = found.get(key)
                if entry is not None and is_known(entry, self.options):
                    self.state.reused += 1
                    self._count(entry)
                    rows |= self._after(chain, entry)
                else:
                    self.chains[key] = chain
                    pending[key] = pending_run(self.model, key, dict(row), entry, self.options)
        self.state.total += len(pending)
        return pending

    def follow(self, key: str) -> dict[str, PendingRun]:
        record = self.ledger.find([key]).get(key)
        if record is None:
            raise ValueError(f"{self.ledger.path} lost run {key} while it was open; give the same command again")
        pending = self.walk(self._after(self.chains.pop(key), record))
        if pending:
            queue_runs(self.ledger, pending, self.context, self.options, adds=True)
        return pending

    def _after(self, chain: int, record: Record) -> dict[int, Inputs]:
        self.records[chain].append(record)
        row = self.then(chain, self.records[chain])
        return {} if row is None else {chain: row}

    def _count(self, record: Record) -> None:
        self.state.total += 1
        self.state.add(record.status, record.outputs)

    def _key(self, row: Inputs) -> str:
        return run_key(row, self.options.seed, self.options.replicate, self.context)


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
    included; it must give the same inputs for the same records. All else is as of `run`.
    Raises ValueError where two chains ask for the same run, and as `run` does.
    """
    options, state = options or RunOptions(), Tally(0)
    links = _Links(model, then, ledger, context or {}, options, [[] for _ in first], state)
    pending = links.walk(dict(enumerate(first)))
    queue_runs(ledger, pending, links.context, options)
    show = progress or (lambda state: None)
    with given_or_own(executor) as workers:
        Coordinator(
            ledger, workers, pending, state, limits or Limits(), options.retry_count, show, links.follow
        ).compute()  # fmt: skip
    return links.records
