"""Figures that the page of any study has: the surface, a landing, where landers come down and where they rest."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.figures.bed_figure import bed_figure
from lithobrake.report.figures.body_figure import body_figure
from lithobrake.report.figures.hulls import scene
from lithobrake.report.figures.landing_figure import landing_figure
from lithobrake.report.figures.map_figure import Share, map_figure
from lithobrake.report.figures.rest_figure import RestMap, rest_figure
from lithobrake.report.page_data import PageData, PaperPage, SampledPage
from lithobrake.report.tables.dispersion_tables import GROUND_WORDS, followed, parts
from lithobrake.report.words.captions import hours, thousands
from lithobrake.results.dispersion import RestResults
from lithobrake.results.shares import CountedShare
from lithobrake.vocabulary.fate_colours import FATE_COLOURS
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# What may become of a landing, as short as it has to be beside a bar.
SHORT_OUTCOME_WORDS: dict[str, str] = {
    FlightStatus.IMPACT: "impact within {hours}",
    FlightStatus.FLYING: "flying after {hours}",
    FlightStatus.PARTNER: "on the partner",
}
# What may become of a lander after all bounces, as short as it has to be beside a bar.
SHORT_JOURNEY_WORDS = {
    JourneyStatus.SETTLED: "at rest",
    JourneyStatus.LOFTED: "lifted off again",
    JourneyStatus.OUTSIDE: "unknown outcome",
    JourneyStatus.SLIDING: "still sliding",
    JourneyStatus.BOUNCING: "still bouncing",
    JourneyStatus.FLYING: "not at rest, {hours}",
    JourneyStatus.ESCAPED: JourneyStatus.ESCAPED.label,
    JourneyStatus.PARTNER: "on the partner",
}


def draw_bed(data: PageData) -> "Figure | None":
    if data.bed is None:
        return None
    return bed_figure(scene(data.bed, has_lander=False), data.results.beds[0].surface_height_m)


def draw_landing(data: PageData) -> "Figure | None":
    if data.landing is None:
        return None
    return landing_figure(scene(data.landing, has_lander=True))


def draw_map(data: SampledPage) -> "Figure":
    site, shares, ellipses = data.results.site, impact_shares(data), data.results.ellipses
    where = (site.latitude_deg, site.longitude_deg)
    return map_figure(data.latitude, data.longitude, where, shares, data.body_vertices, ellipses, whole_words(data))


def impact_shares(data: SampledPage) -> list[Share]:
    """What becomes of the landings after the first bounce, as bars have it."""
    table, limit = data.results.shares, hours(data.study["flight"]["duration"])
    words = {key: SHORT_OUTCOME_WORDS.get(key, long).format(hours=limit) for key, long in parts(data).items()}
    return [_share(data, key, short, table.outcomes[key]) for key, short in words.items()]


def _share(data: SampledPage, fate: str, words: str, entry: CountedShare) -> Share:
    """A share of the summary, with its interval or its limit where it has one."""
    limit = entry.upper_limit
    lower, upper = (entry.lower, entry.upper) if limit is None else (None, limit)
    return Share(words, entry.share, lower, upper, data.level, FATE_COLOURS[fate], data.digits)


def whole_words(data: SampledPage) -> str:
    """What the shares of the flights are shares of."""
    if not isinstance(data, PaperPage):
        return "all landings"
    looked_at, count = data.results.shares.sample_count, data.results.monte_carlo.sample_count
    words = f"{thousands(looked_at)} samples"
    return f"all {words}" if looked_at == count else f"the {words} up to the last that was flown"


def draw_body(data: SampledPage) -> "Figure":
    return body_figure(data.body_vertices, data.body_faces, data.facet, np.array(data.results.site.place_m))


def draw_rest(data: SampledPage) -> "Figure":
    found, site, limit = followed(data), data.results.site, hours(data.study["rest"]["duration"])
    rest = data.results.rest
    why_no_soil = rest.why_no_soil if isinstance(rest, RestResults) else None
    # The same statuses on both sides, so that rows and colours match.
    met = {
        key: words
        for key, words in SHORT_JOURNEY_WORDS.items()
        if any(one.outcomes[key].count for one in found.values())
    }
    maps = []
    for ground, (latitude, longitude) in data.rest.items():
        table = found.get(ground)
        shares = [
            _share(data, key, words.format(hours=limit), table.outcomes[key]) for key, words in met.items() if table
        ]
        absent = None if table else f"Not asked: {why_no_soil}."
        ellipses = table.ellipses if table else None
        whole = f"the {table.sample_count} followed" if table else ""
        maps.append(RestMap(f"On {GROUND_WORDS[ground]}", latitude, longitude, ellipses, shares, absent, whole))
    return rest_figure(maps, (site.latitude_deg, site.longitude_deg), data.body_vertices)
