"""Measured numbers of the documents are those of committed files.

A comment after a paragraph, a table or an item of a list says where its numbers come from, in Python:

    <!-- numbers:
    runs = kept("showcase/mission/summary.json").results.runs
    ..., 100 * runs.share, [row.speed for row in kept("benchmarks/results/speeds.csv")]
    -->

The last line has a value for each number of the text before, in order; `...` stands for one that is not measured (a
setting, a level). Lists are flattened. A number agrees if the value, rounded to the digits that are shown, is the same.
Names stay known down to the end of the page. A comment `numbers of the example` has the names of the page's own Python.
"""

import ast
import csv
import json
import re
from collections.abc import Iterator
from statistics import fmean, median, stdev
from textwrap import dedent
from typing import Any

from blocks import ROOT

COMMENT = re.compile(r"<!-- numbers( of the example)?:(.*?)-->", flags=re.DOTALL)
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


def sourced(text: str, example: dict[str, Any] | None = None) -> Iterator[tuple[int, list[str], list[Any]]]:
    """The line of each comment of a page, the numbers of the text before it, and their values.

    example: what the Python of the page has defined; the comments are those of it, and without it all others.
    """
    known = (kept, those, ends, span, percent, interval, figures, median, fmean, stdev)
    names: dict[str, Any] = {one.__name__: one for one in known} | (example or {})
    for comment in COMMENT.finditer(text):
        if (comment.group(1) is None) is not (example is None):
            continue
        before = text[: comment.start()].rstrip()
        begin = max(match.end() for match in BEGINNING.finditer(before))
        *statements, last = ast.parse(dedent(comment.group(2)).strip()).body
        exec(compile(ast.Module(statements, []), "page", "exec"), names)
        values = eval(compile(ast.Expression(last.value), "page", "eval"), names)  # type: ignore[attr-defined]
        yield text.count("\n", 0, comment.start()) + 1, numbers_of(before[begin:]), list(flat(values))


def wrong(text: str, example: dict[str, Any] | None = None) -> list[str]:
    """The numbers of a page that are not those of the files that it names, or of its example, with their lines."""
    found = []
    for line, numbers, values in sourced(text, example):
        if len(numbers) != len(values):
            found.append(f"line {line}: {len(numbers)} numbers {numbers} and {len(values)} values {values}")
        else:
            pairs = zip(numbers, values, strict=True)
            found += [f"line {line}: {one}, not {value}" for one, value in pairs if not agrees(one, value)]
    return found
