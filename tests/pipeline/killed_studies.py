"""Studies in processes of their own that are killed, with their workers, by the signal that nobody can catch."""

import multiprocessing
import os
import random
import signal
import sqlite3
import time
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

import pytest

from lithobrake.files.atomic import lock_holder

# Of each run, what it follows from and what came of it; not where, when and how fast it was made, or how often tried.
DETERMINED = "key, status, outcome, inputs, draws, outputs, seed, replicate, reason, version"
# Each start is a process of its own, forked from one that has imported what a study needs: two dozen interpreters that
# import it would take longer than all that they are killed in.
FORKS = multiprocessing.get_context("forkserver")
FORKS.set_forkserver_preload(["loaded_study"])
# Pictures are drawn, and saved as empty ones: letters are what takes long to save.
COMMAND = """
import os, signal, sys
from functools import cache
from matplotlib.figure import Figure
from lithobrake.report import reports
said = os.open({said!r}, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
os.dup2(said, 1), os.dup2(said, 2)
# Where the tests run in the background they ignore interrupts.
signal.signal(signal.SIGINT, signal.default_int_handler)
saved = reports._saved
blank = cache(lambda kind: saved(Figure(figsize=(1.0, 1.0)), kind))
reports._saved = lambda figure, kind: blank(kind)
sys.argv = ["lithobrake", {word!r}, {study!r}, "--out", {out!r}, "--workers", {workers!r}]
from lithobrake.cli import app
app()
"""


def start(study: Path, out: Path, worker_count: int = 1, word: str = "run") -> BaseProcess:
    """Start a command of a study; what it says is in said.txt beside the study file."""
    told = {"study": str(study), "out": str(out), "said": str(study.parent / "said.txt"), "workers": str(worker_count)}
    told["word"] = word
    process = FORKS.Process(target=exec, args=(COMMAND.format(**told), {}))
    with pytest.MonkeyPatch.context() as patch:
        # Where the server of forks, which the first of them starts, finds what it loads.
        patch.setenv("PYTHONPATH", str(Path(__file__).parent), prepend=os.pathsep)
        process.start()
    return process


def workers(coordinator: int) -> list[int]:
    """The processes that the coordinator has started to make runs."""
    found = []
    for path in Path("/proc").glob("[0-9]*"):
        try:
            parent = int((path / "stat").read_text().rpartition(")")[2].split()[1])
            if parent == coordinator and "lithobrake.campaign.worker" in (path / "cmdline").read_text():
                found.append(int(path.name))
        except (FileNotFoundError, ProcessLookupError):
            continue
    return found


def wait_for_stage(process: BaseProcess, out: Path, number: int) -> None:
    """Wait until the study has come to a stage, or has ended."""
    while process.exitcode is None:
        holder = lock_holder(out / ".lock")
        if number == 0 or (holder is not None and holder.get("number", 0) >= number):
            return
        time.sleep(0.01)


def is_alive(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def kill(process: BaseProcess, victim: str, chance: random.Random) -> None:
    """Kill by the signal that nobody can catch; a coordinator that is killed takes its workers along."""
    assert process.pid is not None
    others = workers(process.pid)
    if victim == "worker" and others:
        os.kill(chance.choice(others), signal.SIGKILL)
        return
    if victim == "both" and others:
        os.kill(chance.choice(others), signal.SIGKILL)
    process.kill()
    process.join()
    limit = time.monotonic() + 30
    while any(is_alive(other) for other in others):
        assert time.monotonic() < limit, "workers outlive their coordinator"
        time.sleep(0.01)


def ledger(out: Path) -> list[tuple[Any, ...]]:
    with sqlite3.connect(out / "runs.sqlite") as database:
        rows = database.execute(f"SELECT {DETERMINED} FROM runs ORDER BY key").fetchall()
    database.close()
    return rows
