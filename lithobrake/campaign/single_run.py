"""One run: a model, its inputs and its seed, the limits of what it may take, and its log."""

import contextlib
import hashlib
import io
import json
import math
import os
import platform
import reprlib
import time
import traceback
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lithobrake.campaign.record import RunStatus, utc_now
from lithobrake.vocabulary.quantities import Row

# Bytes kept of the beginning, and at least of the end; the end may be twice as long until its first half is dropped.
# A program that repeats a warning at every step would fill the disk; what it read stands at the beginning, and why it
# ended at the end (docs/decisions/campaign.md).
KEPT = 1 << 20
# A model takes its inputs by name and a seed. It gives its outputs by name, or {"outcome": text, "outputs": numbers by
# name, "draws": JSON values}; an output that is NaN has no value.
Model = Callable[[Row, int], Mapping[str, Any]]


class CappedLog(io.RawIOBase):
    """A file to write into; of more than 3 MiB the first is kept, and what came last, at least 1 MiB of it.

    What has been written is on the disk at once, so the last words of a process that is ended are there too.
    """

    def __init__(self, path: Path) -> None:
        self._file = path.open("w+b")
        self._dropped = 0

    def writable(self) -> bool:
        return True

    def write(self, content: Any, /) -> int:
        view = memoryview(content)
        for start in range(0, len(view), KEPT):
            self._file.write(view[start : start + KEPT])
            if self._file.tell() > 3 * KEPT:
                self._drop_the_middle()
        self._file.flush()
        return len(view)

    def _drop_the_middle(self) -> None:
        end = self._file.tell()
        self._file.seek(end - KEPT)
        last = self._file.read()
        # The sentence about what was dropped before goes with it.
        self._dropped += end - 2 * KEPT - len(self._notice() if self._dropped else b"")
        self._file.seek(KEPT)
        self._file.truncate()
        self._file.write(self._notice() + last)

    def _notice(self) -> bytes:
        return f"\n... {self._dropped} bytes are left out here ...\n".encode()

    def close(self) -> None:
        self._file.close()
        super().close()


def last_words(path: Path) -> str:
    """The last line of a log that is not blank, at most 200 characters of it."""
    if not path.is_file():
        return "its log is no longer there"
    with path.open("rb") as file:
        size = file.seek(0, io.SEEK_END)
        file.seek(max(size - KEPT, 0))
        lines = file.read().decode("utf-8", "replace").splitlines()
    return next((line.strip()[-200:] for line in reversed(lines) if line.strip()), "it printed nothing")


def run_model(model: Model, inputs: Row, seed: int, log: Path | None = None) -> dict[str, Any]:
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
    given = {name: output_number(name, value) for name, value in whole["outputs"].items()}
    outputs = {name: value for name, value in given.items() if not math.isnan(value)}
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


def output_number(name: str, value: Any) -> float:
    """An output of a model as a float. Raises ValueError for text, true and false, and what is no number."""
    truth = isinstance(value, bool) or str(getattr(value, "dtype", "")) == "bool"
    try:
        if not truth and not isinstance(value, str | bytes):
            return float(value)
    except (TypeError, ValueError, OverflowError):
        pass
    raise ValueError(f"the model gave {reprlib.repr(value)} for {name}; allowed: a number, NaN where it has none")


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
        # A text that UTF-8 cannot hold must not end the run that prints it.
        io.TextIOWrapper(io.BufferedWriter(CappedLog(log)), "utf-8", "backslashreplace", line_buffering=True) as file,
        contextlib.redirect_stdout(file),
        contextlib.redirect_stderr(file),
    ):
        print(json.dumps({"inputs": dict(inputs), "seed": seed}))
        yield


@dataclass(frozen=True)
class Limits:
    """Limits of one run, its child processes included: wall time [s] and memory [bytes].

    Raises ValueError for a limit that is not above 0, and for a memory limit where memory cannot be measured.
    """

    wall_s: float = math.inf
    memory_bytes: float = math.inf

    def __post_init__(self) -> None:
        for name, unit in (("wall_s", "s"), ("memory_bytes", "bytes")):
            if not getattr(self, name) > 0:
                raise ValueError(
                    f"Limits.{name} is {getattr(self, name)}; allowed: above 0 {unit}; leave it out for none"
                )
        if self.memory_bytes < math.inf and not Path("/proc/self/stat").exists():
            raise ValueError(
                f"Limits.memory_bytes is {self.memory_bytes:g}; memory is measured on Linux only: leave the limit out"
            )

    def exceeded(self, wall_s: float, memory_bytes: float) -> str | None:
        """The reason why a run must end; None while it may continue."""
        if wall_s > self.wall_s:
            return f"it ran longer than its limit of {self.wall_s:g} s"
        if memory_bytes > self.memory_bytes:
            return f"it held {memory_bytes:.3g} bytes of memory, more than its limit of {self.memory_bytes:.3g}"
        return None


def run_key(inputs: Mapping[str, float], seed: int, replicate: int, context: Mapping[str, Any]) -> str:
    """Key of a run: the hash of everything that determines its result.

    inputs: every number that the model is given. seed: seed of the study. replicate: which repetition.
    context: whatever else the result depends on (options, versions), as JSON values.
    """
    return _hash({"inputs": dict(inputs), "seed": seed, "replicate": replicate, "context": dict(context)}).hex()


def run_seed(inputs: Mapping[str, float], seed: int, replicate: int) -> int:
    """Seed of the random draws of one run; below 2**53, so that it is the same number in JSON and SQLite."""
    digest = _hash({"inputs": dict(inputs), "seed": seed, "replicate": replicate})
    return int.from_bytes(digest[:8], "big") >> 11


def _hash(value: Mapping[str, Any]) -> bytes:
    # Python writes the shortest text that reads back as the same float, so equal texts are equal bits.
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).digest()
