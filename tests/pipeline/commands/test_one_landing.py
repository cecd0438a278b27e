"""One landing from a study file is the run of that number, and takes other numbers in its place."""

import json
from pathlib import Path

import h5py
import pytest
from typer.testing import CliRunner

from lithobrake.cli import app
from lithobrake.pipeline import land_one, landing_inputs
from lithobrake.pipeline.design.design import DrawnDesign
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.study import read_study
from lithobrake.study.touchdown_model import lander, landing
from lithobrake.touchdown import land

from ...few_grains import few_grains

TEXT = few_grains(30, 0.54, 0.05) + "region = { x = [-0.03, 0.03], y = [-0.02, 0.02] }\n"


@pytest.fixture
def study_file(tmp_path: Path) -> Path:
    """A study file of ten grains."""
    path = tmp_path / "ten.toml"
    path.write_text(TEXT)
    return path


def test_the_landing_of_a_number_is_that_run_but_for_what_is_changed(study_file: Path) -> None:
    study = read_study(study_file)
    plain = land_one(study, landing_inputs(study, number=1))
    changed = land_one(study, landing_inputs(study, ["grain.friction=0.55", "impact.speed = 0.3"], 1))
    row = DrawnDesign(study).rows[1]
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
        assert file["frames/position"].shape[1:] == (31, 3)
    asked = CliRunner().invoke(app, ["land", str(study_file), "--set", "impact.speed=0.3", "--json"])
    told = json.loads(asked.stdout)
    assert told["outcome"] == "clear"
    assert told["inputs"]["impact.speed"] == 0.3
    assert 0.0 < told["outputs"]["speed_out"] < 0.3


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--set", "grain.colour=1"], "--set names 'grain.colour', which no landing of this study uses"),
        (["--set", "impact.speed"], "--set is 'impact.speed'; allowed: KEY=VALUE"),
        (["--set", "impact.speed=fast"], "--set impact.speed is 'fast'; allowed: a number"),
        (["--set", "impact.speed=nan"], "--set impact.speed is nan; allowed: a finite number"),
        (["--set", "impact.speed=-1"], "--set: impact.speed is -1; allowed: above 0 and at most 1000 [m/s]"),
        (["--set", "lander.mass=0"], "--set: lander.mass is 0; allowed: above 0 [kg]"),
        (["--set", "impact.incidence_deg=100"], "--set: impact.incidence_deg is 100; allowed: at least 0 and below 90"),
        (["--set", "impact.place.x=3"], "--set: impact.place.x reaches from 3 to 3 m; allowed: -0.27 to 0.27 m"),
        (["--set", "grain.fricton=0.4"], "which no landing of this study uses; did you mean grain.friction?"),
        (["--set", "grain.friction=true"], "--set grain.friction is 'true'; allowed: a number"),
        (["--set", "grain.friction=0.4\ny=3"], "--set grain.friction is '0.4\\ny=3'; allowed: a number"),
        (["--set", "grain.friction=0.4 # more"], "--set grain.friction is '0.4 # more'; allowed: a number"),
        (["--set", "grain.friction=.5"], "--set grain.friction is '.5'; allowed: a number as in a study file"),
        (["--set", "grain.friction='0.4'"], "allowed: a number"),
        (["--set", f"grain.friction={'9' * 5000}"], "--set grain.friction is inf; allowed: a finite number"),
        (["--set", "bed=0.5"], "--set bed is 0.5; allowed: a whole number from 0 to 4294967295"),
        (["--set", "bed=1e300"], "--set bed is 1e+300; allowed: a whole number from 0 to 4294967295"),
        (["--number", "-1"], "the number of a run is -1; allowed: 0 to 239, the runs of the study"),
        (["--number", "1000000000"], "the number of a run is 1000000000; allowed: 0 to 239, the runs of the study"),
    ],
)
def test_what_cannot_be_landed_is_one_sentence(options: list[str], said: str, study_file: Path) -> None:
    refused = CliRunner().invoke(app, ["land", str(study_file), *options])
    assert refused.exit_code == 2
    assert said in refused.stderr
    assert len(refused.stderr.strip().splitlines()) == 1


@pytest.mark.parametrize("run", [0, 1, 119, 120, 599, 650])
def test_one_run_of_the_sequence_is_its_row(run: int, study_file: Path) -> None:
    study = read_study(study_file)
    assert DrawnDesign(study).row(run) == DrawnDesign(study).with_run_count(run + 1).rows[-1]


@pytest.mark.parametrize("changes", [[], ["grain.friction=0.55"], ["surface.gravity=3e-5"]])
def test_a_landing_feels_the_gravity_of_the_site(changes: list[str], tmp_path: Path) -> None:
    path = tmp_path / "site.toml"
    path.write_text(TEXT.replace("gravity = 1e-4", 'gravity = "site"') + '[site]\nbody = "dimorphos"\n')
    study = read_study(path)
    assert study.surface.gravity == "site"
    values = landing_inputs(study, changes)
    felt = with_site_gravity(study).surface.gravity
    assert isinstance(felt, float)
    assert values["surface.gravity"] == (3e-5 if "surface.gravity=3e-5" in changes else felt)
    found = land_one(study, values)
    assert found.landing.gravity == pytest.approx((0.0, 0.0, -values["surface.gravity"]))
    assert found.bed.gravity == pytest.approx((0.0, 0.0, -felt))


def test_a_solver_of_the_user_has_no_soil() -> None:
    with pytest.raises(ValueError, match="a solver of its own and no soil to land on"):
        landing_inputs(read_study(Path("examples/ball_on_plate.toml")))
