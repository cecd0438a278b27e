"""Runs in a table: every column as CSV, or what tells one run from another as lines for a person."""

import csv
from collections.abc import Mapping, Sequence
from textwrap import wrap
from typing import Any, TextIO

from lithobrake.campaign.record import COLUMNS, KEY_LENGTH, OBJECTS, Record
from lithobrake.vocabulary.plain_text import plain

# What a terminal is left with for the outcome or the reason at least.
_REASON_WIDTH = 24
_GAP, _LAST = "  ", "outcome or reason"


def write_csv(records: Sequence[Record], file: TextIO, units: Mapping[str, str] | None = None) -> None:
    """Write runs as CSV, one row a run: its columns, then one for each input, output and draw, by its name.

    units: of inputs and outputs by name, for the headers.
    """
    columns = [name for name in COLUMNS if name not in OBJECTS]
    tables = [[getattr(entry, name) for name in OBJECTS] for entry in records]
    names = [list(dict.fromkeys(name for row in tables for name in row[part])) for part in range(len(OBJECTS))]
    titles = [
        plain(" ".join([f"{part.rstrip('s')}:{name}", *_unit(name, units or {})]))
        for part, group in zip(OBJECTS, names, strict=True)
        for name in group
    ]
    writer = csv.writer(file)
    writer.writerow([*columns, *titles])
    for entry, row in zip(records, tables, strict=True):
        values = [_shown(table.get(name, "")) for table, group in zip(row, names, strict=True) for name in group]
        writer.writerow([*(getattr(entry, name) for name in columns), *values])


def _shown(value: Any) -> Any:
    """A value as a cell; the words that a model drew are its own."""
    return value if isinstance(value, int | float) else plain(str(value))


def run_lines(
    records: Sequence[Record],
    units: Mapping[str, str],
    width: int | None,
    first: Mapping[str, tuple[str, str]] | None = None,
) -> list[str]:
    """Return runs as lines under a header: key, status, wall time, inputs that differ, outcome or reason.

    units: of inputs and outputs by name. width: of the terminal; inputs that do not fit in are named below, and a
    reason that does not is cut and marked by three dots. None: all of both. first: two words for the head of outputs,
    and of inputs that differ, by their names, which stand before all others.
    """
    columns = [
        _column(["", "", "key"], [entry.key[:KEY_LENGTH] for entry in records]),
        _column(["", "", "status"], [entry.status for entry in records]),
        _column(["", "wall", "[s]"], [_number(entry.wall_s) for entry in records]),
    ]
    heads, inputs = first or {}, _differing(records)
    leading = [name for name in heads if name in inputs or any(name in entry.outputs for entry in records)]
    differing = leading + [name for name in inputs if name not in leading]
    shown = [
        _column(
            [*heads[name], *(_unit(name, units) or [""])] if name in heads else _head(name, units),
            [_number(entry.outputs.get(name, entry.inputs.get(name))) for entry in records],
        )
        for name in differing
    ]
    reasons = [entry.outcome or entry.reason or "" for entry in records]
    reason_width = min(max(map(len, [_LAST, *reasons])), _REASON_WIDTH)
    room = None if width is None else width - _width(columns) - reason_width
    while room is not None and shown and _width(shown) > room:
        shown.pop()
    columns += shown
    if width is not None:
        reasons = [_cut(reason, max(width - _width(columns), reason_width)) for reason in reasons]
    last = ["", "", _LAST, *reasons]
    lines = [(_GAP.join(row) + _GAP + reason).rstrip() for *row, reason in zip(*columns, last, strict=True)]
    left_out = differing[len(shown) :]
    if left_out:
        words = f"Differ too: {', '.join(left_out)} (--csv has every column)"
        lines += [words] if width is None else wrap(words, width, break_on_hyphens=False)
    # No input stands in the first line where none is shown.
    return lines if lines[0] else lines[1:]


def _differing(records: Sequence[Record]) -> list[str]:
    """The inputs that do not have one value in all runs, in their order."""
    names = dict.fromkeys(name for entry in records for name in entry.inputs)
    return [name for name in names if len({entry.inputs.get(name) for entry in records}) > 1]


def _head(name: str, units: Mapping[str, str]) -> list[str]:
    """Three lines over a column: the sections that a name stands in, its last part, its unit."""
    section, _, last = name.rpartition(".")
    return [section, last, *(_unit(name, units) or [""])]


def _unit(name: str, units: Mapping[str, str]) -> list[str]:
    return [f"[{units[name]}]"] if name in units else []


def _number(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"


def _column(head: list[str], values: list[str]) -> list[str]:
    """The cells of a column, as wide as the widest: words to the left, numbers to the right."""
    width = max(map(len, [*head, *values]))
    numbers = head[-1] not in ("key", "status")
    return [cell.rjust(width) if numbers else cell.ljust(width) for cell in [*head, *values]]


def _width(columns: Sequence[list[str]]) -> int:
    """Characters that columns take, with the gap after each."""
    return sum(len(column[0]) + len(_GAP) for column in columns)


def _cut(text: str, width: int) -> str:
    return text if len(text) <= width else f"{text[: width - 3]}..."
