"""What a solver of one's own may answer, and what a study cannot use."""

import math
from typing import Any

import pytest

from lithobrake.campaign import Record, Runs, RunStatus
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.runs.solver import SolverModel

VELOCITY = {"velocity_out_x": 0.03, "velocity_out_y": -0.02, "velocity_out_z": 0.06}
CLEAR = {**VELOCITY, "spin_out": 1.5}

SPIN = {"spin_out_x": 1.0, "spin_out_y": -2.0, "spin_out_z": 2.0}


class Answers:
    """A program that always gives one answer."""

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


@pytest.mark.parametrize(
    ("outputs", "said"),
    [
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
    ],
)
def test_a_lander_that_leaves_and_contradicts_itself_is_a_failed_run(outputs: dict[str, float], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        made(outputs)


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
    design = DesignRuns.of(Runs(records, 0))
    assert design.has_outputs.tolist() == [True, False, False]
