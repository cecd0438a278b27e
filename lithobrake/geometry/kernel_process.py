"""Reading kernels of SPICE in another process, which NAIF's library may end where a kernel is damaged."""

import importlib
import importlib.util
import io
import json
import os
import signal
import subprocess
import sys
import warnings
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

INSTALL = 'pip install "lithobrake[spice]"'
# Shapes of millions of plates take some seconds; a damaged kernel may lead round in a circle [s].
TIME_LIMIT = 300.0
_PROGRAM = f"from {__name__} import answer; answer()"


def spice() -> Any:
    """The package spiceypy. Raises ImportError, with how to install it, where it is absent."""
    try:
        return importlib.import_module("spiceypy")
    except ImportError as error:
        raise ImportError(f"spiceypy, which reads the kernels of SPICE, is not installed: {INSTALL}") from error


class Reply(NamedTuple):
    """What a call gave: arrays or numbers, or the words of its ValueError, and those of its warnings."""

    values: list[NDArray[Any]]
    refusal: str | None
    warnings: list[str]

    def unpacked(self, stacklevel: int = 2) -> list[NDArray[Any]]:
        """The values; warns, with the stack level of `warnings.warn`, and raises as the call did."""
        for text in self.warnings:
            warnings.warn(text, stacklevel=stacklevel + 1)
        if self.refusal is not None:
            raise ValueError(self.refusal)
        return self.values


def read_apart(
    function: Callable[..., Sequence[Any]], *arguments: str | int | Sequence[str], kernels: Sequence[str]
) -> Reply:
    """What a function of a module gives for these arguments, called in another process.

    Raises ValueError that names the kernels where the process ends without a reply, ImportError without spiceypy.
    """
    if importlib.util.find_spec("spiceypy") is None:
        spice()
    asked = json.dumps({"module": function.__module__, "name": function.__name__, "arguments": arguments})
    # The process finds modules where this one does, and nowhere else.
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(path or os.getcwd() for path in sys.path)}
    words = [sys.executable, "-P", "-c", _PROGRAM]
    try:
        done = subprocess.run(
            words, input=asked.encode(), capture_output=True, env=environment, timeout=TIME_LIMIT, check=False
        )
    except subprocess.TimeoutExpired:
        raise _damaged(kernels, f"reading lasted more than {TIME_LIMIT:g} s") from None
    if done.returncode < 0:
        raise _damaged(kernels, f"SPICE ended by {signal.Signals(-done.returncode).name}")
    if done.returncode > 0:
        raise _damaged(kernels, (done.stderr.decode(errors="replace").strip().splitlines() or ["no word"])[-1])
    heading, _, content = done.stdout.partition(b"\n")
    told = json.loads(heading)
    with np.load(io.BytesIO(content), allow_pickle=False) as file:
        return Reply([file[name] for name in file.files], told["refusal"], told["warnings"])


def answer() -> None:
    """Make the call that standard input names, and write what comes of it to standard output."""
    # What SPICE prints must not come among it.
    output = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    asked = json.load(sys.stdin)
    function = getattr(importlib.import_module(asked["module"]), asked["name"])
    found: Sequence[Any] = ()
    refusal = None
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            found = function(*asked["arguments"])
        except ValueError as error:
            refusal = str(error)
    told = {"refusal": refusal, "warnings": [str(one.message) for one in caught]}
    with output:
        output.write(json.dumps(told).encode() + b"\n")
        np.savez(output, *(np.asarray(one) for one in found))


def _damaged(kernels: Sequence[str], words: str) -> ValueError:
    return ValueError(f"{', '.join(kernels)}: not a kernel that SPICE can read ({words}); fetch it again")
