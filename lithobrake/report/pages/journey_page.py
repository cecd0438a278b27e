"""The page of a study of journeys: where they end, then what decides it, and the first touchdown."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.content import Content, Plot
from lithobrake.report.figures.aim_figure import aim_figure
from lithobrake.report.figures.journey_map import journey_map, places_by_end
from lithobrake.report.figures.journey_numbers import RestSpread, attitude_figure, counts_figure, spreads_figure
from lithobrake.report.figures.map_figure import Share
from lithobrake.report.figures.variance_figure import variance_figure
from lithobrake.report.live.touchdown_explorer import touchdown_sections
from lithobrake.report.live.views import view_sections
from lithobrake.report.page_data import JourneyPage
from lithobrake.report.pages.drawn_page import landing_plots
from lithobrake.report.tables.journey_tables import journey_tables, rest_tables, side_tables, tiles
from lithobrake.report.words import journey_captions as words
from lithobrake.report.words.drawn_captions import aims
from lithobrake.report.words.journey_captions import END_WORDS
from lithobrake.results.journey_results import EndShare
from lithobrake.vocabulary.fate_colours import END_COLOURS
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.percentages import LEVEL

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WHERE, DECIDES, FIRST = "Where it ends up", "What decides it", "The first touchdown"
# Figures of a drawn study by the part of this page, with another title where its own speaks of more.
OF_FIRST = {
    "bed": "", "landing": "A first touchdown", "runs": "What the first touchdowns gave",
}  # fmt: skip


def journey_content(data: JourneyPage) -> Content:
    """All that the page shows of the study."""
    plots = [*_ends(data), *_decides(data), *_part(data, FIRST, OF_FIRST)]
    live = [*touchdown_sections(data), *view_sections(data)]
    return Content(words.answer(data), words.journey_warnings(data), tiles(data), plots, journey_tables(data), live)


def _ends(data: JourneyPage) -> list[Plot]:
    """How the journeys end, the first under its heading."""
    plots = [
        Plot("ends", "Where the landers rest", words.rest_map(data), lambda: _draw_map(data), WHERE, rest_tables(data)),
        Plot("times", "Time to rest and distance", words.times(data), lambda: _draw_times(data)),
        Plot("counts", "Touchdowns and contacts", words.counts(data), lambda: _draw_counts(data)),
        Plot("attitude", "Side down and tilt", words.attitude(data), lambda: _draw_attitude(data)),
        *_options(data),
    ]
    shown = [plot for plot in plots if plot.sentence]
    return [replace(shown[0], heading=WHERE), *shown[1:]]


def _options(data: JourneyPage) -> list[Plot]:
    """What becomes of the landers at each delivery option, where the study has any."""
    aim = data.results.aim
    return [] if aim is None else [Plot("aim", "Delivery options", aims(data, aim), lambda: aim_figure(aim))]


def _decides(data: JourneyPage) -> list[Plot]:
    """The parts of the variance of the ends, and of the first touchdown, where they are known."""
    sides = side_tables(data)
    first = next(one for one in landing_plots(data) if one.name == "variance")
    plots = [
        Plot("end_variance", "Parts of the variance of the ends", words.end_variance(data), lambda: _draw_ends(data)),
        replace(first, title="Parts of the variance of the first touchdown", sentence=words.first_variance(data)),
    ]
    shown = [plot for plot in plots if plot.sentence]
    headed = [replace(plot, heading=DECIDES, tables=sides) for plot in shown[:1]]
    return [*headed, *shown[1:]]


def _draw_ends(data: JourneyPage) -> "Figure":
    known = {name: one for name, one in data.results.end_variance_shares.items() if one}
    return variance_figure(known, words.END_ROWS, LEVEL)


def _part(data: JourneyPage, heading: str, titles: dict[str, str]) -> list[Plot]:
    """Figures of a drawn study under a heading, each saying that it is of the first touchdown."""
    found = [plot for plot in landing_plots(data) if plot.name in titles and plot.sentence and _is_drawn(data, plot)]
    said = [
        replace(plot, title=titles[plot.name] or plot.title, sentence=_sentence(plot), heading="" if row else heading)
        for row, plot in enumerate(found)
    ]
    return [plot for plot in said if plot.sentence]


def _is_drawn(data: JourneyPage, plot: Plot) -> bool:
    """Whether there is a picture: a program or function of the user's own has no bed."""
    return plot.name != "bed" or data.bed is not None


def _sentence(plot: Plot) -> str:
    return plot.sentence if plot.name == "bed" else words.of_first_touchdown(plot.sentence)


def _draw_map(data: JourneyPage) -> "Figure":
    table, site = data.journeys, data.results.site
    places = places_by_end(END_WORDS, END_COLOURS, table["end"], table["latitude_deg"], table["longitude_deg"])
    radius = float(np.linalg.norm(site.place_m))
    aim, regions = (site.latitude_deg, site.longitude_deg), data.at_rest.regions
    delivery = None if data.results.delivery is None else data.results.delivery.ellipse
    return journey_map(places, regions, aim, radius, end_shares(data), "all journeys", data.body_vertices, delivery)


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
