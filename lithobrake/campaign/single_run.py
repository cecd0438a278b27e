"""One run: a model, its inputs and its seed, in the process that this is called in."""

import contextlib
import io
import json
import math
import os
import platform
import reprlib
import time
import traceback
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from lithobrake.campaign.capped_log import CappedLog
from lithobrake.campaign.record import RunStatus, utc_now

# A model takes its inputs by name and a seed. It gives its outputs by name, or {"outcome": text, "outputs": numbers by
# name, "draws": JSON values}; an output that is NaN has no value.
Model = Callable[[dict[str, float], int], Mapping[str, Any]]


def run_model(model: Model, inputs: dict[str, float], seed: int, log: Path | None = None) -> dict[str, Any]:
    """Make one run; what it raises becomes the reason of a failed run.

    log: file that takes what the model prints, and where in it an error arose.
    """
    started, wall, cpu = utc_now(), time.perf_counter(), _cpu_time()
    with _logged(log, inputs, seed):
        try:
            result = _checked(model(inputs, seed))
        # Whatever a user's model raises is the reason of that run's failure, and no reason to end the campaign.
        except (Exception, SystemExit) as error:
            result = {"status": RunStatus.FAILED, "reason": f"{type(error).__name__}: {error}"}
            if log is not None:
                traceback.print_exc()
        result |= {"wall_s": time.perf_counter() - wall, "cpu_s": _cpu_time() - cpu}
        if log is not None:
            print(json.dumps(result))
    return result | {"started": started, "host": platform.node() or f"process {os.getpid()}"}


def _checked(answer: Mapping[str, Any]) -> dict[str, Any]:
    """What a model gave, as the ledger keeps it. Raises FloatingPointError for infinite outputs."""
    whole = answer if "outputs" in answer else {"outputs": answer}
    outputs = {name: float(value) for name, value in whole["outputs"].items() if not math.isnan(value)}
    infinite = [name for name, value in outputs.items() if math.isinf(value)]
    if infinite:
        raise FloatingPointError(f"the outputs {', '.join(infinite)} are infinite")
    outcome, draws = str(whole.get("outcome", "done")), dict(whole.get("draws", {}))
    # What the ledger cannot hold is this run's failure, not the campaign's.
    try:
        json.dumps(draws, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise ValueError(f"the draws are {reprlib.repr(draws)}; allowed: finite numbers and texts by name") from error
    return {"status": RunStatus.DONE, "outcome": outcome, "outputs": outputs, "draws": draws}


def _cpu_time() -> float:
    """CPU time of this thread and of the programs that it has waited for [s]."""
    times = os.times()
    return time.thread_time() + times.children_user + times.children_system


@contextlib.contextmanager
def _logged(log: Path | None, inputs: Mapping[str, float], seed: int) -> Iterator[None]:
    if log is None:
        yield
        return
    log.parent.mkdir(parents=True, exist_ok=True)
    with (
        io.TextIOWrapper(io.BufferedWriter(CappedLog(log)), "utf-8", "backslashreplace", line_buffering=True) as file,
        contextlib.redirect_stdout(file),
        contextlib.redirect_stderr(file),
    ):
        print(json.dumps({"inputs": dict(inputs), "seed": seed}))
        yield
