"""A whole study through the command line, on a bed of a few grains: every stage real, stopped and gone on with."""

import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import pytest

from lithobrake import run
from lithobrake.results import open_study
from lithobrake.results.study_files import json_values
from lithobrake.results.summary import Summary

from .command_line import lithobrake
from .few_grains import EXPANSION, ONE_IMPACT, few_grains
from .quick_studies import blank_pictures, quick_studies

STUDY = f"""title = "A few grains"
monte_carlo = {{ sample_count = 200 }}
site = {{ mass = {{ distribution = "uniform", lower = 5.0e11, upper = 5.6e11 }} }}
flight = {{ flight_count = 5, duration = 20000.0 }}
hard_ground = {{ count = 5 }}
{few_grains(45, width=0.5, lander_diameter=0.14, sides="walls")}{ONE_IMPACT}{EXPANSION}screening_level = 1
screening_degree = 1
refined_level = 1
refined_degree = 1
kept_outputs = ["speed_out"]
test_count = 2
"""
FILES = ("study.toml", "beds/bed_0.h5", "landing.h5", "runs.sqlite", "screening.json", "refined.json", "scores.json",
    "samples.h5", "flights.csv", "rest.csv", "summary.json", "report/index.html")  # fmt: skip


def command(study: Path, out: Path, workers: int) -> list[str]:
    return [sys.executable, "-m", "lithobrake", "run", str(study), "--out", str(out), "--workers", str(workers)]


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
def blank() -> Iterator[None]:
    with blank_pictures():
        yield


@pytest.fixture(scope="module")
def out(study: Path, blank: None) -> Path:
    folder = study.parent / "first"
    # Two processes make the runs; the study that is stopped has an interpreter of its own, as a user starts it.
    ended = lithobrake("run", study, "--out", folder, "--workers", 2)
    assert ended.returncode == 0, ended.stderr
    assert "Report: " in ended.stdout
    assert len(ended.stdout.strip().splitlines()) == len(summary(folder)["results"]["headline"]) + 1
    return folder


def test_every_file_is_there_and_the_summary_adds_up(out: Path) -> None:
    assert [name for name in FILES if not (out / name).is_file()] == []
    results = open_study(out).results
    analysis, samples = results.expansion, results.samples
    designs, shares = analysis.designs, samples.shares
    assert sum(designs["screening"].outcomes.values()) == designs["screening"].run_count == 5
    assert designs["test_all"].run_count == 2
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
    go_on(study, out, workers=2)
    assert {name: (out / name).stat().st_mtime_ns for name in before} == before


def test_a_deleted_file_is_made_again_with_the_same_bytes_and_nothing_before_it(study: Path, out: Path) -> None:
    before = {name: ((out / name).stat().st_mtime_ns, (out / name).read_bytes()) for name in FILES[1:]}
    (out / "samples.h5").unlink()
    (out / "flights.csv").unlink()
    go_on(study, out, workers=2)
    assert (out / "flights.csv").read_bytes() == before["flights.csv"][1]
    for name in ("beds/bed_0.h5", "landing.h5", "screening.json", "refined.json", "scores.json"):
        assert (out / name).stat().st_mtime_ns == before[name][0]


@pytest.mark.skipif(os.name != "posix", reason="signals of this kind exist on POSIX only")
def test_ctrl_c_keeps_the_runs_and_one_worker_ends_with_the_same_bits(study: Path, out: Path) -> None:
    other = study.parent / "second"
    # The bed and the landing at the medians are there already; all the rest is not.
    shutil.copytree(out / "beds", other / "beds")
    for name in ("landing.h5", "keys.json"):
        shutil.copy(out / name, other / name)
    process = subprocess.Popen(
        command(study, other, workers=1),
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        # Under tests that a shell runs in the background it would inherit that this signal is ignored.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    deadline = time.monotonic() + 300
    while finished_runs(other) < 2 and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.02)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "to continue, run the same command" in said
    assert "Traceback" not in said
    assert 2 <= finished_runs(other) < finished_runs(out)
    # To the summary: pages of the same numbers are the same bytes, which tests/report looks at.
    with quick_studies():
        run(study, other, workers=1, report=False)
    assert summary(other)["results"] == summary(out)["results"]
    assert summary(other)["study"] == summary(out)["study"]
    assert (other / "flights.csv").read_bytes() == (out / "flights.csv").read_bytes()
