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
from lithobrake.report.pages import first_touchdown, study_page
from lithobrake.results.page_data import PageData, PageJourneys, page_results
from lithobrake.statements.journeys import end_rows
from lithobrake.statements.labels import end_words
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

        Of a study of first touchdowns: the next impacts of its samples. Where they lie far apart: the half of the body
        around the aim point.
        """
        page = self._page
        if page.samples is not None and not page.to_rest:
            shown = first_touchdown.impacts(page)
        else:
            shown = study_page.end_map(page, self._journeys("map"))
        with _axes(ax, (6.2, 6.2)) as axes:
            draw_map(axes, shown)
        return axes

    def ends(self, ax: Axes | None = None) -> Axes:
        """How the journeys end, or what becomes of the landings after the first touchdown: shares with intervals."""
        page = self._page
        with _axes(ax, (7.2, 2.4)) as axes:
            if page.to_rest:
                draw_shares(axes, study_page.end_shares(page), "all journeys")
            else:
                draw_shares(axes, first_touchdown.outcome_shares(page), first_touchdown.whole_words(page))
        return axes

    def times(self, ax: Axes | None = None) -> Axes:
        """The distribution function of the time to rest, with its median and 95th percentile and their intervals."""
        return self._spread("times", study_page.time_spread, ax)

    def distances(self, ax: Axes | None = None) -> Axes:
        """The same of the distance from the aim point of the landers at rest."""
        return self._spread("distances", study_page.distance_spread, ax)

    def tilts(self, ax: Axes | None = None) -> Axes:
        """The same of the tilt of the side that is down; a ball has none."""
        return self._spread("tilts", study_page.tilt_spread, ax)

    def sides(self, ax: Axes | None = None) -> Axes:
        """Which side of the lander is down at rest, by its own axes: shares with intervals; a ball has none."""
        shares = study_page.side_shares(self._journeys("sides"))
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
        """Parts of the variance of the ends of the journeys, or of the outputs of first touchdowns."""
        page = self._page
        shares, rows = page.results.variance_shares, first_touchdown.RETURNS_ROW
        if page.to_rest:
            shares = {name: one for name, one in page.results.end_variance_shares.items() if one}
            rows = end_rows(page.results)
        known = [one for one in shares.values() if one]
        if not known:
            raise ValueError(f"plot.variance shows parts of a variance, which {self._study.folder} has none of")
        with _axes(ax, (7.2, 1.4 + 0.7 * len(shares))) as axes:
            draw_parts(axes, shares, rows)
            axes.legend(handles=part_handles(known), loc="upper left", bbox_to_anchor=(1.0, 1.0))
        return axes

    def rebounds(self, ax: Axes | None = None) -> Axes:
        """Speed and elevation after the first touchdown of each lander that left."""
        page = self._page
        self._journeys("rebounds")
        landings = first_touchdown.landings_of_runs(page)
        with _axes(ax, (5.2, 4.2)) as axes:
            draw_rebounds(axes, landings, first_touchdown.quantiles_of_runs(page))
            axes.set_xlim(left=0.0)
        return axes

    @cached_property
    def _page(self) -> PageData:
        return page_results(self._study)

    def _journeys(self, name: str) -> PageJourneys:
        """The drawn landers. Raises ValueError where none was drawn."""
        found = self._page.journeys
        if found is None:
            raise ValueError(
                f"plot.{name} shows drawn landers, which {self._study.folder} has none of; it has plot.map and "
                "plot.ends"
            )
        return found

    def _spread(self, name: str, spread: Callable[[PageJourneys], RestSpread | None], ax: Axes | None) -> Axes:
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
        table = self._journeys(name).table
        with _axes(ax, (5.2, 3.6)) as axes:
            draw_counts(axes, table[name], table["end"], end_words(self._page.results.site))
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
