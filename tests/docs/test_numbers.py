"""Measured numbers of the documents are those of committed files.

A comment after a paragraph, a table or an item of a list says where its numbers come from, in Python:

    <!-- numbers:
    runs = kept("showcase/mission/summary.json").results.runs
    ..., 100 * runs.share, [row.speed for row in kept("benchmarks/results/speeds.csv")]
    -->

The last line has a value for each number of the text before, in order; `...` stands for one that is not measured (a
setting, a level). Lists are flattened. A number agrees if the value, rounded to the digits that are shown, is the same.
Names stay known down to the end of the page.
"""

import ast
import csv
import json
import re
import runpy
from collections.abc import Iterator
from pathlib import Path
from statistics import fmean, median, stdev
from textwrap import dedent
from typing import Any

import pytest
from blocks import PAGES, ROOT

COMMENT = re.compile(r"<!-- numbers:(.*?)-->", flags=re.DOTALL)
# Where the text of a comment begins: behind an empty line, at an item of a list, behind another comment.
BEGINNING = re.compile(r"\n[ \t]*\n|\n\s*- |-->\n|\A")
# Code, equations, addresses and keys of references have numbers that nobody measured.
OTHER = re.compile(r"^```\w*$|`[^`]*`|\$[^$]*\$|\]\([^)]*\)|\[[A-Z][\w-]*-\d{4}\w?\]", flags=re.MULTILINE)
# A sign behind a digit, a letter or a bracket is a dash.
NUMBER = re.compile(r"(?<![\w.])(?:(?<![\d)%])[-+])?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?!\w)")
THOUSANDS = re.compile(r"(?<=\d) (?=\d{3}(?!\d))")


class Kept(dict[str, Any]):
    """A table of a file, whose keys are attributes too."""

    __getattr__ = dict.__getitem__


def kept(path: str) -> Any:
    """What a committed file has: a document, or the rows of a table with numbers where they are some.

    Of a page that a script writes: the rows of all its tables, as text.
    """
    if path.endswith(".md"):
        return page_rows((ROOT / path).read_text(encoding="utf-8"))
    with (ROOT / path).open(newline="", encoding="utf-8") as file:
        if path.endswith(".csv"):
            return [Kept({key: number(cell) for key, cell in row.items()}) for row in csv.DictReader(file)]
        return json.load(file, object_hook=Kept)


def page_rows(text: str) -> list[Kept]:
    """The rows of the tables of a page by their heads."""
    found: list[Kept] = []
    for table in re.findall(r"(?:^\|.*\n)+", text, flags=re.MULTILINE):
        heads, _, *lines = ([cell.strip() for cell in line.strip("| \n").split("|")] for line in table.splitlines())
        found += [Kept(zip(heads, line, strict=False)) for line in lines]
    return found


def number(cell: str) -> float | str:
    try:
        return float(cell)
    except ValueError:
        return cell


def those(rows: list[Kept], **values: Any) -> list[Kept]:
    """The rows that have these values."""
    return [row for row in rows if all(row.get(key) == value for key, value in values.items())]


def ends(values: Any) -> tuple[float, float]:
    """The smallest and the largest value."""
    found = list(values)
    return min(found), max(found)


def span(values: Any, digits: int) -> list[float]:
    """The smallest and the largest value, one value where they are the same to so many decimals."""
    found = ends(values)
    return [found[0]] if f"{found[0]:.{digits}f}" == f"{found[1]:.{digits}f}" else list(found)


def percent(estimate: Kept) -> list[float]:
    """A share and its bounds, in per cent."""
    return [100.0 * estimate[key] for key in ("share", "lower", "upper")]


def interval(estimate: Kept, unit: float = 1.0) -> list[float]:
    """A value and its bounds, in a unit."""
    return [estimate[key] / unit for key in ("value", "lower", "upper")]


def flat(value: Any) -> Iterator[Any]:
    """The values of lists within lists."""
    if isinstance(value, (list, tuple)):
        for one in value:
            yield from flat(one)
    else:
        yield value


def numbers_of(text: str) -> list[str]:
    """The numbers of a text in their order, without blanks between thousands."""
    return NUMBER.findall(THOUSANDS.sub("", OTHER.sub(" ", text)))


def figures(text: str) -> list[float]:
    """The numbers of a cell of a page."""
    return [float(one) for one in numbers_of(text)]


def agrees(shown: str, value: Any) -> bool:
    """Whether a value is the number that is shown, to its digits.

    Zeros that end a whole number may be rounded ones, all but two digits, if the value is none of a count; not of 100.
    """
    if value is ...:
        return True
    digits, _, power = shown.partition("e")
    decimals = len(digits.partition(".")[2])
    whole = "." in digits or isinstance(value, int) or digits.strip("+-0") in ("", "1")
    zeros = 0 if whole else min(len(digits) - len(digits.rstrip("0")), max(len(digits.strip("+-")) - 2, 0))
    unit = 10.0 ** (zeros - decimals + int(power or 0))
    return abs(float(shown) - value) <= 0.5 * unit * (1.0 + 1e-9)


def sourced(text: str) -> Iterator[tuple[int, list[str], list[Any]]]:
    """The line of each comment of a page, the numbers of the text before it, and their values."""
    known = (kept, those, ends, span, percent, interval, figures, median, fmean, stdev)
    names: dict[str, Any] = {one.__name__: one for one in known}
    for comment in COMMENT.finditer(text):
        before = text[: comment.start()].rstrip()
        begin = max(match.end() for match in BEGINNING.finditer(before))
        *statements, last = ast.parse(dedent(comment.group(1)).strip()).body
        exec(compile(ast.Module(statements, []), "page", "exec"), names)
        values = eval(compile(ast.Expression(last.value), "page", "eval"), names)  # type: ignore[attr-defined]
        yield text.count("\n", 0, comment.start()) + 1, numbers_of(before[begin:]), list(flat(values))


def wrong(text: str) -> list[str]:
    """The numbers of a page that are not those of the files that it names, with their lines."""
    found = []
    for line, numbers, values in sourced(text):
        if len(numbers) != len(values):
            found.append(f"line {line}: {len(numbers)} numbers {numbers} and {len(values)} values {values}")
        else:
            pairs = zip(numbers, values, strict=True)
            found += [f"line {line}: {one}, not {value}" for one, value in pairs if not agrees(one, value)]
    return found


@pytest.mark.parametrize(
    "page", [one for one in PAGES if "<!-- numbers:" in one.read_text("utf-8")], ids=lambda one: one.name
)
def test_numbers_are_those_of_the_files_that_are_named(page: Path) -> None:
    assert wrong(page.read_text(encoding="utf-8")) == []


def test_the_table_of_times_is_what_its_script_makes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "benchmarks"))
    script = runpy.run_path(str(ROOT / "benchmarks" / "write_times.py"))
    page = (ROOT / "docs" / "performance.md").read_text(encoding="utf-8")
    assert page == script["page"](), "make it again with: python benchmarks/write_times.py"


def test_the_tables_of_what_is_left_out_are_those_of_their_script(capsys: pytest.CaptureFixture[str]) -> None:
    runpy.run_path(str(ROOT / "validation" / "experiments" / "left_out.py"), run_name="__main__")
    rows = [line.strip() for line in capsys.readouterr().out.splitlines() if line.startswith("|")]
    page = (ROOT / "docs" / "what_the_model_leaves_out.md").read_text(encoding="utf-8").splitlines()
    assert len(rows) > 20
    assert [row for row in rows if row not in page] == []


@pytest.mark.parametrize(
    ("shown", "value", "same"),
    [
        ("0.71", 0.7149, True), ("0.71", 0.7151, False), ("5300", 5349.0, True), ("5300", 5351.0, False),
        ("240", 240, True), ("240", 241, False), ("2.5e4", 25_400.0, True), ("2.5e4", 25_600.0, False),
        ("-3", -3.4, True), ("100", 99.9, True), ("13", 13.8, False), ("100", 91.0, False), ("0", 0.6, False),
        ("20000", 20_342.0, True), ("150", 146.2, True), ("150", 144.0, False), ("20", 20.6, False),
    ],
)  # fmt: skip
def test_a_value_agrees_to_the_digits_that_are_shown(shown: str, value: float, same: bool) -> None:
    assert agrees(shown, value) is same


def test_numbers_of_a_text_are_found_with_signs_ranges_and_thousands() -> None:
    text = "| `held_speed` 0.03 | 10 800 grains | -2 to +1.5e3 | 97-99.7 % | $n^2$ | [Zhu-2023] | x2 | 6U |"
    assert numbers_of(text) == ["0.03", "10800", "-2", "+1.5e3", "97", "99.7"]


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ("ends.at_rest.count, 240", ["line 5: 98, not 238"]),
        ("100 * ends.at_rest.share", ["line 5: 2 numbers ['98', '240'] and 1 values [99.16666666666667]"]),
        ("[[...], 240]", []),
    ],
)
def test_a_number_that_is_not_in_its_file_is_found(values: str, said: list[str]) -> None:
    ends = 'ends = kept("showcase/mission/summary.json").results.ends'
    assert wrong(f"First 7.\n\n- Of 5.\n- At rest: 98 of 240.\n  <!-- numbers:\n  {ends}\n  {values}\n  -->") == said
