"""What a page is made of: figures, tiles, tables and parts that a reader moves, before they are HTML."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Tile:
    """One of the few numbers that a reader takes away."""

    value: str
    unit: str
    words: str


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
    """A figure of the page: title, one sentence that says what it shows, and the picture (PNG) if there is one.

    heading: that it stands under, as the first; tables: that stand below it.
    """

    title: str
    sentence: str
    picture: bytes | None
    heading: str = ""
    tables: Sequence[PageTable] = ()


@dataclass(frozen=True)
class Plot:
    """A figure that is still to be drawn: name of its file, title, sentence, and what draws it, or None.

    heading and tables as of a Panel.
    """

    name: str
    title: str
    sentence: str
    draw: Callable[[], "Figure | None"]
    heading: str = ""
    tables: Sequence[PageTable] = ()


@dataclass(frozen=True)
class LiveSection:
    """A part of the page that a reader moves, as HTML, under a heading that others may share, and its scripts."""

    heading: str
    html: str
    scripts: tuple[str, ...]


@dataclass(frozen=True)
class Content:
    """What a page says of its study: the answer, what to beware of in sentences, and what stands below."""

    answer: str
    warnings: Sequence[str]
    tiles: Sequence[Tile]
    plots: Sequence[Plot]
    tables: Sequence[PageTable]
    live: Sequence[LiveSection] = ()
