"""The one process that hands out runs, tries failed ones again, and writes each end into the ledger."""

import queue
import time
from collections.abc import Callable, Mapping
from concurrent.futures import CancelledError, Executor, Future
from dataclasses import dataclass
from heapq import heappop, heappush
from pathlib import Path
from typing import Any

from lithobrake.campaign.executors import WorkerDiedError, submit_limited
from lithobrake.campaign.ledger import Ledger
from lithobrake.campaign.record import RunStatus, Tally, common_reasons
from lithobrake.campaign.single_run import Limits, Model, run_model
from lithobrake.campaign.worker import MainModuleError
from lithobrake.vocabulary.quantities import Row

# Runs handed out for each worker: enough that none waits for the coordinator.
_SUBMITTED_PER_WORKER = 2
# Workers to expect of an executor that does not say how many it has.
_UNKNOWN_COUNT = 32
# When so many runs, drawn by chance from all new ones, fail and none succeeds, the model does not work. Were half of
# the runs good, that would happen in one campaign of 1024; were 19 of 20 good, as they must be for a fit unless the
# study allows fewer, in one of 1e13. A smaller number would save little: what fails at once is cheap.
_TRIAL_RUNS = 10
# Turns of the runs that wait.
AT_ONCE, FIRST_TRY, LAST = range(3)
# Progress is shown at least this often, and which runs are under way is looked at [s].
_POLL_INTERVAL = 0.5


@dataclass(frozen=True)
class PendingRun:
    """A run that is to be made.

    attempts: how often it was tried in earlier campaigns. rank: runs of a lower one are made first, those of one rank
    in the order of their keys, which are hashes.
    """

    model: Model
    inputs: Row
    seed: int
    log: Path | None
    attempts: int
    rank: int = 0


@dataclass
class Coordinator:
    """A campaign under way.

    pending: the runs to make, by their keys; retry_count: further tries of a failed one; follow: gives the runs to make
    because the one with this key has ended, which the ledger has queued by then.
    """

    ledger: Ledger
    executor: Executor
    pending: dict[str, PendingRun]
    state: Tally
    limits: Limits
    retry_count: int
    progress: Callable[[Tally], None]
    follow: Callable[[str], Mapping[str, PendingRun]]

    def __post_init__(self) -> None:
        # By turn, rank and key: in the order of their hashes the first runs are a random part of all, wherever in the
        # design each stands.
        self.waiting = sorted((FIRST_TRY, run.rank, key) for key, run in self.pending.items())
        self.attempts = {key: run.attempts for key, run in self.pending.items()}
        # Runs that have failed before are no random part of the design: they likely fail again. Of ten runs or fewer
        # there is nothing to save by giving up.
        fresh = [key for _, _, key in self.waiting if not self.attempts[key]]
        self._trial = set(fresh[:_TRIAL_RUNS]) if len(fresh) > _TRIAL_RUNS else set()
        self._failed: set[str] = set()
        self.submitted: dict[Future[Any], str] = {}
        self._not_begun: list[Future[Any]] = []
        self._ended: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()

    def compute(self) -> None:
        """Make all runs.

        Raises OSError when the ledger cannot be written or the executor gives up, ValueError when nothing succeeds.
        """
        began = time.monotonic()
        self.progress(self.state)
        try:
            while self.waiting or self.submitted:
                self._submit()
                self._collect()
                self._end_what_never_works()
                self.state.seconds = time.monotonic() - began
                self.progress(self.state)
        except KeyboardInterrupt:
            # A run may have ended between two looks; it is kept too.
            for future, key in self.submitted.items():
                if future.done() and not future.cancelled() and future.exception() is None:
                    self.ledger.finish(key, future.result())
            raise

    def _submit(self) -> None:
        window = _SUBMITTED_PER_WORKER * getattr(self.executor, "capacity", _UNKNOWN_COUNT)
        while self.waiting and len(self.submitted) < window:
            key = heappop(self.waiting)[-1]
            run = self.pending[key]
            future = submit_limited(self.executor, self.limits, run_model, run.model, run.inputs, run.seed, run.log)
            self.submitted[future] = key
            self._not_begun.append(future)
            # Called in a thread of the executor: the queue is all that it shares with this one, so the ledger has one
            # writer.
            future.add_done_callback(self._ended.put)

    def _collect(self) -> None:
        try:
            ended = [self._ended.get(timeout=_POLL_INTERVAL)]
        except queue.Empty:
            ended = []
        while not self._ended.empty():
            ended.append(self._ended.get())
        for future in ended:
            self._finish(self.submitted[future], _result(future))
            del self.submitted[future]
        under_way = [future for future in self._not_begun if future in self.submitted]
        running = [future for future in under_way if future.running()]
        if running:
            self.ledger.start(self.submitted[future] for future in running)
        self._not_begun = [future for future in under_way if not future.running()]
        self.state.running = len(self.submitted) - len(self._not_begun)

    def _finish(self, key: str, result: Mapping[str, Any]) -> None:
        self.attempts[key] += 1
        if result["status"] == RunStatus.FAILED and self.attempts[key] <= self.retry_count:
            # Until something succeeds, its next try shows whether anything does.
            heappush(self.waiting, (AT_ONCE if self._trial else LAST, self.pending[key].rank, key))
            return
        self.ledger.finish(key, {**result, "attempts": self.attempts[key]})
        self.state.add(result["status"], result.get("outputs", {}))
        if result["status"] == RunStatus.FAILED:
            self._failed.add(key)
        else:
            # One success shows that the model works; what fails from here on is a matter of single runs.
            self._trial.clear()
        for one, run in self.follow(key).items():
            self.pending[one], self.attempts[one] = run, run.attempts
            heappush(self.waiting, (FIRST_TRY, run.rank, one))

    def _end_what_never_works(self) -> None:
        """Give up when the trial runs have all failed, their tries used up, and no other run has succeeded.

        Not their number but which ones counts: runs that fail may end long before those that do not.
        """
        left = len(self.waiting) + len(self.submitted)
        if not self._trial or not self._trial <= self._failed or not left:
            return
        # The cause is in the model or its installation; with their tries used up these runs would be holes in the
        # design of the corrected study.
        self.ledger.forget_tries(self._failed)
        reasons = common_reasons(record.reason for record in self.ledger.find(self._failed).values())
        raise ValueError(
            f"the first {len(self._failed)} runs have all failed ({reasons}), so the {left} that are left are not "
            "made; mend what makes them fail and give the same command again: it tries these anew and keeps what had "
            "ended before"
        )


def _result(future: "Future[Any]") -> Mapping[str, Any]:
    """How a run has ended.

    Raises MainModuleError for a model of a script that no process can import, ConnectionError when the executor takes
    no more runs, or cannot bring this one to a worker: what a run itself does wrong comes back as its result.
    """
    error = CancelledError("it was cancelled") if future.cancelled() else future.exception()
    if error is None:
        answer: Mapping[str, Any] = future.result()
        return answer
    if isinstance(error, MainModuleError):
        raise error
    if isinstance(error, WorkerDiedError):
        return {"status": RunStatus.FAILED, "reason": str(error), "wall_s": error.wall_s, "host": error.host}
    raise ConnectionError(
        f"the executor cannot make the runs ({type(error).__name__}: {error}); every run that had ended is kept: see "
        "that its workers are there and have the same code, and give the same command again"
    ) from error
