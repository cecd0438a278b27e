"""The page about one journey: its touchdowns, its map, and the landings in three dimensions."""

import base64
import io
from html import escape

from lithobrake.report.figures.hulls import scene
from lithobrake.report.figures.map_frames import track_map
from lithobrake.report.figures.style import figure_style
from lithobrake.report.live.explorer import deflated, script_data
from lithobrake.report.live.landing_view import AWAY, SCRIPTS, landing_arrays, landing_words
from lithobrake.report.pages.html import own_file, page_head
from lithobrake.results import JourneyMotion, JourneyTrack, MovingBodies, TouchdownFacts

MAP_WORDS = "Impacts in their order, joined by straight lines, and where the lander ended. The flights are not drawn."
HINT = "Drag to rotate; after a click on the picture the wheel zooms; two fingers do both."


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
