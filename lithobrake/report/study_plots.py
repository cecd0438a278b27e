"""Figures of a study one by one, on axes of matplotlib, for a notebook or a paper; drawn by what draws the report."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cached_property
from typing import TYPE_CHECKING

from matplotlib.axes import Axes

from lithobrake.report.figures.place_map import draw_map
from lithobrake.report.figures.run_figures import draw_parts, draw_rebounds, part_handles
from lithobrake.report.figures.share_figures import RestSpread, draw_counts, draw_shares, draw_spread
from lithobrake.report.figures.style import figure_style
from lithobrake.report.page_data import DrawnPage, JourneyPage, PaperPage, page_results
from lithobrake.report.pages import drawn_page, journey_page, shared_plots
from lithobrake.report.words.journey_captions import END_ROWS, END_WORDS
from lithobrake.vocabulary.plain_text import in_lines

if TYPE_CHECKING:
    from lithobrake.results import StudyResults

OF_REST = "share of those at rest [%]"


class StudyPlots:
    """Figures of a finished study; each takes axes to draw on, or makes a figure of its own, and returns the axes.

    A figure of its own has the look of the report; axes that are given keep the settings of whoever made them.
    Raises ValueError for a figure that the study has not, and for a study that has not run to its end.
    """

    def __init__(self, study: "StudyResults") -> None:
        """Take over a study; nothing is read before a figure is asked for."""
        self._study = study

    def map(self, ax: Axes | None = None) -> Axes:
        """Where the landers end, in metres about the aim point, with the smallest regions that hold 50 and 95 % of
        those at rest and of the first impacts.

        Of a study of single landings: the impacts after the first bounce. Where they lie far apart: the half of the
        body around the aim point.
        """
        page = self._page
        shown = journey_page.place_map(page) if isinstance(page, JourneyPage) else shared_plots.impacts(page)
        with _axes(ax, (6.2, 6.2)) as axes:
            draw_map(axes, shown)
        return axes

    def ends(self, ax: Axes | None = None) -> Axes:
        """How the journeys end, or what becomes of the landings after the first bounce: shares with intervals."""
        page = self._page
        with _axes(ax, (7.2, 2.4)) as axes:
            if isinstance(page, JourneyPage):
                draw_shares(axes, journey_page.end_shares(page), "all journeys")
            else:
                draw_shares(axes, shared_plots.impact_shares(page), shared_plots.whole_words(page))
        return axes

    def times(self, ax: Axes | None = None) -> Axes:
        """The distribution function of the time to rest, with its median and 95th percentile and their intervals."""
        return self._spread("times", journey_page.time_spread, ax)

    def distances(self, ax: Axes | None = None) -> Axes:
        """The same of the distance from the aim point of the landers at rest."""
        return self._spread("distances", journey_page.distance_spread, ax)

    def tilts(self, ax: Axes | None = None) -> Axes:
        """The same of the tilt of the side that is down; a ball has none."""
        return self._spread("tilts", journey_page.tilt_spread, ax)

    def sides(self, ax: Axes | None = None) -> Axes:
        """Which side of the lander is down at rest, by its own axes: shares with intervals; a ball has none."""
        shares = journey_page.side_shares(self._journeys("sides"))
        if not shares:
            raise ValueError(_NO_SIDES.format("sides"))
        with _axes(ax, (7.2, 2.4)) as axes:
            draw_shares(axes, shares, "those at rest")
        return axes

    def touchdowns(self, ax: Axes | None = None) -> Axes:
        """How many touchdowns a journey has, by how it ended."""
        return self._counts("touchdowns", "touchdowns", ax)

    def contacts(self, ax: Axes | None = None) -> Axes:
        """How many contacts with the ground a journey has, by how it ended."""
        return self._counts("contacts", "contacts with the ground", ax)

    def variance(self, ax: Axes | None = None) -> Axes:
        """What decides the ends of the journeys, or the outputs of single landings: parts of each variance."""
        page = self._page
        if isinstance(page, PaperPage):
            raise ValueError(f"{self._study.folder} is of a paper study, without parts of the variance")
        shares, rows = page.results.variance_shares, drawn_page.RETURNS_ROW
        if isinstance(page, JourneyPage):
            shares, rows = {name: one for name, one in page.results.end_variance_shares.items() if one}, END_ROWS
        known = [one for one in shares.values() if one]
        if not known:
            raise ValueError(f"the runs of {self._study.folder} do not tell the parts of the variance")
        with _axes(ax, (7.2, 1.4 + 0.7 * len(shares))) as axes:
            draw_parts(axes, shares, rows)
            axes.legend(handles=part_handles(known), loc="upper left", bbox_to_anchor=(1.0, 1.0))
        return axes

    def rebounds(self, ax: Axes | None = None) -> Axes:
        """Speed and elevation after the touchdown of each landing that left, or of each first one of a journey."""
        page = self._page
        if isinstance(page, PaperPage):
            raise ValueError(f"{self._study.folder} is of a paper study, without drawn landings")
        landings = drawn_page.landings_of_runs(page)
        with _axes(ax, (5.2, 4.2)) as axes:
            draw_rebounds(axes, landings, drawn_page.quantiles_of_runs(page))
            axes.set_xlim(left=0.0)
        return axes

    @cached_property
    def _page(self) -> PaperPage | DrawnPage | JourneyPage:
        return page_results(self._study)

    def _journeys(self, name: str) -> JourneyPage:
        """The study as one of journeys. Raises ValueError where it is none."""
        page = self._page
        if not isinstance(page, JourneyPage):
            raise ValueError(
                f"plot.{name} shows journeys to rest, which {self._study.folder} has none of; it has plot.map, "
                "plot.ends and, unless it is of a paper study, plot.variance and plot.rebounds"
            )
        return page

    def _spread(self, name: str, spread: Callable[[JourneyPage], RestSpread | None], ax: Axes | None) -> Axes:
        """A distribution function over the landers at rest."""
        found = spread(self._journeys(name))
        if found is None:
            raise ValueError(_NO_SIDES.format(name))
        if not len(found.values):
            raise ValueError(f"plot.{name} shows landers at rest, and none of {self._study.folder} is")
        with _axes(ax, (5.2, 3.6)) as axes:
            draw_spread(axes, found)
            axes.set_ylabel(OF_REST)
        return axes

    def _counts(self, name: str, label: str, ax: Axes | None) -> Axes:
        """Bars of a count over the journeys."""
        table = self._journeys(name).journeys
        with _axes(ax, (5.2, 3.6)) as axes:
            draw_counts(axes, table[name], table["end"], END_WORDS)
            axes.set(xlabel=label, ylabel="journeys")
            axes.legend()
        return axes

    def __repr__(self) -> str:
        """Name the figures."""
        names = [name for name in vars(type(self)) if not name.startswith("_")]
        return in_lines(f"StudyPlots of {self._study.folder}: {', '.join(f'{name}()' for name in names)}", "  ")


_NO_SIDES = "plot.{} shows sides of the lander, and a ball has none"


@contextmanager
def _axes(ax: Axes | None, size: tuple[float, float]) -> Iterator[Axes]:
    """The axes to draw on: those given, or those of a new figure of this size [inch] in the look of the report."""
    if ax is not None:
        yield ax
        return
    from matplotlib import pyplot

    with figure_style():
        _, axes = pyplot.subplots(figsize=size, layout="constrained")
        yield axes
