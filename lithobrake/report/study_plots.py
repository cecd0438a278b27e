"""Figures of a study one by one, on axes of matplotlib, for a notebook or a paper; drawn by what draws the report."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cached_property
from typing import TYPE_CHECKING, NoReturn

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lithobrake.report.figures.place_map import draw_map
from lithobrake.report.figures.run_figures import draw_parts, draw_rebounds, part_handles
from lithobrake.report.figures.share_figures import RestSpread, draw_counts, draw_shares, draw_spread
from lithobrake.report.figures.style import figure_style
from lithobrake.report.pages import first_touchdown, study_page
from lithobrake.results.page_data import PageData, PageJourneys, page_results
from lithobrake.results.run_results import VarianceParts
from lithobrake.statements.journeys import end_rows
from lithobrake.statements.labels import end_words
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.plain_text import closest, in_lines

if TYPE_CHECKING:
    from lithobrake.results import StudyResults

OF_REST = "share of those at rest [%]"


class StudyPlots:
    """Figures of a finished study, drawn by what draws the report; `dir(plot)` lists those that this study has.

    Most take axes to draw on, or make a figure of their own, and return the axes; those of several panels return a
    figure. One of its own has the look of the report; axes that are given keep the settings of whoever made them.
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
        page = self._having("map")
        if page.journeys is None or (page.samples is not None and not page.to_rest):
            shown = first_touchdown.impacts(page)
        else:
            shown = study_page.end_map(page, page.journeys)
        with _axes(ax, (6.2, 6.2)) as axes:
            draw_map(axes, shown)
        return axes

    def ends(self, ax: Axes | None = None) -> Axes:
        """How the journeys end, or what becomes of the landings after the first touchdown: shares with intervals."""
        page = self._having("ends")
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
        shares = study_page.side_shares(_journeys(self._having("sides")))
        with _axes(ax, (7.2, 2.4)) as axes:
            draw_shares(axes, shares, "those at rest")
        return axes

    def touchdowns(self, ax: Axes | None = None) -> Axes:
        """How many touchdowns a journey has, by how it ended."""
        return self._counts("touchdowns", "touchdowns", ax)

    def contacts(self, ax: Axes | None = None) -> Axes:
        """How many contacts with the ground a journey has, by how it ended."""
        return self._counts("contacts", "contacts with the ground", ax)

    def sensitivity(self, ax: Axes | None = None) -> Axes:
        """Which part of the variance each cause has: of the ends of the journeys, or of the outputs of first
        touchdowns.
        """
        page = self._having("sensitivity")
        shares, rows = _parts(page), end_rows(page.results) if page.to_rest else first_touchdown.RETURNS_ROW
        with _axes(ax, (7.2, 1.4 + 0.7 * len(shares))) as axes:
            draw_parts(axes, shares, rows)
            handles = part_handles([one for one in shares.values() if one])
            axes.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.0, 1.0))
        return axes

    def grounds(self) -> Figure:
        """Fraction at rest, time to rest and upright axis against the size of the grains, on unknown ground."""
        page = self._having("grounds")
        return _whole(lambda: study_page.draw_sizes(page))

    def sobol(self) -> Figure:
        """First-order Sobol indices of the first touchdown, by the screening expansion."""
        expansion = self._having("sobol").expansion
        assert expansion is not None
        return _whole(lambda: first_touchdown.draw_sobol(expansion))

    def rebounds(self, ax: Axes | None = None) -> Axes:
        """Speed and elevation after the first touchdown of each lander that left."""
        page = self._having("rebounds")
        landings = first_touchdown.landings_of_runs(page)
        with _axes(ax, (5.2, 4.2)) as axes:
            draw_rebounds(axes, landings, first_touchdown.quantiles_of_runs(page))
            axes.set_xlim(left=0.0)
        return axes

    @cached_property
    def _page(self) -> PageData:
        return page_results(self._study)

    def _names(self) -> list[str]:
        """The figures that this study has."""
        return [name for name, (_, has) in _SHOWN.items() if has(self._page)]

    def _having(self, name: str) -> PageData:
        """What the page shows. Raises ValueError where this figure is none of it."""
        what, has = _SHOWN[name]
        if not has(self._page):
            raise ValueError(f"plot.{name} shows {what}, which {self._study.folder} has none of; it has {self._list()}")
        return self._page

    def _list(self) -> str:
        return ", ".join(f"plot.{name}" for name in self._names())

    def _spread(self, name: str, spread: Callable[[PageJourneys], RestSpread | None], ax: Axes | None) -> Axes:
        """A distribution function over the landers at rest."""
        found = spread(_journeys(self._having(name)))
        assert found is not None
        with _axes(ax, (5.2, 3.6)) as axes:
            draw_spread(axes, found)
            axes.set_ylabel(OF_REST)
        return axes

    def _counts(self, name: str, label: str, ax: Axes | None) -> Axes:
        """Bars of a count over the journeys."""
        page = self._having(name)
        table = _journeys(page).table
        with _axes(ax, (5.2, 3.6)) as axes:
            draw_counts(axes, table[name], table["end"], end_words(page.results.site))
            axes.set(xlabel=label, ylabel="journeys")
            axes.legend()
        return axes

    def __dir__(self) -> list[str]:
        """The names of the figures that this study has; none for one that has not run to its end."""
        # Who completes a name is told nothing; a figure that is asked for says what is wrong.
        with suppress(ValueError):
            return self._names()
        return []

    def __getattr__(self, name: str) -> NoReturn:
        """Name the figures where there is none of this name. Raises AttributeError."""
        if name.startswith("_"):
            raise AttributeError(name)
        raise AttributeError(
            f"plot.{name} is no figure{closest(name, _SHOWN)}; {self._study.folder} has {self._list()}"
        )

    def __repr__(self) -> str:
        """Name the figures."""
        return in_lines(f"StudyPlots of {self._study.folder}: {', '.join(f'{name}()' for name in dir(self))}", "  ")


def _journeys(page: PageData) -> PageJourneys:
    """The drawn landers of a study that has some."""
    assert page.journeys is not None
    return page.journeys


def _parts(page: PageData) -> dict[str, VarianceParts | None]:
    """The parts of each variance, by its row."""
    if page.to_rest:
        return {name: one for name, one in page.results.end_variance_shares.items() if one}
    return dict(page.results.variance_shares)


def _has_landers(page: PageData) -> bool:
    return page.journeys is not None


def _has_rest(page: PageData) -> bool:
    return page.journeys is not None and bool((page.journeys.table["end"] == JourneyEnd.AT_REST).any())


def _has_sides(page: PageData) -> bool:
    return page.journeys is not None and _has_rest(page) and page.journeys.rest.tilt_deg is not None


# What each figure shows, and whether a study has it.
_SHOWN: dict[str, tuple[str, Callable[[PageData], bool]]] = {
    "map": ("drawn landers or samples", lambda page: _has_landers(page) or page.samples is not None),
    "ends": ("ends", lambda page: True),
    "times": ("landers at rest", _has_rest),
    "distances": ("landers at rest", _has_rest),
    "sides": ("sides of landers at rest", _has_sides),
    "tilts": ("sides of landers at rest", _has_sides),
    "touchdowns": ("drawn landers", _has_landers),
    "contacts": ("drawn landers", _has_landers),
    "sensitivity": ("parts of a variance", lambda page: any(_parts(page).values())),
    "grounds": ("unknown ground ([ground])", lambda page: page.results.ground_curve is not None),
    "rebounds": ("drawn landers", _has_landers),
    "sobol": ("an expansion ([expansion])", lambda page: page.expansion is not None),
}


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


def _whole(draw: Callable[[], Figure]) -> Figure:
    """A figure of several panels."""
    # A notebook shows figures once this is there.
    import matplotlib.pyplot  # noqa: F401

    with figure_style():
        return draw()
