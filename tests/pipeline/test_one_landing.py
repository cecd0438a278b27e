"""One landing from a study file is the run of that number, and takes other numbers in its place."""

import json
from pathlib import Path

import h5py
import pytest
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.pipeline import land_one, landing_inputs
from lithobrake.pipeline.sequence import sequence_rows
from lithobrake.study import read_study
from lithobrake.touchdown import land
from lithobrake.touchdown_model import lander, landing

from ..few_grains import few_grains

TEXT = few_grains(10, 0.3, 0.05) + "region = { x = [-0.03, 0.03], y = [-0.02, 0.02] }\n"


@pytest.fixture
def study_file(tmp_path: Path) -> Path:
    """A study file of ten grains."""
    path = tmp_path / "ten.toml"
    path.write_text(TEXT)
    return path


def test_the_landing_of_a_number_is_that_run_but_for_what_is_changed(study_file: Path) -> None:
    study = read_study(study_file)
    plain = land_one(study, landing_inputs(study, number=2))
    changed = land_one(study, landing_inputs(study, ["grain.friction=0.55", "impact.speed = 0.3"], 2))
    row = sequence_rows(study, 2)[-1]
    assert plain.values == row
    assert changed.values == {**row, "grain.friction": 0.55, "impact.speed": 0.3}
    again = land(plain.bed, lander(study, row), landing(study, row))
    assert plain.outcome.outputs == pytest.approx(again.outputs, nan_ok=True, rel=0.0)
    assert (changed.bed.position == plain.bed.position).all()
    assert changed.outcome.outputs["peak_acceleration"] < plain.outcome.outputs["peak_acceleration"]


def test_the_command_tells_what_came_out_and_keeps_the_motion(study_file: Path, tmp_path: Path) -> None:
    motion = tmp_path / "landing.h5"
    shown = CliRunner().invoke(app, ["land", str(study_file), "--out", str(motion)])
    assert shown.exit_code == 0, shown.output
    assert "The landing ended as clear after" in shown.stdout
    assert "m/s    speed after the touchdown" in shown.stdout
    with h5py.File(motion) as file:
        assert file["frames/position"].shape[1:] == (11, 3)
    asked = CliRunner().invoke(app, ["land", str(study_file), "--set", "impact.speed=0.3", "--json"])
    told = json.loads(asked.stdout)
    assert told["outcome"] == "clear"
    assert told["inputs"]["impact.speed"] == 0.3
    assert 0.0 < told["outputs"]["speed_out"] < 0.3


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--set", "grain.colour=1"], "--set names 'grain.colour', which no landing of this study reads; it reads"),
        (["--set", "impact.speed"], "--set is 'impact.speed'; allowed: KEY=VALUE"),
        (["--set", "impact.speed=fast"], "--set impact.speed is 'fast'; allowed: a number"),
        (["--set", "impact.speed=nan"], "--set impact.speed is nan; allowed: a finite number"),
        (["--set", "impact.speed=-1"], "impact.speed is -1.0; allowed is a finite value above 0 m/s"),
        (["--set", "bed=0.5"], "--set bed is 0.5; allowed: a whole number from 0 on"),
        (["--number", "0"], "the number of a run is 0; allowed: a whole number of at least 1"),
    ],
)
def test_what_cannot_be_landed_is_one_sentence(options: list[str], said: str, study_file: Path) -> None:
    refused = CliRunner().invoke(app, ["land", str(study_file), *options])
    assert refused.exit_code == 2
    assert said in refused.stderr
    assert len(refused.stderr.strip().splitlines()) == 1


def test_a_solver_of_the_user_has_no_soil() -> None:
    with pytest.raises(ValueError, match="a solver of its own and no soil to land on"):
        landing_inputs(read_study(Path("examples/ball_on_plate.toml")))
