"""The page of a study of journeys: where and when they end, why, how sure that is, and the first touchdown."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.content import Content, Plot, Section
from lithobrake.report.figures.aim_figure import aim_figure
from lithobrake.report.figures.journey_numbers import RestSpread, attitude_figure, counts_figure, spreads_figure
from lithobrake.report.figures.place_map import PlaceMap, Regions, local_figure, places_by_end, whole_figure
from lithobrake.report.figures.shares import Share
from lithobrake.report.figures.style import END_COLOURS, FATE_COLOURS
from lithobrake.report.figures.variance_figure import variance_figure
from lithobrake.report.live.body_view import end_views
from lithobrake.report.live.touchdown_explorer import touchdown_sections
from lithobrake.report.live.views import landing_views
from lithobrake.report.page_data import JourneyPage
from lithobrake.report.pages.drawn_page import landing_plots
from lithobrake.report.pages.shared_plots import draw_bed
from lithobrake.report.tables import drawn_tables
from lithobrake.report.tables import journey_tables as tables
from lithobrake.report.tables.dispersion_tables import site_tables
from lithobrake.report.words import captions
from lithobrake.report.words import journey_captions as words
from lithobrake.report.words.drawn_captions import aims
from lithobrake.report.words.journey_captions import END_WORDS
from lithobrake.results.journey_results import EndShare
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd
from lithobrake.vocabulary.percentages import LEVEL

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Titles of figures of a drawn study that are of first touchdowns here.
OF_FIRST = {"landing": "A first touchdown", "runs": "What the first touchdowns gave"}


def journey_content(data: JourneyPage) -> Content:
    """All that the page shows of the study."""
    first = Plot("ends", "Where the landers rest", words.rest_map(data), lambda: local_figure(_place_map(data)))
    sections = [_where(data), _when(data), _why(data), _sure(data), _method(data), _appendix(data)]
    return Content(words.answer(data), words.journey_warnings(data), tables.tiles(data), first, sections)


def _where(data: JourneyPage) -> Section:
    plots = [
        Plot("whole", "All ends, and the whole body", words.whole_map(data), lambda: _draw_whole(data)),
        Plot("attitude", "Side down and tilt", words.attitude(data), lambda: _draw_attitude(data)),
    ]
    return Section("Where", plots, tables.place_tables(data), end_views(data), words.details(data))


def _when(data: JourneyPage) -> Section:
    plots = [
        Plot("times", "Time to rest and distance", words.times(data), lambda: _draw_times(data)),
        Plot("counts", "Touchdowns and contacts", words.counts(data), lambda: _draw_counts(data)),
    ]
    return Section("When", plots, tables.time_tables(data))


def _why(data: JourneyPage) -> Section:
    """The parts of the variance, the sides of the lander, and the delivery options, as far as they are known."""
    aim, variance = data.results.aim, _of_landings(data)["variance"]
    first = Plot("variance", "The same of the first touchdown", words.first_variance(data), variance.draw)
    plots = [
        Plot("end_variance", "What decides the ends", words.end_variance(data), lambda: _draw_ends(data)),
        first,
    ]
    if aim is not None:
        plots.append(Plot("aim", "Delivery options", aims(data, aim), lambda: aim_figure(aim)))
    return Section("Why", plots, tables.side_tables(data))


def _sure(data: JourneyPage) -> Section:
    return Section("How sure", tables=tables.sure_tables(data))


def _method(data: JourneyPage) -> Section:
    """A touchdown and what the first ones gave, and what a reader can try."""
    found = _of_landings(data)
    plots = [
        Plot(name, title, words.of_first_touchdown(found[name].sentence), found[name].draw)
        for name, title in OF_FIRST.items()
    ]
    return Section("Method", plots, site_tables(data), [*landing_views(data), *touchdown_sections(data)])


def _appendix(data: JourneyPage) -> Section:
    """How the ground was poured, and the tables of the first touchdowns."""
    plots = [Plot("bed", "How the ground was made", captions.bed(data), lambda: draw_bed(data))]
    return Section(
        "Appendix",
        plots,
        tables.first_tables(
            [*drawn_tables.sure_tables(data), *drawn_tables.why_tables(data), *drawn_tables.method_tables(data)]
        ),
        is_printed=False,
    )


def _of_landings(data: JourneyPage) -> dict[str, Plot]:
    return {plot.name: plot for plot in landing_plots(data)}


def _place_map(data: JourneyPage) -> PlaceMap:
    table, site, delivery = data.journeys, data.results.site, data.results.delivery
    regions = [
        Regions("those at rest", END_COLOURS[JourneyEnd.AT_REST], data.at_rest.regions),
        Regions("the first impacts", FATE_COLOURS[FlightStatus.IMPACT], () if delivery is None else delivery.regions),
    ]
    return PlaceMap(
        places=places_by_end(END_WORDS, END_COLOURS, table["end"], table["latitude_deg"], table["longitude_deg"]),
        regions=regions,
        aim=(site.latitude_deg, site.longitude_deg),
        radius=float(np.linalg.norm(site.place_m)),
    )


def _draw_whole(data: JourneyPage) -> "Figure":
    shares = [_share(END_WORDS[name], one, END_COLOURS[name]) for name, one in data.ends.items()]
    return whole_figure(_place_map(data), shares, "all journeys")


def _draw_ends(data: JourneyPage) -> "Figure":
    known = {name: one for name, one in data.results.end_variance_shares.items() if one}
    return variance_figure(known, words.END_ROWS, LEVEL)


def _share(name: str, one: EndShare, colour: str) -> Share:
    return Share(name, one.share, one.lower, one.upper, LEVEL, colour)


def _draw_times(data: JourneyPage) -> "Figure":
    size, unit = words.time_unit(data)
    rest = data.at_rest
    return spreads_figure(
        [
            RestSpread(f"time to rest [{unit}]", _of_rest(data, "time_s") / size, rest.time_s, 1.0 / size),
            RestSpread("distance from the aim point [m]", _of_rest(data, "distance"), rest.distance_m),
        ]
    )


def _draw_counts(data: JourneyPage) -> "Figure":
    table = data.journeys
    counts = {"touchdowns": table["touchdowns"], "contacts with the ground": table["contacts"]}
    return counts_figure(counts, table["end"], END_WORDS)


def _draw_attitude(data: JourneyPage) -> "Figure | None":
    rest = data.at_rest
    if rest.tilt_deg is None:
        return None
    colour = END_COLOURS[JourneyEnd.AT_REST]
    sides = sorted(rest.faces.items(), key=lambda one: -one[1].share)
    tilt = RestSpread("tilt of the side that is down [deg]", _of_rest(data, "tilt_deg"), rest.tilt_deg)
    return attitude_figure([_share(name, one, colour) for name, one in sides], "those at rest", tilt)


def _of_rest(data: JourneyPage, name: str) -> np.ndarray:
    """A number of the landers at rest, shape [lander]."""
    values: np.ndarray = data.journeys[name][data.journeys["end"] == JourneyEnd.AT_REST]
    return values
