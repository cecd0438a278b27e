"""Limit states: what is a condition, what is refused in one sentence, and which landings meet one."""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.study import StudyError, check_tables
from lithobrake.study.limit_state import FAR, FATES, NEAR, LimitState
from lithobrake.study.template import template

NAN = np.nan
TABLES: dict[str, Any] = tomllib.loads(template())
# Four landings: fast and gone, slow and down again, captured, and one of which nobody knows.
LANDINGS = {
    "speed_out": [0.2, 0.05, NAN, NAN],
    "peak_acceleration": [30.0, 60.0, 70.0, NAN],
    "captured": [0.0, 0.0, 1.0, NAN],
    "returns": [0.0, 1.0, 1.0, NAN],
    "escaped": [1.0, 0.0, 0.0, NAN],
}
MET: list[tuple[str, list[float]]] = [
    ("speed_out > 0.1", [1, 0, 0, NAN]),
    # What is captured has no speed, so it is neither above nor below any.
    ("speed_out <= 0.1", [0, 1, 0, NAN]),
    ("not speed_out > 0.1", [0, 1, 1, NAN]),
    ("peak_acceleration > 50", [0, 1, 1, NAN]),
    ("returns == false", [1, 0, 0, NAN]),
    ("returns != true", [1, 0, 0, NAN]),
    ("not returns", [1, 0, 0, NAN]),
    ("captured or 0.01 < speed_out < 1e-1", [0, 1, 1, NAN]),
    ("(escaped or captured) and peak_acceleration > 50", [0, 0, 1, NAN]),
    ("speed_out > -1 and not returns", [1, 0, 0, NAN]),
]
# How far the same landings are from meeting conditions, speeds counted in .1 m/s and accelerations in 10 m/s2.
SCALE = {"speed_out": 0.1, "peak_acceleration": 10.0}
MARGINS: list[tuple[str, list[float]]] = [
    ("speed_out > 0.1", [-1.0, 0.5, FAR, FAR]),
    ("not speed_out > 0.1", [1.0, -0.5, -FAR, FAR]),
    ("0.05 < speed_out <= 0.3", [-1.0, NEAR, FAR, FAR]),
    ("speed_out > 0.1 and peak_acceleration > 50", [2.0, 0.5, FAR, FAR]),
    ("speed_out > 0.3 or peak_acceleration > 50", [1.0, -1.0, -2.0, FAR]),
    ("speed_out > 0.1 and not captured", [-1.0, 0.5, FAR, FAR]),
]
REFUSED: list[tuple[str, str]] = [
    ("speed > 1", "speed is no output; did you mean speed_out?"),
    ("speed_out", "speed_out is a number: compare it"),
    ("returns > 1", "returns is true or false, and no number"),
    ("retuns", "retuns is no name here; did you mean returns?"),
    ("speed_out == 0.1", "outputs are compared by <, <=, >, >="),
    ("1 < 2", "compares numbers alone"),
    ("speed_out > 1e999", "neither an output nor a finite number"),
    ("speed_out > 1j", "neither an output nor a finite number"),
    ("speed_out + 1 > 2", "neither an output nor a finite number"),
    ("speed_out > true", "true is no output"),
    ("__import__('os').remove('x')", "is no condition"),
    ("(speed_out > 1", "it cannot be read"),
    ("returns\0", "it cannot be read"),
    ("speed_out > 0.1 # and not returns", "it has a comment (#) or a line break: write a condition on one line"),
    ("# returns", "it has a comment (#)"),
    ("(speed_out > 0.1\nand returns)", "it has a comment (#) or a line break"),
    ("(speed_out > 0.1\u2028and returns)", "or a line break"),
    ("-" * 400 + "1 > speed_out", f"{'-' * 400}1 is neither an output nor a finite number"),
    ("-" * 400 + "speed_out", "-speed_out is no condition"),
    ("~" * 400 + "returns and returns", "~returns is no condition"),
    (" and ".join(["returns"] * 100), "it has 1195 characters"),
]


@pytest.mark.parametrize(("text", "margins"), MARGINS)
def test_a_margin_says_how_far_a_landing_is_from_meeting_it(text: str, margins: list[float]) -> None:
    values = {name: np.array(numbers) for name, numbers in LANDINGS.items()}
    found = LimitState.of(text).margin(values, SCALE)
    assert found == pytest.approx(np.array(margins), rel=1e-12)
    assert np.array_equal(found <= 0.0, LimitState.of(text).met(values) == 1.0)


def refusal(limit_states: object, **tables: dict[str, Any]) -> str:
    """What a study file with this table is refused with."""
    with pytest.raises(StudyError) as error:
        check_tables(TABLES | tables | {"limit_states": limit_states}, Path())
    return str(error.value)


@pytest.mark.parametrize(("text", "expected"), MET)
def test_landings_meet_a_condition_or_not_or_nobody_knows(text: str, expected: list[float]) -> None:
    values = {name: np.array(value) for name, value in LANDINGS.items()}
    assert LimitState.of(text).met(values).tolist() == pytest.approx(expected, nan_ok=True)


def test_what_is_known_decides_where_it_can() -> None:
    unknown = {name: np.array([NAN]) for name in FATES} | {"speed_out": np.array([0.2])}
    assert LimitState.of("speed_out > 0.1 or returns").met(unknown).tolist() == [1.0]
    assert LimitState.of("speed_out < 0.1 and returns").met(unknown).tolist() == [0.0]
    assert np.isnan(LimitState.of("speed_out > 0.1 and returns").met(unknown)).all()


@pytest.mark.parametrize(("text", "words"), REFUSED)
def test_what_is_no_condition_is_refused_in_one_sentence(text: str, words: str) -> None:
    said = refusal({"fast": text})
    assert said.startswith("study.toml: limit_states.fast is ")
    assert words in said
    assert "\n" not in said


def test_other_things_than_texts_under_names_are_refused() -> None:
    assert "limit_states.fast is 3; allowed: outputs (SI) compared" in refusal({"fast": 3})
    assert "limit_states is 3; allowed: a table" in refusal(3)
    assert "limit_states.too fast is no name" in refusal({"too fast": "returns"})


def test_a_method_without_drawn_runs_is_refused() -> None:
    said = refusal({"fast": "returns"}, design={"method": "paper"})
    assert 'limit_states.fast goes with design.method = "drawn", and it is "paper"' in said


def test_a_study_keeps_its_conditions_by_name() -> None:
    conditions = {"fast": "speed_out > 0.1", "gone": "not returns"}
    study = check_tables(TABLES | {"limit_states": conditions}, Path())
    assert study.limit_states.conditions() == conditions
    assert check_tables(TABLES, Path()).limit_states.conditions() == {}
