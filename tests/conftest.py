"""What holds for all tests."""

import gc
import os
import sys
from functools import cache

import pytest
import typer.testing

# The suite runs in two processes; linear algebra with threads of its own in each would have them wait for one another,
# which costs many times what it gains on arrays of this size. Set before NumPy is imported for the first time.
for name in ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ.setdefault(name, "1")
# Beds that a test needs are poured: the tests of the library have one of their own.
os.environ["LITHOBRAKE_BED_LIBRARY_GB"] = "0"

# A program of an example begins with python3: this interpreter, and none that a manager of versions chooses at each
# start, which takes eight times as long as the program.
os.environ["PATH"] = os.pathsep.join([os.path.dirname(sys.executable), os.environ.get("PATH", os.defpath)])

# Commands and their options are put together once in a process, as for a user, and not at each call of a test.
typer.testing._get_command = cache(typer.testing._get_command)

# Files that come first. One compiles all kernels of the engine, which the others then find, and another one that calls
# none of them runs meanwhile. Then those that take long, the longest first: at the end one process would work on them
# while the other waits.
LONGEST = (
    "test_kernels.py", "test_calibration.py",
    "test_whole_study.py", "test_examples.py", "test_drawn_journeys.py", "test_killed_journeys.py",
    "test_pouring.py", "test_notebooks.py", "test_aiming.py", "test_state.py", "test_recreate.py",
)  # fmt: skip


def pytest_configure(config: pytest.Config) -> None:
    """Have pytest-xdist take the files in their order; by itself it begins with those of most tests."""
    if hasattr(config.option, "loadscopereorder"):
        config.option.loadscopereorder = False
    _keep_bytecode(config)


def _keep_bytecode(config: pytest.Config) -> None:
    """Where Python is told to keep no bytecode, keep it in a folder of pytest's, off the sources.

    Every process that a test starts would otherwise compile the sources of SciPy, Numba and Matplotlib anew, which
    takes longer than what it is started for.
    """
    if sys.dont_write_bytecode and hasattr(config, "cache"):
        folder = str(config.cache.mkdir("bytecode"))
        sys.dont_write_bytecode, sys.pycache_prefix = False, folder
        os.environ["PYTHONPYCACHEPREFIX"] = folder
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def pytest_collection_finish() -> None:
    """Take what was imported out of what is searched for garbage, which takes a second each time."""
    gc.freeze()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the tests of the longest files in front, and leave all else in its order."""
    items.sort(key=lambda item: LONGEST.index(item.path.name) if item.path.name in LONGEST else len(LONGEST))
