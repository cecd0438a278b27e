"""Figures that the page of any study has: the surface, a landing, where landers come down and where they rest."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.content import PageSection, Plot
from lithobrake.report.figures import place_map
from lithobrake.report.figures.body_figures import body_figure
from lithobrake.report.figures.expansion_figures import scatter_figure
from lithobrake.report.figures.hulls import scene
from lithobrake.report.figures.landing_figure import bed_figure, landing_figure
from lithobrake.report.figures.share_figures import ShareBar
from lithobrake.report.live.views import body_views
from lithobrake.report.tables.dispersion_tables import followed, parts, place_tables, site_tables
from lithobrake.results.page_data import DrawnPage, PageData, PaperPage, SampledPage
from lithobrake.results.run_results import CountedShare
from lithobrake.statements import captions
from lithobrake.statements.labels import GROUND_WORDS, PAPER_OUTPUTS, SHORT_JOURNEY_WORDS, SHORT_OUTCOME_WORDS
from lithobrake.vocabulary.number_words import time_limit
from lithobrake.vocabulary.outcomes import FATE_COLOURS, FlightStatus, JourneyStatus, TouchdownOutcome

if TYPE_CHECKING:
    from matplotlib.figure import Figure

AT_REST = FATE_COLOURS[JourneyStatus.SETTLED]


def first_map(data: SampledPage) -> Plot:
    """The figure beside the answer."""
    return Plot("map", "Where the lander comes down", captions.impact_map(data), lambda: draw_impacts(data))


def where(data: SampledPage, details: list[str]) -> PageSection:
    """Where landers come down and where they rest; details: what stands at its beginning."""
    plots = [
        Plot("outcomes", "Outcomes of the landings", captions.outcomes(data), lambda: draw_outcomes(data)),
        Plot("body", "Impacts on the body", captions.body(data), lambda: draw_body(data)),
        Plot("rest", "Where it rests", captions.rest(data), lambda: draw_rest(data)),
    ]
    return PageSection("Where", plots, place_tables(data), body_views(data), details)


def appendix(data: PageData) -> PageSection:
    """How the ground was poured."""
    plots = [Plot("bed", "How the ground was made", captions.bed(data), lambda: draw_bed(data))]
    return PageSection("Appendix", plots, site_tables(data), is_printed=False)


def draw_bed(data: PageData) -> "Figure | None":
    if data.bed is None:
        return None
    return bed_figure(scene(data.bed, has_lander=False), data.results.beds[0].surface_height_m)


def draw_landing(data: PageData) -> "Figure | None":
    if data.landing is None:
        return None
    return landing_figure(scene(data.landing, has_lander=True))


def draw_impacts(data: SampledPage) -> "Figure":
    return place_map.local_figure(impacts(data))


def draw_outcomes(data: SampledPage) -> "Figure":
    return place_map.outcomes_figure(impacts(data), impact_shares(data), whole_words(data))


def impact_shares(data: SampledPage) -> list[ShareBar]:
    """What becomes of the landings after the first bounce, as bars have it."""
    table, limit = data.results.shares, time_limit(data.study["flight"]["duration"])
    words = {key: SHORT_OUTCOME_WORDS.get(key, long).format(limit=limit) for key, long in parts(data).items()}
    return [_share(data, key, short, table.outcomes[key]) for key, short in words.items()]


def impacts(data: SampledPage) -> place_map.PlaceMap:
    """Where the landers come down after the first bounce, with the regions of these places."""
    colour = FATE_COLOURS[FlightStatus.IMPACT]
    places, regions = place_map.Places("impacts", colour, data.latitude, data.longitude), data.results.regions
    return place_map.PlaceMap([places], [place_map.Regions("the impacts", colour, regions)], *_aim(data))


def _aim(data: PageData) -> tuple[tuple[float, float], float]:
    """The aim point [deg], and the radius of the body there [m]."""
    site = data.results.site
    return (site.latitude_deg, site.longitude_deg), float(np.linalg.norm(site.place_m))


def _share(data: SampledPage, fate: str, words: str, entry: CountedShare) -> ShareBar:
    """A share of the summary, with its interval or its limit where it has one."""
    limited = entry if entry.upper_limit is None else entry.within(None, entry.upper_limit)
    return ShareBar(words, limited.share, FATE_COLOURS[fate], data.digits)


def whole_words(data: SampledPage) -> str:
    """What the shares of the flights are shares of."""
    if not isinstance(data, PaperPage):
        return "all landings"
    return captions.whole(data.results.shares.sample_count, data.results.monte_carlo.sample_count)


def draw_outputs(data: DrawnPage | PaperPage) -> "Figure | None":
    """The outputs of samples that leave beside those of runs; None where no sample does."""
    samples, runs = data.samples, data.runs
    leaves = samples["outcome"] == TouchdownOutcome.CLEAR
    if not leaves.any():
        return None
    left = runs["outcome"] == TouchdownOutcome.CLEAR
    return scatter_figure(
        {name: samples[name][leaves] for name in PAPER_OUTPUTS}, {name: runs[name][left] for name in PAPER_OUTPUTS}
    )


def draw_body(data: SampledPage) -> "Figure":
    return body_figure(data.body_vertices, data.body_faces, data.facet, np.array(data.results.site.place_m))


def draw_rest(data: SampledPage) -> "Figure | None":
    found, limit = followed(data), time_limit(data.study["rest"]["duration"])
    # The same statuses on both sides, so that rows and colours match.
    met = {
        key: words
        for key, words in SHORT_JOURNEY_WORDS.items()
        if any(one.outcomes[key].count for one in found.values())
    }
    maps = []
    for ground, (latitude, longitude) in data.rest.items():
        table = found.get(ground)
        if table is None:
            continue
        shares = [_share(data, key, words.format(limit=limit), table.outcomes[key]) for key, words in met.items()]
        places = place_map.Places("at rest", AT_REST, latitude, longitude)
        regions = place_map.Regions("those at rest", AT_REST, table.regions)
        whole = f"the {table.sample_count} followed"
        maps.append(place_map.RestMap(f"On {GROUND_WORDS[ground]}", places, regions, shares, whole))
    return place_map.rest_figure(maps, *_aim(data)) if maps else None
