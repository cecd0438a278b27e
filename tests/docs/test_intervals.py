"""Every interval of the summary has its row in docs/validation/interval_coverage.md, with a script or a reason."""

import re
import sys
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from itertools import product
from typing import Any

from blocks import ROOT

sys.path.insert(0, str(ROOT / "docs"))
from make_summary_page import form_of, key_of, tables_within

from lithobrake.results.summary import Results
from lithobrake.vocabulary.estimate import is_inline

PAGE = ROOT / "docs" / "validation" / "interval_coverage.md"
# Keys that are intervals without being an estimate: prediction intervals, and limits of what never occurred.
PLAIN = re.compile(r"next_bed|upper_limit|tail_limit|intervals|\w+_interval")


def intervals(kind: Any = Results, place: str = "") -> Iterator[str]:
    """Places of all intervals of a kind of value, `*` for the names of a mapping, without `results.`."""
    if form_of(kind) is not None:
        if "lower" in form_of(kind).keys:
            yield place
        return
    for field in fields(kind) if is_dataclass(kind) else ():
        own = place if is_inline(field) else f"{place}.{key_of(field)}".removeprefix(".")
        # Samples of an expansion alone have a limit of what never occurred.
        if PLAIN.fullmatch(key_of(field)) and (key_of(field) != "upper_limit" or own.startswith("samples")):
            yield own
        if is_inline(field) and form_of(field.type) is not None:
            yield place
            continue
        for inner, where in tables_within(field.type, own):
            yield from intervals(inner, where)


def named() -> dict[str, str]:
    """The intervals of the first column with the rest of their row; `{a,b}` stands for either word."""
    text = PAGE.read_text(encoding="utf-8").partition("## Every interval of the summary")[2].partition("\n## ")[0]
    found = {}
    for line in text.splitlines():
        first, _, rest = line.removeprefix("| ").partition(" | ")
        for name in re.findall(r"`([^`]+)`", first) if line.startswith("| `") else ():
            parts = [one.strip("{}").split(",") for one in re.split(r"(\{[^}]*\})", name)]
            found |= {"".join(one): rest for one in product(*parts)}
    return found


def test_every_interval_of_the_summary_has_a_row_and_every_row_an_interval() -> None:
    there = set(intervals())
    assert len(there) > 80
    assert (sorted(there - set(named())), sorted(set(named()) - there)) == ([], [])


def test_every_row_names_a_script_that_is_there_or_says_why_nothing_was_measured() -> None:
    for name, row in named().items():
        scripts = re.findall(r"`((?:benchmarks|validation)/\w+\.py)`", row)
        assert all((ROOT / one).is_file() for one in scripts), name
        assert scripts or re.search(r"not measured: \w+ \w+", row) or "no interval: " in row, name
