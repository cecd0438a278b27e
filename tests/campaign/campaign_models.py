"""Models that workers can import."""

import os
import signal
from typing import Any


def parabola(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A model that needs no engine."""
    return {"outcome": "clear", "outputs": {"height": inputs["a"] ** 2 + inputs["b"]}, "draws": {"seed": seed}}


def breaks_at_two(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A model that diverges at one point."""
    if inputs["a"] == 2.0:
        raise FloatingPointError("the overlap grew without bound")
    return parabola(inputs, seed)


def dies_at_two(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A model that takes its process with it."""
    if inputs["a"] == 2.0:
        os.kill(os.getpid(), signal.SIGKILL)
    return parabola(inputs, seed)


def captured_below_two(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A model with an outcome that has no height."""
    if inputs["a"] < 2.0:
        return {"outcome": "captured", "outputs": {"height": float("nan"), "depth": 0.1}}
    return parabola(inputs, seed)
