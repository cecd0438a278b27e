"""A campaign: the rows of an array through a model, each computed once, recorded the moment it ends."""

import math
import os
import platform
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass
from typing import Any

import numpy as np

from lithobrake.campaign.identity import run_key, run_seed
from lithobrake.campaign.ledger import Ledger, Record
from lithobrake.campaign.local import LocalExecutor

# A model takes its inputs by name and a seed, and gives {"outcome": text, "outputs": numbers, "draws": JSON values}.
Model = Callable[[dict[str, float], int], Mapping[str, Any]]


@dataclass(frozen=True)
class Runs:
    """The runs of a campaign in the order of its rows."""

    records: list[Record]
    reused_count: int

    @property
    def outcomes(self) -> list[str]:
        """How each run ended: the model's own word, or "failed"."""
        return [record.outcome or "failed" for record in self.records]

    def outputs(self, names: Sequence[str]) -> np.ndarray:
        """Outputs, shape [run_count, len(names)]; NaN where a run has failed or has no such output."""
        rows = [[record.outputs.get(name, math.nan) for name in names] for record in self.records]
        return np.array(rows, dtype=float).reshape(len(rows), len(names))


def run(
    model: Model,
    x: np.ndarray,
    *,
    names: Sequence[str],
    ledger: Ledger,
    fixed: Mapping[str, float] | None = None,
    context: Mapping[str, Any] | None = None,
    seed: int = 0,
    replicate: int = 0,
    executor: Executor | None = None,
    worker_count: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Runs:
    """Run a model on every row of an array; runs that the ledger knows are read from it.

    x: inputs, shape [run_count, len(names)], in the units of the model. fixed: inputs that are the same in all rows.
    context: whatever else the results depend on, as JSON values. executor: anything with the interface of
    concurrent.futures (None: the cores of this machine, `worker_count` of them). progress: called with runs done and
    runs in all.
    A run that raises is recorded as failed with its reason, and the campaign goes on.
    """
    inputs = _inputs_of(x, names, fixed or {})
    keys = [run_key(row, seed, replicate, context or {}) for row in inputs]
    known = ledger.find(keys)
    todo = {key: row for key, row in zip(keys, inputs, strict=True) if key not in known}
    jobs = {key: (model, row, run_seed(row, seed, replicate)) for key, row in todo.items()}
    version = str((context or {}).get("version", ""))
    ledger.queue(((key, row, job_seed, replicate) for key, (_, row, job_seed) in jobs.items()), version)
    total, left = len(set(keys)), set(jobs)

    def record(key: str, result: Mapping[str, Any]) -> None:
        ledger.finish(key, result)
        left.discard(key)
        if progress:
            progress(total - len(left), total)

    if progress:
        progress(total - len(left), total)
    if jobs and executor:
        _compute(jobs, executor, record)
    elif jobs:
        with LocalExecutor(worker_count) as own:
            try:
                _compute(jobs, own, record)
            finally:
                own.shutdown(cancel_futures=True)
    records = ledger.find(keys)
    return Runs([records[key] for key in keys], reused_count=len(known))


def _inputs_of(x: np.ndarray, names: Sequence[str], fixed: Mapping[str, float]) -> list[dict[str, float]]:
    """The inputs of each row by name. Raises ValueError for rows that do not fit the names or are not finite."""
    table = np.asarray(x, dtype=float)
    if table.ndim != 2 or table.shape[1] != len(names):
        raise ValueError(
            f"x has shape {table.shape}; allowed: [run_count, {len(names)}], one column for each of the names"
        )
    if not np.isfinite(table).all():
        raise ValueError("x holds values that are not finite; every input of a run must be a number")
    return [{**fixed, **dict(zip(names, row.tolist(), strict=True))} for row in table]


def _compute(jobs: dict[str, Any], executor: Executor, record: Callable[[str, Mapping[str, Any]], None]) -> None:
    """Run the jobs; when a worker dies, the runs that were under way go again, one at a time, to find the culprit."""
    # Twice as many as cores keep the workers busy; few enough that the suspects of a dead worker stay few.
    window = 2 * getattr(executor, "worker_count", 64)
    waiting, suspects = deque(jobs), deque[str]()
    flying: dict[str, Future[Any]] = {}
    try:
        while waiting or suspects or flying:
            while waiting and not suspects and len(flying) < window:
                key = waiting.popleft()
                flying[key] = executor.submit(perform, *jobs[key])
            alone = bool(suspects) and not flying
            if alone:
                key = suspects.popleft()
                flying[key] = executor.submit(perform, *jobs[key])
            wait(flying.values(), return_when=FIRST_COMPLETED)
            for key in [key for key, future in flying.items() if future.done()]:
                result = _result(flying[key], alone)
                if result is None:
                    suspects.append(key)
                else:
                    record(key, result)
                del flying[key]
    except KeyboardInterrupt:
        # A run may have ended between two looks; it is kept too.
        for key, future in flying.items():
            if future.done() and not future.cancelled() and future.exception() is None:
                record(key, future.result())
        raise


def _result(future: "Future[Any]", alone: bool) -> Mapping[str, Any] | None:
    """The result of a run that has ended; None when its worker died and other runs may be to blame."""
    error = future.exception()
    if error is None:
        answer: Mapping[str, Any] = future.result()
        return answer
    if not isinstance(error, BrokenExecutor):
        return {"status": "failed", "reason": f"{type(error).__name__}: {error}"}
    return {"status": "failed", "reason": "its process died"} if alone else None


def perform(model: Model, inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """Make one run in the process that this is called in; what it raises becomes the reason of a failed run."""
    wall, cpu = time.perf_counter(), time.process_time()
    result: dict[str, Any]
    try:
        answer = model(inputs, seed)
        outputs = {name: float(value) for name, value in answer.get("outputs", {}).items() if not math.isnan(value)}
        infinite = [name for name, value in outputs.items() if math.isinf(value)]
        if infinite:
            raise FloatingPointError(f"the outputs {', '.join(infinite)} are infinite")
        result = {"status": "done", "outcome": str(answer.get("outcome", "done")), "outputs": outputs}
        result["draws"] = dict(answer.get("draws", {}))
    # Whatever a user's model raises is the reason of that run's failure, and no reason to end the campaign.
    except Exception as error:
        result = {"status": "failed", "reason": f"{type(error).__name__}: {error}"}
    result |= {"wall_s": time.perf_counter() - wall, "cpu_s": time.process_time() - cpu}
    return result | {"host": platform.node() or f"process {os.getpid()}"}
