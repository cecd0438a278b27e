"""Numbers and words of the page as cells of a table, and as text that HTML shows."""

import re
from collections.abc import Iterable, Mapping, Sequence
from html import escape

from lithobrake.vocabulary.number_words import RAISED, number

# Powers of units, "m2" and "m/s2", behind a number, a bracket or a unit.
POWER = re.compile(
    r"(?:(?<=\b(?:m|J|N)/)|(?<=\bkg/)|(?<=\brad/)|(?<=\bm2/)|(?<=\[)|(?<=[\d⁰¹²³⁴⁵⁶⁷⁸⁹][ \N{NO-BREAK SPACE}]))"
    r"([ms])([23])\b"
)
# Blanks within a large number, and before the unit of an area.
THOUSANDS = re.compile(r"(?<=\d) (?=\d{3}\b)|(?<=\d) (?=m²)")


def flat(tree: Mapping[str, object], prefix: str = "", alike: Sequence[Sequence[str]] = ()) -> list[tuple[str, str]]:
    """A nested mapping as rows (dotted name, value in words), in its own order; alike: names that share one scale."""
    scales = {name: largest([tree.get(one) for one in names]) for names in alike for name in names}
    rows: list[tuple[str, str]] = []
    for name, value in tree.items():
        key = f"{prefix}.{name}" if prefix else str(name)
        if isinstance(value, Mapping):
            rows += flat(value, key)
        else:
            rows.append((key, show(value, scales.get(name, 0.0))))
    return rows


def show(value: object, scale: float = 0.0) -> str:
    """A value of a results file in words: numbers to four digits, lists in one line and of one scale."""
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no", None: "none"}[value]
    if isinstance(value, float):
        return number(value, 4, scale=scale)
    if isinstance(value, list | tuple):
        scale = max(scale, largest(value))
        return ", ".join(show(entry, scale) for entry in value)
    return str(value)


def largest(value: object) -> float:
    """The largest magnitude among the numbers of a value of a results file; 0 where it has none."""
    if isinstance(value, list | tuple):
        return max(map(largest, value), default=0.0)
    return abs(value) if isinstance(value, int | float) else 0.0


def unit_scales(numbers: Iterable[tuple[str, float]]) -> dict[str, float]:
    """The largest magnitude of each unit among the numbers (unit, value) of a table."""
    scales: dict[str, float] = {}
    for unit, value in numbers:
        scales[unit] = max(scales.get(unit, 0.0), abs(value))
    return scales


def raised_units(words: str) -> str:
    """Words in which powers of units are raised: m² and m/s² for m2 and m/s2."""
    return POWER.sub(lambda found: found[1] + found[2].translate(RAISED), words)


def in_html(words: str) -> str:
    """Words as text of a page: powers of units raised, no sign that HTML would read, and numbers in one line."""
    return THOUSANDS.sub("\N{NO-BREAK SPACE}", escape(raised_units(words)))


def table_cell(value: float, scale: float = 0.0) -> str:
    """A number in a column: three digits, zeros at the end kept; scale: the largest of its unit in the table."""
    return number(value, zeros=True, scale=scale)
