"""The runs of a ledger as CSV or as lines, and which of them are missing."""

import csv
from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations, product
from math import comb
from textwrap import wrap
from typing import TYPE_CHECKING, Any, TextIO

from lithobrake.campaign.record import COLUMNS, KEY_LENGTH, OBJECTS, Record, common_reasons
from lithobrake.vocabulary.number_words import percent
from lithobrake.vocabulary.plain_text import plain

if TYPE_CHECKING:
    import numpy as np

# What a terminal is left with for the outcome or the reason at least.
_REASON_WIDTH = 24
_GAP, _LAST = "  ", "outcome or reason"
# A chance below this, over all corners looked at, is no chance [-].
_CHANCE = 0.01


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


def missing(x: "np.ndarray", reasons: Sequence[str | None], names: Sequence[str], largest_share: float) -> str:
    """Sentence on the failed runs of a design and their reasons; empty if none failed.

    x: inputs, shape [run_count, len(names)]. reasons: why each run failed, None where it has not. largest_share: of
    failed runs that is accepted [-]. Raises ValueError when more have failed, or when those that did lie together on
    one side of an input, or in a corner of two, as they would by chance in less than 1 of 100 designs: what is fitted
    without them would know nothing there.
    """
    # Who only looks at a ledger, as a second terminal does every few seconds, needs no arrays.
    import numpy as np

    failed = np.array([reason is not None for reason in reasons])
    count, total = int(failed.sum()), len(failed)
    if count == 0:
        return ""
    sentence = f"{count} of {total} runs failed ({common_reasons(reasons)})"
    corner = _corner(x, failed, names)
    if count > largest_share * total:
        place = "" if corner is None else f", {corner[0]} of them where {corner[1]}"
        raise ValueError(
            f"{sentence}{place}; allowed: at most {percent(largest_share)}; remove what makes them fail, try them "
            "again (campaign.retry_count), or allow more (campaign.failed_share)"
        )
    if corner:
        inside, where = corner
        raise ValueError(
            f"{sentence}; {inside} of them lie where {where}, so what is fitted without them knows nothing there; "
            "remove what makes them fail, or narrow these inputs"
        )
    return f"{sentence}; what is fitted goes without them"


def _corner(x: "np.ndarray", failed: "np.ndarray", names: Sequence[str]) -> tuple[int, str] | None:
    """The corner in which failures are least likely by chance: how many, and where; None when chance may do it.

    Among the failed and the others drawn without order, the number of failed ones in a corner has the hypergeometric
    distribution; the chance is multiplied by the number of corners looked at (Bonferroni).
    """
    corners = list(_corners(x, names))
    best: tuple[float, int, str] | None = None
    for inside, where in corners:
        hit = int((inside & failed).sum())
        chance = _at_least(hit, int(inside.sum()), int(failed.sum()), len(failed))
        if best is None or chance < best[0]:
            best = chance, hit, where
    if best is None or best[0] * len(corners) > _CHANCE:
        return None
    return best[1], best[2]


def _corners(x: "np.ndarray", names: Sequence[str]) -> "Iterator[tuple[np.ndarray, str]]":
    """Every side of every input that varies, below or above its middle value, and every corner of two such sides."""
    import numpy as np

    sides: list[list[tuple[np.ndarray, str]]] = []
    for column, name in enumerate(names):
        values = x[:, column]
        middle = float(np.median(values))
        if values.min() < values.max():
            sides.append([(values < middle, f"{name} < {middle:.4g}"), (values > middle, f"{name} > {middle:.4g}")])
    for pair in sides:
        yield from pair
    for first, second in combinations(sides, 2):
        for (one, here), (other, there) in product(first, second):
            yield one & other, f"{here} and {there}"


def _at_least(hit: int, inside: int, drawn: int, total: int) -> float:
    """Chance that of `drawn` out of `total`, at least `hit` are among the `inside` ones [-]."""
    # Whole numbers of any size: as floats these coefficients overflow from a thousand runs on.
    ways = sum(comb(inside, k) * comb(total - inside, drawn - k) for k in range(hit, min(inside, drawn) + 1))
    return ways / comb(total, drawn)
