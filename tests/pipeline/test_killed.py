"""Kill -9 of the coordinator, of a worker, of both, at 20 random moments: the study ends with the same bits."""

import json
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
from lithobrake.pipeline import stages_of
from lithobrake.results import open_study
from lithobrake.study import read_study

from ..few_grains import few_grains

STUDY = (
    "seed = 2"
    + few_grains(12, width=0.3, lander_diameter=0.1)
    + """[campaign]
retry_count = 20
[design]
method = "paper"
screening_level = 2
screening_degree = 1
refined_level = 2
refined_degree = 1
kept_outputs = ["speed_out"]
test_count = 6
[monte_carlo]
sample_count = 500
[flight]
flight_count = 10
duration = 20000.0
[rest]
count = 10
"""
)
# Of each run, what it follows from and what came of it; not where, when and how fast it was made, or how often tried.
DETERMINED = "key, status, outcome, inputs, draws, outputs, seed, replicate, reason, version"
# Stages in which to kill; those in which much is made several times. Fits and scores end within a blink, before a kill
# could hit them.
MOMENTS = (
    *["bed"] * 3, "landing", *["screening_runs"] * 5, *["refined_runs"] * 3, *["test_runs"] * 3, "sample", "fly",
    "rest", "summary", "report",
)  # fmt: skip
AT_ONCE = {"screen", "refine", "test"}
MAKE_RUNS = ("screening_runs", "refined_runs", "test_runs")
LEDGER = ("runs.sqlite", "runs.sqlite-wal", "runs.sqlite-shm")
VICTIMS = ("coordinator", "worker", "both")

pytestmark = pytest.mark.skipif(not Path("/proc").is_dir(), reason="the processes are found in /proc (Linux)")


# Each start is a process of its own, forked from one that has imported what a study needs: two dozen interpreters that
# import it would take longer than all that they are killed in.
FORKS = multiprocessing.get_context("forkserver")
FORKS.set_forkserver_preload(["lithobrake.cli", "lithobrake.pipeline.stages", "lithobrake.report", "scipy.stats"])
COMMAND = """
import os, sys
said = os.open({said!r}, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
os.dup2(said, 1), os.dup2(said, 2)
sys.argv = ["lithobrake", "run", {study!r}, "--out", {out!r}, "--workers", {workers!r}]
from lithobrake.cli import app
app()
"""


def start(study: Path, out: Path, worker_count: int = 1) -> BaseProcess:
    told = {"study": str(study), "out": str(out), "said": str(study.parent / "said.txt"), "workers": str(worker_count)}
    process = FORKS.Process(target=exec, args=(COMMAND.format(**told), {}))
    process.start()
    return process


def end(study: Path, out: Path, worker_count: int = 1) -> None:
    """Run a study to its end, undisturbed."""
    process = start(study, out, worker_count)
    process.join(timeout=1200)
    assert process.exitcode == 0, (study.parent / "said.txt").read_text()


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


def test_a_study_killed_at_20_random_moments_ends_with_the_same_bits(tmp_path: Path) -> None:
    study, calm, killed = tmp_path / "few.toml", tmp_path / "calm", tmp_path / "killed"
    study.write_text(STUDY)
    # The first time kernels may be compiled; the second time tells how long the stages take.
    for out in (tmp_path / "first", calm):
        end(study, out, worker_count=2)
    durations = json.loads((calm / "keys.json").read_text())["wall_s"]
    asked = read_study(study)
    files = {stage.name: stage.files(asked) for stage in stages_of(asked)}
    assert set(MOMENTS) == set(files) - AT_ONCE
    chance, kills, process = random.Random(6), 0, start(study, killed)
    while kills < len(MOMENTS):
        stage = MOMENTS[kills]
        # The very first moment is any at all, before there is a folder, too.
        wait_for_stage(process, killed, list(files).index(stage) + 1 if kills else 0)
        time.sleep(chance.random() * durations[stage])
        if process.exitcode is None:
            kill(process, VICTIMS[kills % len(VICTIMS)], chance)
            kills += 1
        else:
            # It came to its end before its time: what this stage has made is taken away, and has to be made again.
            for name in (*files[stage], *(LEDGER if stage in MAKE_RUNS else ())):
                (killed / name).unlink(missing_ok=True)
        if process.exitcode is not None:
            process = start(study, killed)
    process.kill()
    process.join()
    end(study, killed)
    assert ledger(killed) == ledger(calm)
    # Summary and report name times and folders; the summary's results are compared below.
    for stage, names in files.items():
        for name in names if stage not in ("summary", "report") else ():
            assert (killed / name).read_bytes() == (calm / name).read_bytes(), name
    summaries = [open_study(out).summary for out in (killed, calm)]
    assert summaries[0]["results"] == summaries[1]["results"]
    assert summaries[0]["study"] == summaries[1]["study"]
