"""Campaigns of chains: how a run has ended decides what the next one is given, until its chain ends."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from typing import Any

from lithobrake.campaign.coordinator import Coordinator, PendingRun
from lithobrake.campaign.ledger import Ledger
from lithobrake.campaign.limits import Limits
from lithobrake.campaign.record import Record
from lithobrake.campaign.run_counts import Tally
from lithobrake.campaign.runs import RunOptions, given_or_own, is_known, pending_run, queue_runs
from lithobrake.campaign.seed_and_key import run_key
from lithobrake.campaign.single_run import Model

Inputs = Mapping[str, float]
# Inputs of the next run of a chain, by its number and its records so far; None: it has ended.
Next = Callable[[int, Sequence[Record]], Inputs | None]


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
        """Take in a run that has ended, and give what is to be made because of it."""
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
