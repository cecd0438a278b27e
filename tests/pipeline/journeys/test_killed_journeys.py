"""Kill -9 of a worker, and of the coordinator and a worker, amid journeys on soil; a Dask cluster that loses a worker.

The body of the study rolls, and its page is made.
"""

import contextlib
import random
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from multiprocessing.process import BaseProcess
from pathlib import Path

import numpy as np
import pytest

import lithobrake
from lithobrake.campaign import Ledger, RunStatus, read_records
from lithobrake.pipeline.job import Silent
from lithobrake.pipeline.journeys.campaign import JOURNEY_FILES
from lithobrake.pipeline.site import Site
from lithobrake.pipeline.study_run import run_study
from lithobrake.report import write_report
from lithobrake.smallbody import fly
from lithobrake.study import StudySource, read_study

from ..killed_studies import kill, ledger, start
from .soil_journeys import STUDY

# What is killed when the ledger has so many touchdowns; there are 8 in all. That a study goes on alike after its
# coordinator alone was killed, at any stage, tests/test_whole_study.py shows. The cluster has two workers.
KILLED = {1: "worker", 4: "both"}
WORKERS = 1
ROLLING = STUDY.replace("\nsite = { ", "\nsite = { rotation = { yaw_deg = 30.0, roll_deg = 60.0 }, ").replace(
    "count = 6", "count = 2"
)
ROOT = Path(__file__).parents[3]
TABLES = (*JOURNEY_FILES, "designs/drawn.csv", "designs/touchdowns.csv", "run_flights.csv")

pytestmark = pytest.mark.skipif(not Path("/proc").is_dir(), reason="the processes are found in /proc (Linux)")


@pytest.fixture(scope="module")
def calm(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the study, never killed, whose touchdowns are made one after the other."""
    folder = tmp_path_factory.mktemp("calm")
    (folder / "soil.toml").write_text(ROLLING)
    return lithobrake.run(folder / "soil.toml", folder / "out", workers=1, report=False).folder


@pytest.fixture
def begun(calm: Path, tmp_path: Path) -> Path:
    """A folder that has the beds of the study and nothing of its journeys, beside the study file."""
    shutil.copy(calm.parent / "soil.toml", tmp_path)
    shutil.copytree(calm, tmp_path / "out", ignore=shutil.ignore_patterns("runs.sqlite*", *JOURNEY_FILES, "designs"))
    # A ledger that is being made is there a moment before its table.
    Ledger(tmp_path / "out" / "runs.sqlite").close()
    return tmp_path / "out"


def ended(out: Path) -> dict[str, str | None]:
    """When each touchdown ended that the ledger has, by its key."""
    return {one.key: one.ended for one in read_records(out / "runs.sqlite") if one.status == RunStatus.DONE}


def wait_for_touchdowns(process: BaseProcess, out: Path, count: int) -> None:
    while len(ended(out)) < count:
        assert process.exitcode is None, (out.parent / "said.txt").read_text()
        time.sleep(0.02)


def assert_same(out: Path, calm: Path) -> None:
    assert ledger(out) == ledger(calm)
    for name in TABLES:
        assert (out / name).read_bytes() == (calm / name).read_bytes(), name


def test_journeys_that_are_killed_end_with_the_same_bits(calm: Path, begun: Path) -> None:
    study, chance = begun.parent / "soil.toml", random.Random(3)
    process = start(study, begun, WORKERS)
    for moment, victim in KILLED.items():
        wait_for_touchdowns(process, begun, moment)
        kill(process, victim, chance)
    assert process.exitcode is not None
    records, before = read_records(begun / "runs.sqlite"), ended(begun)
    assert len(before) >= max(KILLED)
    # What was in progress is all that is lost.
    assert sum(one.status == RunStatus.RUNNING for one in records) <= WORKERS
    run_study(StudySource.read(study), begun, until="fly_runs", worker_count=1)
    assert before.items() <= ended(begun).items()
    assert_same(begun, calm)


class Loses(Silent):
    """Shows nothing, and kills a worker of the cluster once the ledger has some touchdowns."""

    def __init__(self, worker: "subprocess.Popen[bytes]", out: Path) -> None:
        self.worker, self.out = worker, out

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        if what == "journeys" and self.worker.poll() is None and len(ended(self.out)) >= min(KILLED):
            self.worker.kill()
            self.worker.wait()


@contextlib.contextmanager
def cluster_of_two(folder: Path) -> Iterator[tuple[str, "subprocess.Popen[bytes]"]]:
    """The address of a scheduler in this process, and a worker that may be killed; another is a thread of this one."""
    distributed = pytest.importorskip(
        "distributed", reason="distributed is not installed (pip install lithobrake[dask])"
    )
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, processes=False, protocol="tcp://", host="127.0.0.1",
            dashboard_address=None, local_directory=str(folder),
        ) as made,
        distributed.Client(made, set_as_default=False) as client,
    ):  # fmt: skip
        command = [sys.executable, "-m", "distributed.cli.dask_worker", made.scheduler_address, "--nthreads", "1"]
        command += ["--no-nanny", "--no-dashboard", "--local-directory", str(folder)]
        worker = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            client.wait_for_workers(2, timeout=60)
            yield made.scheduler_address, worker
        finally:
            worker.kill()
            worker.wait()


def test_journeys_on_a_cluster_that_loses_a_worker_end_with_the_same_bits(calm: Path, begun: Path) -> None:
    with cluster_of_two(begun.parent) as (address, worker):
        source, shown = StudySource.read(begun.parent / "soil.toml"), Loses(worker, begun)
        run_study(source, begun, until="fly_runs", scheduler=address, shown=shown)
        assert worker.poll() is not None
    assert_same(begun, calm)


def test_the_page_of_a_study_on_soil_of_a_body_that_rolls(calm: Path) -> None:
    """Flights begin at the times of that motion, and end as the next touchdowns begin; on the page all landers rest."""
    results = lithobrake.open_study(calm)
    page = write_report(calm).read_text(encoding="utf-8")
    assert '<p class="answer">100&nbsp;% (' in page[: page.index("</header>")]
    body, arcs, touchdowns = Site(read_study(calm / "study.toml")).body, results.arcs, results.touchdowns
    state = [np.column_stack([arcs[f"{of}_{axis}"] for axis in "xyz"]) for of in ("position", "velocity")]
    number = {(int(a), int(b)): k for k, (a, b) in enumerate(zip(arcs["sample"], arcs["arc"], strict=True))}
    after = np.flatnonzero(touchdowns["touchdown"] > 0)
    flights = [number[int(touchdowns["journey"][k]), int(touchdowns["touchdown"][k]) - 1] for k in after]
    speed = touchdowns["impact.speed"][after]
    again = fly(body, *state, 1e5, gravity="table", start_time=arcs["clock_s"])
    assert again.impact_speed[flights] == pytest.approx(speed, rel=1e-6)
    uniform = fly(replace(body, rotation=None), *state, 1e5, gravity="table", start_time=arcs["clock_s"])
    assert np.abs(uniform.impact_speed[flights] / speed - 1.0).max() > 0.01
