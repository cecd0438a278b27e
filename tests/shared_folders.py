"""Folders that take long to make, made once for all processes of a run of the suite."""

import fcntl
import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest


def shared_folder(factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """The folder that `make` fills, of which the first process that asks for it is told the path.

    The others wait until it is whole. Tests read it; one that changes something takes a copy.
    """
    base = factory.getbasetemp()
    # Workers of pytest-xdist have a folder each in one of the run.
    place = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / f"shared_{name}"
    place.mkdir(exist_ok=True)
    folder, whole = place / "study", place / "whole"
    with open(place / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not whole.exists():
            shutil.rmtree(folder, ignore_errors=True)
            make(folder)
            whole.touch()
    return folder
