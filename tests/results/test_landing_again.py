"""A touchdown of a study made once more, for its frames: the numbers of the ledger, bit for bit, or a refusal."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from lithobrake.pipeline import run_study
from lithobrake.results import StudyResults, open_study
from lithobrake.study import StudySource

from ..few_grains import EXPANSION, few_grains
from ..ledger_rows import edit_rows

STUDY = (
    few_grains(30, width=0.45, lander_diameter=0.12, friction="0.7", sides="walls")
    + f"""place = {{ x = 0.08, y = 0.0 }}
{EXPANSION}screening_level = 1
screening_degree = 1
kept_outputs = ["speed_out"]
"""
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a study on a bed of a few grains, up to its screening runs."""
    home = tmp_path_factory.mktemp("again")
    (home / "few.toml").write_text(STUDY)
    run_study(StudySource.read(home / "few.toml"), home / "out", until="screening_runs", worker_count=1)
    return home / "out"


@pytest.fixture
def copied(folder: Path, tmp_path: Path) -> Path:
    """A copy elsewhere, which a test may spoil."""
    return Path(shutil.copytree(folder, tmp_path / "copied"))


def set_runs(folder: Path, column: str, value: str) -> StudyResults:
    """Another value in a column of all runs of a ledger."""
    edit_rows(folder / "runs.sqlite", f"{column} = ?", (value,))
    return open_study(folder)


def test_a_landing_again_has_the_numbers_of_the_ledger_and_writes_nothing(copied: Path) -> None:
    results = open_study(copied)
    before = {path: path.stat().st_mtime_ns for path in copied.rglob("*")}
    records = {record.key: record for record in results.ledger}
    for row, key in enumerate(results.runs["key"]):
        outcome = results.landing(row, frame_count=5)
        assert outcome.status == records[key].outcome
        found = {name: value for name, value in outcome.outputs.items() if not np.isnan(value)}
        assert found == records[key].outputs
        assert outcome.frames["position"].shape[1:] == (31, 3)
        assert outcome.frames["orientation"].shape[1:] == (31, 4)
        # A landing that is over after few looks has no more frames than looks.
        assert len(outcome.frames["time"]) >= 3
    assert {path: path.stat().st_mtime_ns for path in copied.rglob("*")} == before


def test_a_run_is_named_by_its_key_or_how_that_begins(folder: Path) -> None:
    results = open_study(folder)
    key = str(results.runs["key"][1])
    by_key, by_row = results.landing(key[:12], frame_count=1), results.landing(1, frame_count=1)
    assert by_key.outputs == by_row.outputs


@pytest.mark.parametrize("run", [-1, 3, "", "no such key"])
def test_a_run_that_is_none_of_the_study_is_refused(run: str | int, folder: Path) -> None:
    with pytest.raises(ValueError, match=r"of the 3 runs of .* have; give a row of its table `runs`, from 0"):
        open_study(folder).landing(run)


def test_a_run_of_an_own_program_is_refused(copied: Path) -> None:
    with pytest.raises(ValueError, match="was made by a program or function of the study's own"):
        set_runs(copied, "version", "0.1.0").landing(0)


def test_a_run_that_failed_is_refused_with_its_reason(copied: Path) -> None:
    set_runs(copied, "reason", "ValueError: through the floor")
    edit_rows(copied / "runs.sqlite", "status = 'failed', outcome = NULL")
    with pytest.raises(ValueError, match=r"has no outcome \(ValueError: through the floor\); choose a run that has"):
        open_study(copied).landing(0)


def test_other_code_is_refused_before_anything_lands(copied: Path) -> None:
    with pytest.raises(ValueError, match=r"was made by the code 0\.1\.0\+0123, and this is .*make the study again"):
        set_runs(copied, "version", "0.1.0+0123").landing(0)


def test_a_bed_that_is_gone_and_a_landing_that_comes_out_otherwise_are_refused(copied: Path) -> None:
    (copied / "study.toml").write_text(STUDY.replace("steps_per_contact = 20.0", "steps_per_contact = 25.0"))
    with pytest.raises(ValueError, match=r"and landing again gave .*: the study, its bed or this machine is another"):
        open_study(copied).landing(0)
    (copied / "beds" / "bed_0.h5").unlink()
    with pytest.raises(ValueError, match=r"beds/bed_0\.h5, the bed of run \w+, is not there; make it again with"):
        open_study(copied).landing(0)
