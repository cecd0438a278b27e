"""Models that workers can import."""

import math
import multiprocessing
import os
import signal
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any


def parabola(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A model that needs no engine."""
    return {"outcome": "clear", "outputs": {"height": inputs["a"] ** 2 + inputs["b"]}, "draws": {"seed": seed}}


def breaks_at_two(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    if inputs["a"] == 2.0:
        raise FloatingPointError("the overlap grew without bound")
    return parabola(inputs, seed)


def dies_at_two(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    if inputs["a"] == 2.0:
        os.kill(os.getpid(), signal.SIGKILL)
    return parabola(inputs, seed)


def captured_below_two(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A model with an outcome that has no height."""
    if inputs["a"] < 2.0:
        return {"outcome": "captured", "outputs": {"height": float("nan"), "depth": 0.1}}
    return parabola(inputs, seed)


def sleeps_at_two(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    if inputs["a"] == 2.0:
        time.sleep(600)
    return parabola(inputs, seed)


def swells_at_two(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A model that holds half a gigabyte at one point, and does not end."""
    if inputs["a"] == 2.0:
        filled = bytearray(os.urandom(1 << 20) * 512)
        time.sleep(600)
        return {"height": float(len(filled))}
    return parabola(inputs, seed)


class FailsOnce:
    """A model whose first run at each point fails; a file remembers."""

    def __init__(self, folder: Path, how: str) -> None:
        self.folder, self.how = folder, how

    def __call__(self, inputs: dict[str, float], seed: int) -> dict[str, Any]:
        mark = self.folder / f"{inputs['a']}"
        if not mark.exists():
            mark.touch()
            if self.how == "dies":
                os.kill(os.getpid(), signal.SIGKILL)
            raise OSError("no licence is free")
        return parabola(inputs, seed)


@dataclass(frozen=True)
class WorksAbove:
    """A model that works between two values of its first input alone; files count how often it was asked."""

    lower: float
    folder: Path
    upper: float = math.inf

    def __call__(self, inputs: dict[str, float], seed: int) -> dict[str, Any]:
        mark = self.folder / f"tried_{inputs['a']}"
        mark.write_text(str(int(mark.read_text()) + 1 if mark.exists() else 1))
        if not self.lower < inputs["a"] < self.upper:
            raise OSError("no [/licence]")
        return parabola(inputs, seed)


def talks(inputs: dict[str, float], seed: int) -> dict[str, float]:
    """A model that says what it does, gives its outputs alone, and breaks at one point."""
    print("rolling on", inputs["a"])
    if inputs["a"] == 2.0:
        raise FloatingPointError("the overlap grew without bound")
    return {"height": inputs["a"]}


def sleeps_a_little(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    time.sleep(0.8)
    return parabola(inputs, seed)


def sleeps_a_moment(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    time.sleep(0.05)
    return parabola(inputs, seed)


def sleeps_at_ten(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    if inputs["a"] == 10.0:
        time.sleep(600)
    return parabola(inputs, seed)


def threads(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A model that tells how its process was started and how many threads its libraries may take."""
    import numba

    counts = {name.lower(): float(os.environ[name]) for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")}
    is_spawned = multiprocessing.get_start_method() == "spawn"
    return {**counts, "numba": float(numba.get_num_threads()), "is_spawned": float(is_spawned)}


def collatz(inputs: dict[str, float], seed: int) -> dict[str, float]:
    value = inputs["value"]
    return {"value": 3.0 * value + 1.0 if value % 2.0 else value / 2.0}


def collatz_after_a_moment(inputs: dict[str, float], seed: int) -> dict[str, float]:
    time.sleep(0.02)
    return collatz(inputs, seed)


def collatz_without_ten(inputs: dict[str, float], seed: int) -> dict[str, float]:
    if inputs["value"] % 10.0 == 0.0:
        raise ValueError("ten is not known")
    return collatz(inputs, seed)
