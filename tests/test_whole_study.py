"""A whole study through the command line, on a bed of a few grains: every stage real, stopped, killed and gone on."""

import json
import os
import random
import shutil
import signal
import sqlite3
import time
from collections.abc import Iterator, Sequence
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

import h5py
import pytest

from lithobrake.pipeline import STAGES
from lithobrake.pipeline.first_touchdown import flights
from lithobrake.results import open_study
from lithobrake.results.study_files import json_values
from lithobrake.results.summary import Summary
from lithobrake.study import read_study

from .command_line import lithobrake
from .few_grains import EXPANSION, ONE_IMPACT, few_grains
from .pipeline.killed_studies import kill, ledger, start, wait_for_stage
from .quick_studies import blank_pictures, quick_studies

STUDY = f"""title = "A few grains"
seed = 2
campaign = {{ retry_count = 20 }}
monte_carlo = {{ sample_count = 200 }}
site = {{ mass = {{ distribution = "uniform", lower = 5.0e11, upper = 5.6e11 }} }}
flight = {{ flight_count = 5, duration = 20000.0 }}
hard_ground = {{ count = 5 }}
{few_grains(12, width=0.3, lander_diameter=0.1, sides="walls")}{ONE_IMPACT}{EXPANSION}screening_level = 2
screening_degree = 1
refined_level = 2
refined_degree = 1
kept_outputs = ["speed_out"]
test_count = 6
"""
SCREENING_RUNS, TEST_RUNS = 13, 6
PATH_PARTS = flights.PARTS
FILES = ("study.toml", "beds/bed_0.h5", "landing.h5", "runs.sqlite", "screening.json", "refined.json", "scores.json",
    "samples.h5", "flights.csv", "rest.csv", "summary.json", "report/index.html")  # fmt: skip


def go_on(study: Path, out: Path, workers: int) -> None:
    """Give the command for a study that is there, or a part of it."""
    ended = lithobrake("run", study, "--out", out, "--workers", workers)
    assert ended.returncode == 0, ended.stderr


def summary(out: Path) -> Summary:
    return open_study(out).summary


def finished_runs(out: Path) -> int:
    """How many runs the ledger has, seen from another process while it is written."""
    if not (out / "runs.sqlite").is_file():
        return 0
    try:
        with sqlite3.connect(f"file:{out / 'runs.sqlite'}?mode=ro", uri=True) as database:
            return int(database.execute("SELECT count(*) FROM runs WHERE status = 'done'").fetchone()[0])
    except sqlite3.OperationalError:
        return 0


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("whole") / "few.toml"
    path.write_text(STUDY)
    return path


@pytest.fixture(scope="module")
def quick() -> Iterator[None]:
    """One worker is this process. Paths have as many places as those of processes of their own, to be compared."""
    with quick_studies(), blank_pictures(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(flights, "PARTS", PATH_PARTS)
        yield


@pytest.fixture(scope="module")
def out(study: Path, quick: None) -> Path:
    folder = study.parent / "first"
    ended = lithobrake("run", study, "--out", folder, "--workers", 1)
    assert ended.returncode == 0, ended.stderr
    assert "Report: " in ended.stdout
    assert len(ended.stdout.strip().splitlines()) == len(summary(folder)["results"]["headline"]) + 1
    return folder


def test_every_file_is_there_and_the_summary_adds_up(out: Path) -> None:
    assert [name for name in FILES if not (out / name).is_file()] == []
    results = open_study(out).results
    analysis, samples = results.expansion, results.samples
    designs, shares = analysis.designs, samples.shares
    assert sum(designs["screening"].outcomes.values()) == designs["screening"].run_count == SCREENING_RUNS
    assert designs["test_all"].run_count == TEST_RUNS
    ends = ("captured", "left_sideways", "time_limit", "outside", "impact", "flying", "escaped")
    counts = [shares.outcomes[name].count for name in ends]
    assert sum(counts) == shares.sample_count
    assert shares.flight_count == sum(counts[4:])
    assert 0 < samples.outputs["speed_out"].mean < 0.4
    assert analysis.kept_share["speed_out"] >= 0.9


def test_every_key_that_soil_and_beds_write_has_a_field(out: Path) -> None:
    results = open_study(out)
    assert json_values(results.results) == results.summary["results"]
    assert results.beds.columns["surface_height_m"].units == "m"


def test_every_data_set_of_the_files_says_what_it_holds(out: Path) -> None:
    for name in ("samples.h5", "landing.h5", "beds/bed_0.h5"):
        sets: dict[str, Any] = {}
        with h5py.File(out / name) as file:
            file.visititems(sets.__setitem__)
            described = [
                {"units", "long_name"} <= set(entry.attrs) for entry in sets.values() if hasattr(entry, "shape")
            ]
        assert described
        assert all(described)


def test_the_same_command_on_a_finished_study_computes_nothing(study: Path, out: Path) -> None:
    before = {name: (out / name).stat().st_mtime_ns for name in FILES if name != "study.toml"}
    go_on(study, out, workers=1)
    assert {name: (out / name).stat().st_mtime_ns for name in before} == before


def test_a_deleted_file_is_made_again_with_the_same_bytes_and_nothing_before_it(study: Path, out: Path) -> None:
    before = {name: ((out / name).stat().st_mtime_ns, (out / name).read_bytes()) for name in FILES[1:]}
    (out / "samples.h5").unlink()
    (out / "flights.csv").unlink()
    go_on(study, out, workers=1)
    assert (out / "flights.csv").read_bytes() == before["flights.csv"][1]
    for name in ("beds/bed_0.h5", "landing.h5", "screening.json", "refined.json", "scores.json"):
        assert (out / name).stat().st_mtime_ns == before[name][0]


# Stages in which a study is stopped, one of each way in which files are made, and what ends; in a campaign, how many
# runs the ledger has then: 13 of the screening, and 12 tests in the end.
MOMENTS = (
    ("bed", "coordinator", None), ("screening_runs", "interrupt", range(2, 6)),
    ("screening_runs", "worker", range(7, 11)), ("test_runs", "both", range(15, 20)),
    ("fly", "coordinator", None), ("report", "coordinator", None),
)  # fmt: skip
# Other stages make theirs the same way, or end before a kill could hit them.
ALIKE = {"landing": "bed", "refined_runs": "test_runs", "sample": "fly", "paths": "fly", "hard_ground": "fly",
    "summary": "report"}  # fmt: skip
AT_ONCE = {"screen", "refine", "test"}


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="the processes are found in /proc (Linux)")
def test_a_study_stopped_and_killed_at_random_moments_ends_with_the_same_bits(
    study: Path, out: Path, tmp_path: Path
) -> None:
    asked, durations = read_study(study), json.loads((out / "keys.json").read_text())["wall_s"]
    files = {stage.name: stage.files(asked) for stage in STAGES if stage.files(asked)}
    assert {*(stage for stage, *_ in MOMENTS), *ALIKE} == set(files) - AT_ONCE
    killed, said, chance = tmp_path / "killed", tmp_path / "said.txt", random.Random(6)
    study, left = Path(shutil.copy(study, tmp_path)), list(MOMENTS)
    process = start(study, killed)
    while left:
        stage, victim, counts = left[0]
        # The very first moment is any at all, before there is a folder, too.
        wait_for_stage(process, killed, list(files).index(stage) + 1 if stage != "bed" else 0)
        if counts is None:
            time.sleep(chance.random() * durations[stage])
        else:
            wait_for_runs(process, killed, chance.choice(counts))
        if process.exitcode is None:
            stop(process, victim, killed, chance)
            left.pop(0)
        else:
            # It came to its end before its time, as it is faster now than the calm one was: what this stage has made is
            # taken away, and has to be made again.
            assert process.exitcode == 0, said.read_text()
            durations[stage] *= 0.5
            for name in files[stage]:
                (killed / name).unlink(missing_ok=True)
        if process.exitcode is not None:
            # Two workers, where one of them is killed next.
            process = start(study, killed, 2 if left and left[0][1] == "worker" else 1)
    process.join(timeout=600)
    assert process.exitcode == 0, said.read_text()
    check_same_bits(files, killed, out)


def wait_for_runs(process: BaseProcess, out: Path, count: int) -> None:
    while process.exitcode is None and finished_runs(out) < count:
        time.sleep(0.005)


def stop(process: BaseProcess, victim: str, out: Path, chance: random.Random) -> None:
    """Kill, or press Ctrl-C, which tells how to go on and keeps the runs."""
    if victim != "interrupt":
        return kill(process, victim, chance)
    assert process.pid is not None
    before = finished_runs(out)
    os.kill(process.pid, signal.SIGINT)
    process.join(timeout=60)
    said = (out.parent / "said.txt").read_text()
    assert process.exitcode == 130, said
    assert "to continue, run the same command" in said
    assert "Traceback" not in said
    # On a busy machine it comes late, after further runs.
    assert finished_runs(out) >= before >= 2


def check_same_bits(files: dict[str, Sequence[str]], killed: Path, out: Path) -> None:
    """All that does not name times and folders; of the summary, its results. The report shows nothing else."""
    assert ledger(killed) == ledger(out)
    for stage, names in files.items():
        for name in names if stage not in ("summary", "report") else ():
            assert (killed / name).read_bytes() == (out / name).read_bytes(), name
    assert summary(killed)["results"] == summary(out)["results"]
    assert summary(killed)["study"] == summary(out)["study"]
