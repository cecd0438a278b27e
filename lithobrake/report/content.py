"""What a page is made of: figures, numbers, tables and parts that a reader moves, before they are HTML."""

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import TYPE_CHECKING

from lithobrake.statements.answers import Tile
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import RAISED, number

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Powers of units, "m2" and "m/s2", behind a number, a bracket or a unit.
POWER = re.compile(
    r"(?:(?<=\b(?:m|J|N)/)|(?<=\bkg/)|(?<=\brad/)|(?<=\bm2/)|(?<=\[)|(?<=[\d⁰¹²³⁴⁵⁶⁷⁸⁹][ \N{NO-BREAK SPACE}]))"
    r"([ms])([23])\b"
)
# Blanks within a large number, and before the unit of an area.
THOUSANDS = re.compile(r"(?<=\d) (?=\d{3}\b)|(?<=\d) (?=m²)")


@dataclass(frozen=True)
class PageTable:
    """A table of the page; a column whose name stands in `numbers` is set to the right, a cell in `links` is one."""

    title: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    note: str = ""
    numbers: frozenset[str] = field(default_factory=frozenset)
    links: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Panel:
    """A figure of the page: title, sentences that say what it shows, and the picture (SVG), or None.

    Without a picture the sentences say why there is none.
    """

    title: str
    sentence: str
    picture: bytes | None


@dataclass(frozen=True)
class Plot:
    """A figure that is still to be drawn: name of its file, title, sentences, and what draws it, or None.

    One without a sentence is left out.
    """

    name: str
    title: str
    sentence: str
    draw: Callable[[], "Figure | None"]


@dataclass(frozen=True)
class LiveSection:
    """A part of the page that a reader moves, as HTML, and its scripts."""

    html: str
    scripts: tuple[str, ...]


@dataclass(frozen=True)
class PageSection:
    """A part of the page with an entry in the contents; empty ones are left out.

    said: sentences at its beginning; texts: files by title; is_printed: whether it stands on paper too.
    """

    title: str
    plots: Sequence[Plot] = ()
    tables: Sequence[PageTable] = ()
    live: Sequence[LiveSection] = ()
    said: Sequence[str] = ()
    texts: Mapping[str, str] = field(default_factory=dict)
    is_printed: bool = True


@dataclass(frozen=True)
class StripColumn:
    """One quantity of a strip: its words with the unit, an estimate for each row, in that unit, its words, and the end
    of the scale, which begins at 0.

    A row may have no estimate, and no words where they stand elsewhere on the same screen.
    """

    words: str
    found: Sequence[Estimate | None]
    shown: Sequence[str]
    end: float


@dataclass(frozen=True)
class Strip:
    """Answers on each part of what nobody knows, one below the other on the same scales.

    rows: name and what it is, of each; note: what bars and marks are.
    """

    title: str
    rows: Sequence[tuple[str, str]]
    columns: Sequence[StripColumn]
    note: str


@dataclass(frozen=True)
class Content:
    """What a page says of its study.

    answer: in one line; warnings: what to beware of; tiles: the numbers to take away; first: the figure beside them,
    if there is one; sections: all else, in their order; strip: the answer on each ground, where several are allowed.
    """

    answer: str
    warnings: Sequence[str]
    tiles: Sequence[Tile]
    first: Plot | None
    sections: Sequence[PageSection]
    strip: Strip | None = None

    @property
    def plots(self) -> list[Plot]:
        """All figures in their order, but for those of which there is nothing to say."""
        of_sections = [plot for section in self.sections for plot in section.plots]
        return [plot for plot in ([self.first] if self.first else []) + of_sections if plot.sentence]


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
