"""The page of a study: where and when its landers come to rest, why, how sure that is, and how it was found."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.content import Content, PageSection, PageTable, Plot
from lithobrake.report.figures.ground_figure import ground_figure
from lithobrake.report.figures.hulls import scene
from lithobrake.report.figures.landing_figure import bed_figure
from lithobrake.report.figures.option_figures import aim_figure, rare_figure
from lithobrake.report.figures.place_map import (
    PlaceMap,
    Places,
    Regions,
    RestMap,
    local_figure,
    outcomes_figure,
    places_by_end,
    rest_figure,
    whole_figure,
)
from lithobrake.report.figures.run_figures import variance_figure
from lithobrake.report.figures.share_figures import (
    RestSpread,
    ShareBar,
    attitude_figure,
    counts_figure,
    folded,
    spreads_figure,
)
from lithobrake.report.live.body_view import body_views
from lithobrake.report.live.explorer import touchdown_sections
from lithobrake.report.live.landing_view import landing_views
from lithobrake.report.pages.first_touchdown import (
    aim_point,
    first_touchdown,
    impacts,
    landing_plot,
    share_bar,
    variance_plot,
)
from lithobrake.report.tables import dispersion_tables as dispersion
from lithobrake.report.tables import journey_tables
from lithobrake.report.tables.ground_strip import ground_strip
from lithobrake.report.tables.limit_state_tables import limit_state_tables
from lithobrake.results.page_data import PageData, PageJourneys
from lithobrake.statements import captions, grounds
from lithobrake.statements import journeys as words
from lithobrake.statements.answers import page_answer, page_details, page_tiles, page_warnings
from lithobrake.statements.labels import GROUND_WORDS, end_words, partner_words
from lithobrake.statements.limits import options_caption, rare_caption
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.number_words import LEVEL
from lithobrake.vocabulary.outcomes import END_COLOURS, FATE_COLOURS, FlightStatus, JourneyEnd

if TYPE_CHECKING:
    from matplotlib.figure import Figure

AT_REST = END_COLOURS[JourneyEnd.AT_REST]
GROUND_MAPS = ("expansion", "hard", "equivalent")


def study_content(data: PageData) -> Content:
    """All that the page shows of the study; with landers followed to rest, the first touchdown is a section."""
    first, asked, journeys = first_touchdown(data), _asked(data), data.journeys
    if data.to_rest and journeys is not None:
        whole = together("First touchdown", first, is_printed=data.samples is not None or data.expansion is not None)
        sections = [*_joined(_to_rest(data, journeys), asked), whole]
    else:
        sections = _joined(first, asked)
    return Content(
        page_answer(data),
        page_warnings(data),
        page_tiles(data),
        _first_plot(data),
        [*sections, _appendix(data)],
        ground_strip(data),
    )


def _joined(main: list[PageSection], more: list[PageSection]) -> list[PageSection]:
    """The sections, each with what another list has under its title."""
    return [together(one.title, [one, *(other for other in more if other.title == one.title)]) for one in main]


def together(title: str, sections: list[PageSection], *, is_printed: bool = True) -> PageSection:
    """Sections as one, in their order."""
    return PageSection(
        title,
        [plot for one in sections for plot in one.plots],
        [table for one in sections for table in one.tables],
        [live for one in sections for live in one.live],
        [said for one in sections for said in one.said],
        is_printed=is_printed,
    )


def _first_plot(data: PageData) -> Plot | None:
    """The figure beside the answer: where landers rest, or else where they impact after the first touchdown."""
    samples, journeys = data.samples, data.journeys
    if samples is not None and not data.to_rest:
        title, caption = "Where the lander comes down", captions.impact_map(samples)
        return Plot("map", title, caption, lambda: local_figure(impacts(data)))
    if journeys is None:
        return None
    title, caption = "Where the landers rest", words.rest_map(data.results, journeys.rest)
    return Plot("ends", title, caption, lambda: local_figure(end_map(data, journeys)))


def _to_rest(data: PageData, journeys: PageJourneys) -> list[PageSection]:
    """Where, when and how the landers rest, why, and how sure that is."""
    results, rest, shown = data.results, journeys.rest, end_map(data, journeys)
    where = [
        Plot(
            *("end_shares", "How the journeys end", words.outcomes(results, has_map=shown.leaves_out)),
            lambda: outcomes_figure(shown, end_shares(data), "all journeys"),
        ),
        Plot("attitude", "Side down and tilt", words.attitude(rest), lambda: _draw_attitude(journeys)),
    ]
    if journeys.is_on_partner.any():
        there = partner_words(results.site)
        where.append(
            Plot("partner_map", f"On {there}", words.partner_map(results), lambda: _draw_partner(data, journeys))
        )
    spreads = [time_spread(journeys), distance_spread(journeys)]
    when = [
        Plot("times", "Time to rest and distance", words.times(rest), lambda: spreads_figure(spreads)),
        Plot("counts", "Touchdowns and contacts", words.counts(journeys), lambda: _draw_counts(data, journeys)),
    ]
    title = "Sources of variance of outcome, time and distance"
    why = [Plot("end_variance", title, words.end_variance(results), lambda: _draw_ends(data)), variance_plot(data)]
    if results.ground_curve is not None:
        caption = grounds.curve_caption()
        why = [Plot("grounds", "The answer against the size of the grains", caption, lambda: draw_sizes(data)), *why]
    return [
        PageSection("Where", where, said=[miss] if (miss := words.mean_miss(rest.miss)) else []),
        PageSection("When", when, [journey_tables.rest_table(journeys)]),
        PageSection(
            "Why", why, [journey_tables.grounds_table(data, journeys), journey_tables.sides_table(data, journeys)]
        ),
        PageSection("How sure", tables=[journey_tables.ends_table(data, journeys)]),
        PageSection("Method"),
    ]


def _asked(data: PageData) -> list[PageSection]:
    """What studies ask whether landers are followed to rest or not: other ground, sky, soils, aim and limit states."""
    aim, rare = data.results.aim, data.rare
    hard = Plot(
        "hard_ground", "Where they rest on other ground", captions.hard_ground(data), lambda: _draw_ground(data)
    )
    options = [Plot("aim", "Delivery options", options_caption(aim), lambda: aim_figure(aim))] if aim else []
    levels = [Plot("rare", "Rare limit states", rare_caption(rare), lambda: rare_figure(rare))] if rare else []
    where = [
        dispersion.region_table(data, of_impacts=not data.to_rest, of_rest=True),
        journey_tables.sky_table(data),
        dispersion.ground_ends(data),
    ]
    live = [*landing_views(data), *touchdown_sections(data)]
    return [
        PageSection("Where", [hard], where, body_views(data), [page_details(data)]),
        PageSection("When", tables=[journey_tables.delivery_table(data), dispersion.ground_times(data)]),
        PageSection("Why", options, [journey_tables.soils_table(data)]),
        PageSection("How sure", levels, limit_state_tables(data)),
        PageSection("Method", [landing_plot(data)], live=live),
    ]


def _appendix(data: PageData) -> PageSection:
    """How the ground was poured, and the body."""

    def draw() -> "Figure | None":
        if data.bed is None:
            return None
        return bed_figure(scene(data.bed, has_lander=False), data.results.beds[0].surface_height_m)

    plots = [Plot("bed", "How the ground was made", captions.bed(data), draw)]
    tables: list[PageTable] = [dispersion.site_table(data), dispersion.beds_table(data)]
    return PageSection("Appendix", plots, tables, is_printed=False)


def end_map(data: PageData, journeys: PageJourneys) -> PlaceMap:
    """Where the landers end, with the regions of those at rest and of the first impacts."""
    delivery = data.results.delivery
    regions = [
        Regions("those at rest", AT_REST, journeys.rest.regions),
        Regions("the first impacts", FATE_COLOURS[FlightStatus.IMPACT], () if delivery is None else delivery.regions),
    ]
    names, table = end_words(data.results.site), journeys.elsewhere
    places = places_by_end(names, END_COLOURS, table["end"], table["latitude_deg"], table["longitude_deg"])
    soils = {name: one.outlines for name, one in data.results.soils.items()}
    states = {name: LimitState.of(one.condition) for name, one in data.results.limit_states.items() if one.of_journey}
    areas = {name: one for name, one in states.items() if one.has_area}
    return PlaceMap(places, regions, *aim_point(data), soils, areas=areas)


def _draw_partner(data: PageData, journeys: PageJourneys) -> "Figure":
    """Where landers end on the other body of a binary."""
    names, table = end_words(data.results.site), journeys.table.where(journeys.is_on_partner)
    places = places_by_end(names, END_COLOURS, table["end"], table["latitude_deg"], table["longitude_deg"])
    radius = float(np.linalg.norm([table[f"position_{axis}"] for axis in "xyz"], axis=0).mean())
    return whole_figure(PlaceMap(places, [], (0.0, 0.0), radius, has_aim=False))


def end_shares(data: PageData) -> list[ShareBar]:
    """How the journeys end, as bars have it; ends that no lander met are one bar."""
    names = end_words(data.results.site)
    return folded([ShareBar(names[name], one.share, END_COLOURS[name]) for name, one in data.results.ends.items()])


def _draw_ends(data: PageData) -> "Figure":
    known = {name: one for name, one in data.results.end_variance_shares.items() if one}
    return variance_figure(known, words.end_rows(data.results), LEVEL)


def time_spread(journeys: PageJourneys) -> RestSpread:
    """The time to rest, in minutes or hours."""
    size, unit = words.time_unit(journeys.rest)
    values = _of_rest(journeys, "time_s") / size
    return RestSpread(f"time to rest [{unit}]", values, journeys.rest.time_s, 1.0 / size)


def distance_spread(journeys: PageJourneys) -> RestSpread:
    """The distance from the aim point."""
    values = _of_rest(journeys, "distance")
    return RestSpread("distance from the aim point [m]", values, journeys.rest.distance_m)


def tilt_spread(journeys: PageJourneys) -> RestSpread | None:
    """The tilt of the side that is down; None for a ball."""
    tilt, label = journeys.rest.tilt_deg, "tilt of the side that is down [deg]"
    return None if tilt is None else RestSpread(label, _of_rest(journeys, "tilt_deg"), tilt)


def side_shares(journeys: PageJourneys) -> list[ShareBar]:
    """The sides that are down, the most frequent first; none for a ball."""
    return [ShareBar(name, one.share, AT_REST) for name, one in words.by_share(journeys.rest.faces)]


def _of_rest(journeys: PageJourneys, name: str) -> np.ndarray:
    """A number of the landers at rest, shape [lander]."""
    values: np.ndarray = journeys.table[name][journeys.table["end"] == JourneyEnd.AT_REST]
    return values


def draw_sizes(data: PageData) -> "Figure":
    """How the journeys end against the size of the grains."""
    results, journeys = data.results, data.journeys
    assert journeys is not None
    assert results.ground_curve is not None
    factor, unit = words.time_unit(journeys.rest)
    ranges = {name: one.grain_size_m for name, one in results.grounds.items()}
    return ground_figure(results.ground_curve, ranges, unit, factor)


def _draw_counts(data: PageData, journeys: PageJourneys) -> "Figure":
    table = journeys.table
    counts = {"touchdowns": table["touchdowns"], "contacts with the ground": table["contacts"]}
    return counts_figure(counts, table["end"], end_words(data.results.site))


def _draw_attitude(journeys: PageJourneys) -> "Figure | None":
    tilt = tilt_spread(journeys)
    return None if tilt is None else attitude_figure(side_shares(journeys), "those at rest", tilt)


def _draw_ground(data: PageData) -> "Figure":
    """Where landers rest on each other ground, and how they end there."""
    grounds, maps, names = data.results.hard_ground, [], end_words(data.results.site)
    # The same ends on all sides, so that rows and colours match.
    met = [key for key in names if any(key in one.ends and one.ends[key].count for one in grounds.values())]
    # Two maps have room side by side.
    for ground in [one for one in GROUND_MAPS if one in grounds][:2]:
        found, (latitude, longitude) = grounds[ground], data.hard_ground[ground]
        shares = [share_bar(found.ends[key], names[key], END_COLOURS[key], data.digits) for key in met]
        places, regions = (
            Places("at rest", AT_REST, latitude, longitude),
            Regions("those at rest", AT_REST, found.regions),
        )
        maps.append(RestMap(f"On {GROUND_WORDS[ground]}", places, regions, shares, f"the {found.count} followed"))
    return rest_figure(maps, *aim_point(data))
