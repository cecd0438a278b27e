"""Limit states: what is a condition, and what is refused in one sentence."""

import tomllib
from pathlib import Path
from typing import Any

import pytest

from lithobrake.study import StudyError, check_tables
from lithobrake.study.template import template

TABLES: dict[str, Any] = tomllib.loads(template())
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


def refusal(limit_states: object, **tables: dict[str, Any]) -> str:
    """What a study file with this table is refused with."""
    with pytest.raises(StudyError) as error:
        check_tables(TABLES | tables | {"limit_states": limit_states}, Path())
    return str(error.value)


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
