"""What a console shows of results fits a screen of 80 columns and 24 lines."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.results import Column, Table
from lithobrake.results.study_files import results_in
from lithobrake.results.summary import Results
from lithobrake.vocabulary.plain_text import LINES, names_in_lines, short_repr

SHOWCASE = Path(__file__).parents[2] / "showcase"


def fits(text: str) -> bool:
    lines = text.split("\n")
    return len(lines) <= LINES <= 24 and max(map(len, lines)) <= 80


def inside(value: Any) -> Iterator[Any]:
    """A value, and all dataclasses that it holds."""
    if is_dataclass(value):
        yield value
        for one in fields(value):
            yield from inside(getattr(value, one.name))
    elif isinstance(value, Mapping | list | tuple):
        for one in value.values() if isinstance(value, Mapping) else value:
            yield from inside(one)


@pytest.mark.parametrize("study", ["mission", "paper"])
def test_results_fit_a_screen(study: str) -> None:
    summary = json.loads((SHOWCASE / study / "summary.json").read_text(encoding="utf-8"))
    found = results_in(Results, summary["results"], "results")
    assert repr(found).startswith("Results\n  ")
    assert fits(repr(found))
    # What stands on one line is wrapped by the console, and no more than a screen of it.
    assert max(len(repr(one)) for one in inside(found)) < LINES * 80


def test_a_table_of_many_columns_names_as_many_as_fit() -> None:
    columns = {f"a_column_of_a_long_name_{number}": Column(np.zeros(3), "kg/m3") for number in range(200)}
    shown = repr(Table("run", columns))
    assert shown.startswith("Table of 3 rows (run): a_column_of_a_long_name_0 [kg/m3],")
    assert fits(shown)
    named = shown.count("[kg/m3]")
    assert shown.replace("\n ", "").endswith(f"and {200 - named} more")
    # No name stands apart from its unit.
    assert not any(line.strip().startswith("[") for line in shown.split("\n"))
    assert names_in_lines("None: ", ()) == "None:"


@dataclass(frozen=True)
class Many:
    """More fields than a screen has lines."""

    number: float
    nothing: None
    parts: tuple[Any, ...]
    __repr__ = short_repr


def test_a_line_has_what_a_field_holds() -> None:
    value = Many(0.123456789, None, (Column(np.zeros((2, 3))), Column(np.zeros(1))))
    assert repr(value) == "Many\n  number  0.123457\n  parts   2 Column\n  empty: nothing"
    assert repr(Many(2.0, None, ({"one": 1.0}, [1, 2], "word"))).split("\n")[2] == "  parts   [1], [2], word"
