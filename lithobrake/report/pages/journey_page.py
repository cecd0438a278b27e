"""The page of a study of journeys, and a page about one journey."""

import base64
import io
from collections.abc import Mapping
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.report.content import Content, PageSection, Plot
from lithobrake.report.figures.hulls import scene
from lithobrake.report.figures.map_frames import track_map
from lithobrake.report.figures.option_figures import aim_figure
from lithobrake.report.figures.place_map import PlaceMap, Regions, local_figure, outcomes_figure, places_by_end
from lithobrake.report.figures.run_figures import variance_figure
from lithobrake.report.figures.share_figures import RestSpread, ShareBar, attitude_figure, counts_figure, spreads_figure
from lithobrake.report.figures.style import figure_style
from lithobrake.report.live.explorer import deflated, script_data, touchdown_sections
from lithobrake.report.live.views import AWAY, SCRIPTS, end_views, landing_arrays, landing_views, landing_words
from lithobrake.report.pages.drawn_page import landing_plots
from lithobrake.report.pages.html import own_file, page_head
from lithobrake.report.pages.shared_plots import draw_bed
from lithobrake.report.tables import drawn_tables
from lithobrake.report.tables import journey_tables as tables
from lithobrake.report.tables.dispersion_tables import site_tables
from lithobrake.results import JourneyMotion, JourneyTrack, MovingBodies, TouchdownFacts
from lithobrake.results.page_data import JourneyPage
from lithobrake.statements import captions
from lithobrake.statements import journeys as words
from lithobrake.statements.answers import journey_details, journey_page_answer, journey_tiles, journey_warnings
from lithobrake.statements.labels import END_WORDS
from lithobrake.statements.limits import options_caption
from lithobrake.vocabulary.number_words import LEVEL
from lithobrake.vocabulary.outcomes import END_COLOURS, FATE_COLOURS, FlightStatus, JourneyEnd

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Titles of figures of a drawn study that are of first touchdowns here.
OF_FIRST = {"landing": "A first touchdown", "runs": "Rebounds of the first touchdowns"}
MAP_WORDS = "Impacts in their order, joined by straight lines, and where the lander ended. The flights are not drawn."
HINT = "Drag to rotate; after a click on the picture the wheel zooms; two fingers do both."


def journey_content(data: JourneyPage) -> Content:
    """All that the page shows of the study."""
    shown = place_map(data)
    first = Plot("ends", "Where the landers rest", words.rest_map(data), lambda: local_figure(shown))
    found = {plot.name: plot for plot in landing_plots(data)}
    sections = [
        *(_where(data, shown), _when(data), _why(data, found), _sure(data)),
        *(_method(data, found), _appendix(data, found)),
    ]
    return Content(journey_page_answer(data), journey_warnings(data), journey_tiles(data), first, sections)


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
    return PageSection("Where", plots, tables.place_tables(data), end_views(data), journey_details(data))


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
        plots.append(Plot("aim", "Delivery options", options_caption(aim), lambda: aim_figure(aim)))
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


def end_shares(data: JourneyPage) -> list[ShareBar]:
    """How the journeys end, as bars have it."""
    return [ShareBar(END_WORDS[name], one.share, END_COLOURS[name]) for name, one in data.ends.items()]


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


def side_shares(data: JourneyPage) -> list[ShareBar]:
    """The sides that are down, the most frequent first; none for a ball."""
    sides = sorted(data.at_rest.faces.items(), key=lambda one: -one[1].share.value)
    return [ShareBar(name, one.share, END_COLOURS[JourneyEnd.AT_REST]) for name, one in sides]


def tilt_spread(data: JourneyPage) -> RestSpread | None:
    """The tilt of the side that is down; None for a ball."""
    tilt = data.at_rest.tilt_deg
    return None if tilt is None else RestSpread("tilt of the side that is down [deg]", _of_rest(data, "tilt_deg"), tilt)


def _of_rest(data: JourneyPage, name: str) -> np.ndarray:
    """A number of the landers at rest, shape [lander]."""
    values: np.ndarray = data.journeys[name][data.journeys["end"] == JourneyEnd.AT_REST]
    return values


def one_journey_page(motion: JourneyMotion) -> str:
    """The page as HTML that needs nothing but itself."""
    track = motion.track
    shown = list(zip(track.touchdowns, motion.bodies, strict=False))
    title = f"Journey {track.number}"
    scripts = "".join(own_file(name) for name in ("pages/page.js", *SCRIPTS, "live/touchdowns.js"))
    return f"""{page_head(title)}
<body><main>
<header>
<p class="kind">One lander</p>
<h1>{title}</h1>
<p class="answer">{escape(track.end_words)}</p>
</header>
{_table(track)}
<figure><img alt="{escape(MAP_WORDS)}" src="data:image/png;base64,{_map(track)}">
<figcaption>{escape(MAP_WORDS)}</figcaption></figure>
{_touchdowns(shown)}
<footer>Written by lithobrake. SI units; degrees where a label says so. Numbers count from 0.</footer>
</main>
<script>
{scripts}</script>
</body>
</html>
"""


def _table(track: JourneyTrack) -> str:
    """The touchdowns, a row each."""
    heads = (
        "touchdown", "after delivery", "impact speed [m/s]", "incidence [deg]", "rebound speed [m/s]", "on the bed [s]",
        "to the next [m]",
    )  # fmt: skip
    head = "".join(f'<th class="number">{name}</th>' for name in heads)
    rows = [one.cells(track.to_next(number)) for number, one in enumerate(track.touchdowns)]
    cells = ["".join(f'<td class="number">{escape(cell)}</td>' for cell in row) for row in rows]
    body = "".join(f"<tr>{row}</tr>\n" for row in cells)
    box = f"<table><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table>"
    return f'<div class="scroll" tabindex="0">{box}</div>'


def _map(track: JourneyTrack) -> str:
    """The map as a PNG in base64."""
    memory = io.BytesIO()
    with figure_style():
        # The picture's own metadata would differ between versions of matplotlib.
        track_map(track).savefig(memory, format="png", metadata={"Software": None})
    return base64.b64encode(memory.getvalue()).decode("ascii")


def _touchdowns(shown: list[tuple[TouchdownFacts, MovingBodies]]) -> str:
    """The view in three dimensions with the choice of a touchdown, and the numbers of each."""
    if not shown:
        return ""
    options = "".join(
        f'<option value="touchdown-{facts.number}">{escape(facts.words)}</option>' for facts, _ in shown
    )  # fmt: skip
    data = "".join(_data(facts, bodies) for facts, bodies in shown)
    return f"""<h2>In three dimensions</h2>
<section id="touchdowns-3d" class="view3d">
<p class="tools"><select aria-label="Touchdown">{options}</select></p>
<div></div>
<p class="note"></p>
</section>
{data}"""


def _near(bodies: MovingBodies) -> float:
    """How far away [m] a tile of the ground is seen whole."""
    return AWAY * float(max(bodies.attributes["width"]))


def _data(facts: TouchdownFacts, bodies: MovingBodies) -> str:
    """What a browser draws a touchdown from."""
    drawn = scene(bodies, has_lander=True)
    arrays, numbers = landing_arrays(drawn)
    # Where the lander goes far over ground that repeats, it would be a dot beside its whole way.
    if bodies.attributes.get("sides") == "periodic" and numbers["orbit"]["distance"] > (near := _near(bodies)):
        numbers |= {"follows": True, "orbit": {**numbers["orbit"], "distance": near}}
    words = f"{landing_words(drawn, arrays, numbers)} {HINT}"
    return script_data(f"touchdown-{facts.number}-data", {**numbers, "words": words, "arrays": deflated(arrays)})
