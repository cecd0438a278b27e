"""The page of a study of journeys: where and when they end, why, how sure that is, and the first touchdown."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.content import Content, PageSection, Plot
from lithobrake.report.figures.aim_figure import aim_figure
from lithobrake.report.figures.journey_numbers import RestSpread, attitude_figure, counts_figure, spreads_figure
from lithobrake.report.figures.place_map import PlaceMap, Regions, local_figure, outcomes_figure, places_by_end
from lithobrake.report.figures.shares import Share
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
from lithobrake.vocabulary.fate_colours import END_COLOURS, FATE_COLOURS
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd
from lithobrake.vocabulary.percentages import LEVEL

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Titles of figures of a drawn study that are of first touchdowns here.
OF_FIRST = {"landing": "A first touchdown", "runs": "Rebounds of the first touchdowns"}


def journey_content(data: JourneyPage) -> Content:
    """All that the page shows of the study."""
    shown = place_map(data)
    first = Plot("ends", "Where the landers rest", words.rest_map(data), lambda: local_figure(shown))
    found = {plot.name: plot for plot in landing_plots(data)}
    sections = [
        *(_where(data, shown), _when(data), _why(data, found), _sure(data)),
        *(_method(data, found), _appendix(data, found)),
    ]
    return Content(words.answer(data), words.journey_warnings(data), tables.tiles(data), first, sections)


def _where(data: JourneyPage, shown: PlaceMap) -> PageSection:
    sentence = words.outcomes(data, has_map=shown.leaves_out)
    plots = [
        Plot(
            "outcomes",
            "How the journeys end",
            sentence,
            lambda: outcomes_figure(shown, end_shares(data), "all journeys"),
        ),
        Plot("attitude", "Side down and tilt", words.attitude(data), lambda: _draw_attitude(data)),
    ]
    return PageSection("Where", plots, tables.place_tables(data), end_views(data), words.details(data))


def _when(data: JourneyPage) -> PageSection:
    plots = [
        Plot("times", "Time to rest and distance", words.times(data), lambda: _draw_times(data)),
        Plot("counts", "Touchdowns and contacts", words.counts(data), lambda: _draw_counts(data)),
    ]
    return PageSection("When", plots, tables.time_tables(data))


def _why(data: JourneyPage, found: Mapping[str, Plot]) -> PageSection:
    """The parts of the variance, the sides of the lander, and the delivery options, as far as they are known."""
    aim, variance = data.results.aim, found["variance"]
    first = Plot("variance", "Sources of variance at the first touchdown", words.first_variance(data), variance.draw)
    plots = [
        Plot(
            "end_variance",
            "Sources of variance of outcome, time and distance",
            words.end_variance(data),
            lambda: _draw_ends(data),
        ),
        first,
    ]
    if aim is not None:
        plots.append(Plot("aim", "Delivery options", aims(data, aim), lambda: aim_figure(aim)))
    return PageSection("Why", plots, [*tables.soil_tables(data), *tables.side_tables(data)])


def _sure(data: JourneyPage) -> PageSection:
    return PageSection("How sure", tables=tables.sure_tables(data))


def _method(data: JourneyPage, found: Mapping[str, Plot]) -> PageSection:
    """A touchdown, and what a reader can try."""
    plots = [_of_first(found, "landing")]
    return PageSection("Method", plots, site_tables(data), [*landing_views(data), *touchdown_sections(data)])


def _appendix(data: JourneyPage, found: Mapping[str, Plot]) -> PageSection:
    """What the first touchdowns gave, how the ground was poured, and the tables of the first touchdowns."""
    bed = Plot("bed", "How the ground was made", captions.bed(data), lambda: draw_bed(data))
    return PageSection(
        "Appendix",
        [_of_first(found, "runs"), bed],
        tables.first_tables(
            [*drawn_tables.sure_tables(data), *drawn_tables.why_tables(data), *drawn_tables.method_tables(data)]
        ),
        is_printed=False,
    )


def _of_first(found: Mapping[str, Plot], name: str) -> Plot:
    """A figure of a drawn study that is of first touchdowns here; found: those of a drawn study, by name."""
    return Plot(name, OF_FIRST[name], found[name].sentence, found[name].draw)


def place_map(data: JourneyPage) -> PlaceMap:
    """Where the landers end, with the regions of those at rest and of the first impacts."""
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
        soils={name: one.outlines for name, one in data.results.soils.items()},
    )


def _draw_ends(data: JourneyPage) -> "Figure":
    known = {name: one for name, one in data.results.end_variance_shares.items() if one}
    return variance_figure(known, words.END_ROWS, LEVEL)


def _share(name: str, one: EndShare, colour: str) -> Share:
    return Share(name, one.share, one.lower, one.upper, LEVEL, colour)


def end_shares(data: JourneyPage) -> list[Share]:
    """How the journeys end, as bars have it."""
    return [_share(END_WORDS[name], one, END_COLOURS[name]) for name, one in data.ends.items()]


def _draw_times(data: JourneyPage) -> "Figure":
    return spreads_figure([time_spread(data), distance_spread(data)])


def time_spread(data: JourneyPage) -> RestSpread:
    """The time to rest, in minutes or hours."""
    size, unit = words.time_unit(data)
    return RestSpread(f"time to rest [{unit}]", _of_rest(data, "time_s") / size, data.at_rest.time_s, 1.0 / size)


def distance_spread(data: JourneyPage) -> RestSpread:
    """The distance from the aim point."""
    return RestSpread("distance from the aim point [m]", _of_rest(data, "distance"), data.at_rest.distance_m)


def _draw_counts(data: JourneyPage) -> "Figure":
    table = data.journeys
    counts = {"touchdowns": table["touchdowns"], "contacts with the ground": table["contacts"]}
    return counts_figure(counts, table["end"], END_WORDS)


def _draw_attitude(data: JourneyPage) -> "Figure | None":
    tilt = tilt_spread(data)
    return None if tilt is None else attitude_figure(side_shares(data), "those at rest", tilt)


def side_shares(data: JourneyPage) -> list[Share]:
    """The sides that are down, the most frequent first; none for a ball."""
    sides = sorted(data.at_rest.faces.items(), key=lambda one: -one[1].share)
    return [_share(name, one, END_COLOURS[JourneyEnd.AT_REST]) for name, one in sides]


def tilt_spread(data: JourneyPage) -> RestSpread | None:
    """The tilt of the side that is down; None for a ball."""
    tilt = data.at_rest.tilt_deg
    return None if tilt is None else RestSpread("tilt of the side that is down [deg]", _of_rest(data, "tilt_deg"), tilt)


def _of_rest(data: JourneyPage, name: str) -> np.ndarray:
    """A number of the landers at rest, shape [lander]."""
    values: np.ndarray = data.journeys[name][data.journeys["end"] == JourneyEnd.AT_REST]
    return values
