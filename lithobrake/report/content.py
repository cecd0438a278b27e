"""What a page is made of: figures, numbers, tables and parts that a reader moves, before they are HTML."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from lithobrake.statements.answers import Tile

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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
class Content:
    """What a page says of its study.

    answer: in one line; warnings: what to beware of; tiles: the numbers to take away; first: the figure beside them,
    if there is one; sections: all else, in their order.
    """

    answer: str
    warnings: Sequence[str]
    tiles: Sequence[Tile]
    first: Plot | None
    sections: Sequence[PageSection]

    @property
    def plots(self) -> list[Plot]:
        """All figures in their order, but for those of which there is nothing to say."""
        of_sections = [plot for section in self.sections for plot in section.plots]
        return [plot for plot in ([self.first] if self.first else []) + of_sections if plot.sentence]
