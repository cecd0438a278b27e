"""The page of the study file is what its script makes of the schema, and has every key with its unit and range."""

import re
import runpy
from typing import Any

import pytest
from blocks import ROOT

from lithobrake.study import known_keys

PAGE = ROOT / "docs" / "study_file.md"


@pytest.fixture(scope="module")
def script() -> dict[str, Any]:
    """What docs/make_study_file_page.py defines."""
    return runpy.run_path(str(ROOT / "docs" / "make_study_file_page.py"))


def rows(section: str) -> dict[str, str]:
    """The row of each key of a section."""
    # A section whose tables have names of the user's own is headed by one of these.
    heading = rf"## `\[{section}(?:\.NAME)?\]`\n"
    text = re.split(heading, PAGE.read_text(encoding="utf-8"))[1].partition("\n## ")[0]
    return {line.split("`")[1]: line for line in text.splitlines() if line.startswith("| `")}


def test_the_page_is_what_its_script_makes(script: dict[str, Any]) -> None:
    assert PAGE.read_text(encoding="utf-8") == script["page"](), (
        "make it again with: python docs/make_study_file_page.py"
    )


def test_every_section_has_a_row_for_each_of_its_keys() -> None:
    sections = {name: keys for name, keys in known_keys().items() if name and "." not in name}
    assert len(sections) > 15
    for name, keys in sections.items():
        assert set(keys) <= rows(name).keys(), name


@pytest.mark.parametrize(
    ("section", "key", "cells"),
    [
        ("grain", "poisson_ratio", "|  | [0, 0.5) ± | needed |"),
        ("grain", "young_modulus", "| Pa | > 0 ± | needed |"),
        ("bed", "sides", '| `"walls"`, `"periodic"` | `"walls"` |'),
        ("bed", "boulders.coverage", "|  | (0, 0.3] | needed |"),
        ("flight", "duration", "| s | > 0 | `43200.0` |"),
        ("campaign", "memory_limit", "| bytes | > 0 |  |"),
    ],
)
def test_a_row_has_unit_range_and_default(section: str, key: str, cells: str) -> None:
    assert rows(section)[key].endswith(cells)


def test_what_is_typed_is_code_and_no_letter_is_lost(script: dict[str, Any]) -> None:
    words = script["as_markdown"]
    assert words('as impact.speed, or [site] with "paper"; docs/chaos.md') == (
        'as `impact.speed`, or `[site]` with `"paper"`; [chaos.md](chaos.md)'
    )
    assert words("a | b, R* and R* fall with D**-exponent") == r"a \| b, R\* and R\* fall with `D**-exponent`"
