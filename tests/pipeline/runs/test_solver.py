"""Runs: what a solver may answer, the energy that bounds them, and landers with parts."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.campaign import Record, Runs, RunStatus
from lithobrake.pipeline import StudyFolder, run_study
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import attitude_terms
from lithobrake.pipeline.runs.energy_bound import energy_bound, energy_warning, gyrations
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.runs.solver import FunctionModel, SolverModel
from lithobrake.results import open_study
from lithobrake.study import Study, StudySource, check_tables
from lithobrake.touchdown.lander_model import lander

from ...few_grains import few_grains
from ..synthetic_lander import synthetic_tables

VELOCITY = {"velocity_out_x": 0.03, "velocity_out_y": -0.02, "velocity_out_z": 0.06}
CLEAR = {**VELOCITY, "spin_out": 1.5}

SPIN = {"spin_out_x": 1.0, "spin_out_y": -2.0, "spin_out_z": 2.0}


class Answers:
    def __init__(self, answer: dict[str, Any]) -> None:
        self.answer = answer

    def ask(self, question: dict[str, Any]) -> dict[str, Any]:
        return self.answer


def made(outputs: dict[str, float], outcome: str = "clear") -> dict[str, Any]:
    """The run that a study makes of an answer."""
    model = SolverModel(Answers({"outcome": outcome, "outputs": outputs}), {})  # type: ignore[arg-type]
    return model({"speed": 1.0}, 1)


def test_speed_and_elevation_follow_from_the_components() -> None:
    outputs = made(CLEAR)["outputs"]
    assert outputs["speed_out"] == pytest.approx(0.07, rel=1e-12)
    assert outputs["elevation_out"] == pytest.approx(math.atan2(0.06, math.hypot(0.03, 0.02)), rel=1e-12)


def test_the_size_of_a_spin_follows_from_its_parts_and_an_attitude_is_kept() -> None:
    attitude = {f"orientation_out_{part}": value for part, value in zip("wxyz", (0.5, 0.5, -0.5, 0.5), strict=True)}
    outputs = made({**VELOCITY, **SPIN, **attitude})["outputs"]
    assert outputs["spin_out"] == 3.0
    assert {name: outputs[name] for name in (*SPIN, *attitude)} == {**SPIN, **attitude}
    # Neither has to be given.
    assert not {*SPIN, *attitude} & set(made(CLEAR)["outputs"])


def test_components_too_large_for_their_speed_give_no_speed_that_is_missing() -> None:
    assert made({**CLEAR, **dict.fromkeys(VELOCITY, 1.5e308)})["outputs"]["speed_out"] == math.inf


def test_numbers_printed_with_six_digits_agree() -> None:
    outputs = {"velocity_out_x": 1.23456, "velocity_out_y": 0.100005, "velocity_out_z": 0.0100005, "spin_out": 0.0}
    speed, elevation = made(outputs)["outputs"]["speed_out"], made(outputs)["outputs"]["elevation_out"]
    printed = {**outputs, "speed_out": float(f"{speed:.6g}"), "elevation_out": float(f"{elevation:.6g}")}
    # What is given returns as it was given.
    assert made(printed)["outputs"] == printed


@pytest.mark.parametrize(("outputs", "said"), [
    ({**CLEAR, "velocity_out_z": -0.06}, "velocity_out_z of -0.06 m/s; a lander that leaves moves outwards"),
    ({**CLEAR, "velocity_out_z": 0.0}, "velocity_out_z of 0 m/s"),
    ({**CLEAR, "speed_out": 7.0}, "7 for speed_out, and 0.07 follows"),
    ({**CLEAR, "elevation_out": 59.0}, "59 for elevation_out, and 1.029"),
    ({**CLEAR, "spin_out": -1.5}, "spin_out of -1.5 rad/s"),
    (VELOCITY, "lacks spin_out"),
    ({**CLEAR, **SPIN}, "1.5 for spin_out, and 3 follows from spin_out_x, _y and _z"),
    ({**CLEAR, "spin_out_x": 1.5}, "has spin_out_x and lacks spin_out_y, spin_out_z; give all of them, or none"),
    ({**CLEAR, "orientation_out_w": 1.0}, "has orientation_out_w and lacks orientation_out_x"),
    ({**CLEAR, **{f"orientation_out_{part}": 1.0 for part in "wxyz"}}, "of length 2; allowed: 1"),
    ({"speed_out": 0.07, "elevation_out": 1.03, "spin_out": 1.5}, "lacks velocity_out_x"),
])  # fmt: skip
def test_a_lander_that_leaves_and_contradicts_itself_is_a_failed_run(outputs: dict[str, float], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        made(outputs)


@pytest.mark.parametrize("value", [None, "0.07", True, np.True_])
def test_what_is_no_number_of_a_function_is_named(value: Any) -> None:
    with pytest.raises(ValueError, match=r"the model gave .* for speed_out; allowed: a number"):
        FunctionModel(lambda *_: {"outputs": {**CLEAR, "speed_out": value}})({}, 1)


@pytest.mark.parametrize("outcome", ["captured", "left_sideways", "time_limit"])
def test_only_a_lander_that_is_clear_counts_as_leaving_whatever_else_is_told_of_it(outcome: str) -> None:
    answers = [made(CLEAR), made(CLEAR, outcome), made({"penetration": 0.01}, outcome)]
    assert answers[1]["outputs"]["spin_out"] == CLEAR["spin_out"]
    records = [
        Record(
            "", RunStatus.DONE, answer["outcome"], {}, answer["outputs"], {}, 1, 0, 1, None, *[None] * 3, "", None, None
        )
        for answer in answers
    ]
    assert DesignRuns.of(Runs(records, 0)).has_outputs.tolist() == [True, False, False]


NO_BED = 0.0


def fastest(given: Study, *others: Any) -> np.ndarray:
    return energy_bound(DrawnDesign(given), *others).speed


def study(**changes: dict[str, Any]) -> Study:
    """A study whose touchdowns a function makes, so that no bed has a height."""
    return check_tables(synthetic_tables(**changes), Path()).with_function("of a test")


def test_a_lander_keeps_at_most_speed_and_spin() -> None:
    # A homogeneous ball of 0.1 m: I / m = 0.4 r^2 = 1e-3 m2.
    assert fastest(study(), NO_BED, {}, 2) == pytest.approx([0.4, 0.4])
    spinning = {"impact.spin_x": np.array([3.0, 0.0]), "impact.spin_z": np.array([4.0, 0.0])}
    assert fastest(study(), NO_BED, spinning, 2) == pytest.approx([np.sqrt(0.16 + 25e-3), 0.4])
    known = study(lander={"inertia": [1e-3, 2e-3, 2e-3], "mass": 2.0})
    assert fastest(known, NO_BED, spinning, 2) == pytest.approx([np.sqrt(0.16 + 25e-3), 0.4])
    box = study(lander={"shape": "box", "edges": [0.1, 0.1, 0.2], "diameter": None})
    assert fastest(box, NO_BED, spinning, 2)[0] == pytest.approx(np.sqrt(0.16 + 25 * (0.1**2 + 0.2**2) / 12))


def test_the_bound_follows_an_uncertain_speed_and_the_fall_down_a_slope() -> None:
    speed = {"impact.speed": np.array([0.1, 0.2])}
    assert fastest(study(), NO_BED, speed, 2) == pytest.approx([0.1, 0.2])
    tilted = study(surface={"slope_deg": 30.0, "gravity": 1e-2}, bed={"width": [0.6, 0.8], "sides": "walls"})
    # One metre of diagonal falls by half a metre.
    assert fastest(tilted, NO_BED, speed, 2) == pytest.approx(np.sqrt([0.01 + 0.01, 0.04 + 0.01]))
    repeating = study(surface={"slope_deg": 30.0, "gravity": 1e-2}, landing={"time_limit": 2.0})
    # Within 2 s by 0.21 and 0.41 m along the slope, of which half is its fall, where no wall stops it.
    assert fastest(repeating, NO_BED, speed, 2) == pytest.approx(np.sqrt([0.01 + 0.0021, 0.04 + 0.0041]))


def test_what_the_speed_takes_is_not_left_for_the_spin() -> None:
    # A ball of 0.1 m has a radius of gyration of 0.1 sqrt(0.1) m, and a box spins fastest about its long axis.
    ball = energy_bound(DrawnDesign(study()), NO_BED, {}, 3)
    assert ball.spin() == pytest.approx(np.full(3, 0.4 / np.sqrt(1e-3)))
    assert ball.spin(np.array([0.0, 0.24, 0.4])) == pytest.approx(np.array([0.4, 0.32, 0.0]) / np.sqrt(1e-3))
    boxed = study(lander={"shape": "box", "edges": [0.1, 0.1, 0.2], "diameter": None})
    box = energy_bound(DrawnDesign(boxed), NO_BED, {}, 1)
    assert box.spin()[0] == pytest.approx(0.4 / np.sqrt((0.1**2 + 0.1**2) / 12))
    known = energy_bound(DrawnDesign(study(lander={"inertia": [1e-3, 2e-3, 2e-3], "mass": 2.0})), NO_BED, {}, 1)
    assert known.spin()[0] == pytest.approx(0.4 / np.sqrt(0.5e-3))


def landed(speed_out: float, spin_out: float, speed: float = 0.2, outcome: str = "clear") -> Record:
    """A run of a ball of 0.1 m, whose radius of gyration squared is 1e-3 m2."""
    inputs = study().touchdown_medians() | {"impact.speed": speed}
    unknown = dict.fromkeys(Record.__dataclass_fields__)
    outputs = {"speed_out": speed_out, "spin_out": spin_out}
    return Record(**{**unknown, "outcome": outcome, "inputs": inputs, "outputs": outputs})


@pytest.mark.parametrize(("records", "said"), [
    ([], None),
    ([landed(0.19, 0.0), landed(0.2, 0.0), landed(0.0, 6.3)], None),
    ([landed(50.0, 0.0, outcome="captured")], None),
    ([landed(0.19, 0.0), landed(50.0, 0.0)],
     "1 of 2 landers that left have more energy than impact and gravity provide, at most 6.25e+04 times as"),
    ([landed(0.15, 6.0)], "1 of 1 landers that left have more energy"),
])  # fmt: skip
def test_landers_that_gain_energy_are_told(records: list[Record], said: str | None) -> None:
    found = energy_warning(DrawnDesign(study(impact={"speed": 0.2})), records, NO_BED)
    assert found is None if said is None else found is not None and found.startswith(said)


LAW = '{ distribution = "uniform", lower = 0.2, upper = 0.8 }'
PARTS = f"""
[lander.centre_of_mass]
z = {{ distribution = "uniform", lower = -0.005, upper = 0.005 }}
[lander.part.foot]
shape = "sphere"
diameter = 0.02
centre = [0.0, 0.0, -0.04]
mass = 0.01
restitution = {LAW}
[lander.part.boom]
shape = "box"
edges = [0.1, 0.01, 0.01]
centre = [0.075, 0.0, 0.0]
density = 500.0
"""


def test_gyration_and_attitude_are_those_of_all_parts(tmp_path: Path) -> None:
    """A sphere alone is the same from all sides; a boom gives it axes, and its inertia to the bound of the spin."""
    path = tmp_path / "study.toml"
    text = few_grains(30, 0.8, 0.05).replace("[surface]", PARTS + "[surface]")
    path.write_text(f"{text}[journey]\ntouchdowns = 1\n")
    study = StudySource.read(path).study
    design = DrawnDesign(study)
    masses = np.array([0.1, 0.2, 0.1])
    smallest, largest = gyrations(design, {**{key: np.full(3, 1.0) for key in design.medians}, "lander.mass": masses})
    for k, mass in enumerate(masses):
        moments = np.linalg.eigvalsh(lander(study, {**design.medians, "lander.mass": mass}).body.inertia) / mass
        assert (smallest[k], largest[k]) == pytest.approx((moments[0], moments[2]))
    # A heavier ball with the same boom turns more easily for its mass.
    assert largest[1] < largest[0]
    terms = attitude_terms(study)
    assert terms.has_sides
    # The easiest axis is that along the boom.
    assert abs(terms.axes[0, 0]) > 0.9


def test_a_study_of_a_lander_with_parts_has_their_numbers_among_its_inputs(tmp_path: Path) -> None:
    text = few_grains(30, 0.8, 0.05, "0.6").replace("[surface]", PARTS + "[surface]")
    text = text.replace('restitution = { distribution = "uniform", lower = 0.5, upper = 0.8 }', "restitution = 0.7")
    path = tmp_path / "study.toml"
    path.write_text(
        f"seed = 5\n{text}[journey]\ntouchdowns = 1\n[design]\nrun_count = 3\n[monte_carlo]\nsample_count = 0\n"
    )
    run_study(StudySource.read(path), tmp_path / "out", until="runs", worker_count=1)
    runs = DesignRuns.load(StudyFolder.only_read(tmp_path / "out"), "drawn")
    assert runs.run_count == 3
    assert set(runs.outcomes) <= {"clear", "captured", "left_sideways", "time_limit"}
    foot, centre = runs.inputs["lander.part.foot.restitution"], runs.inputs["lander.centre_of_mass.z"]
    assert len(np.unique(foot)) == 3
    assert (np.abs(centre) <= 0.005).all()
    assert (foot >= 0.2).all()
    assert (foot <= 0.8).all()
    assert len(open_study(tmp_path / "out").runs["key"]) >= 3
