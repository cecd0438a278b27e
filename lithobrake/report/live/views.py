"""The views of the page in three dimensions: hulls, quantised poses and painted facets, for a browser to draw."""

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

import matplotlib
import numpy as np
from matplotlib.colors import LogNorm, to_rgb
from numpy.typing import NDArray

from lithobrake.report.content import LiveSection
from lithobrake.report.figures.body_figure import BARE, colour_ends, facet_density
from lithobrake.report.figures.hulls import Scene, scene
from lithobrake.report.live.packed import deflated, script_data
from lithobrake.report.page_data import JourneyPage, PageData, SampledPage
from lithobrake.report.words.numbers import number
from lithobrake.vocabulary.fate_colours import END_COLOURS, FATE_COLOURS
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd

Array = NDArray[np.float64]
SCRIPTS = ("live/view3d.js", "live/moving.js")
# Half of the range of a signed number of 16 bits.
LARGEST = 32767
# Speeds and forces are told apart over so many decades below the largest.
DECADES = 4.0
SHADE_UNITS = {"speed": "m/s", "force": "N"}
SHADE_WORDS = {"speed": "speed", "force": "the size of the sum of contact forces"}
# How a flight ended: its colour in a word, and what it did.
FATE_WORDS = {
    FlightStatus.IMPACT: ("blue", "impact"),
    FlightStatus.FLYING: ("grey", "still flying"),
    FlightStatus.ESCAPED: ("orange", FlightStatus.ESCAPED.label),
    FlightStatus.PARTNER: ("violet", "impact on the partner"),
}
# The colours of the ends of journeys.
END_COLOUR_WORDS: dict[str, str] = {
    JourneyEnd.AT_REST: "green",
    JourneyEnd.ESCAPED: "orange",
    JourneyEnd.PARTNER: "violet",
    JourneyEnd.UNDER_WAY: "grey",
    JourneyEnd.FAILED: "red",
}
# Length of a pin over the radius of the body.
PIN = 0.04
# A view takes in a sphere when its middle is so many radii away.
AWAY = 4.2


def view_sections(data: PageData) -> list[LiveSection]:
    """The landing that was kept, and the body with where landers come down, as far as there are such."""
    found = []
    if data.landing is not None and len(data.landing.time) > 1:
        found.append(_landing(scene(data.landing, has_lander=True), data.shown_landing))
    if isinstance(data, JourneyPage):
        found += _ends(data)
    elif isinstance(data, SampledPage) and len(data.facet):
        found.append(_body(data))
    return found


def _landing(shown: Scene, which: str) -> LiveSection:
    arrays, facts = landing_arrays(shown)
    return _section(
        "landing-3d", "The landing, to turn", f"{which}: {landing_words(shown, arrays, facts)}", arrays, facts
    )


def landing_words(shown: Scene, arrays: Mapping[str, np.ndarray], facts: Mapping[str, Any]) -> str:
    """What a view of a landing shows, and how exactly."""
    quantum = 1e3 * float(arrays["quanta"].max())
    images = "" if shown.box is not None else ", images of the ground that repeats among them,"
    return (
        f"{len(shown.moving.vertices) - 1} grains{images} and the lander in {len(shown.moving.time)} pictures, "
        f"straight between them. Places are rounded to {number(quantum, 2)} mm, and grains that hardly move to less. "
        f"Colour by {' or '.join(_scale_words(one) for one in facts['shades'])}, over equal factors."
    )


def landing_arrays(scene: Scene) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Arrays and numbers of a landing, all its bodies and frames, and from where it is looked at.

    Of each pose the difference from that of the frame before, in quanta of the body: place (x, y, z), quaternion
    (x, y, z, w). Whatever does not move is zeros, of which next to nothing is left when they are deflated.
    """
    moving = scene.moving
    low, high = moving.position.min(axis=0), moving.position.max(axis=0)
    reach = 0.5 * (high - low).max(axis=1)
    # What never moves has no way that a quantum could be a part of.
    quanta = (np.where(reach > 0.0, reach, 1.0) / LARGEST).astype(np.float32)
    middles = (0.5 * (low + high)).astype(np.float32)
    place = np.clip(np.rint((moving.position - middles) / quanta[:, None]), -LARGEST, LARGEST)
    turn = np.rint(LARGEST * _continuous(moving.orientation)[:, :, [1, 2, 3, 0]])
    whole = np.concatenate([place, turn], axis=2).astype(np.int32)
    # Differences may be twice as large as the numbers: they wrap around, and so do their sums.
    steps = np.diff(whole, axis=0, prepend=np.zeros_like(whole[:1])).astype(np.int16)
    shown = {"speed": np.linalg.norm(np.gradient(moving.position, moving.time, axis=0), axis=2)}
    if moving.force is not None:
        shown["force"] = moving.force
    largest = {name: float(values.max()) or 1.0 for name, values in shown.items()}
    arrays = {
        **_geometry([(body.vertices, body.faces) for body in scene.bodies]),
        "paint": _painted([to_rgb(body.colour) for body in scene.bodies], [len(body.faces) for body in scene.bodies]),
        "times": moving.time.astype(np.float32),
        "steps": steps,
        "middles": middles,
        "quanta": quanta,
        **{name: _shades(values / largest[name]) for name, values in shown.items()},
    }
    shades = [{"name": name, "unit": SHADE_UNITS[name], "largest": most} for name, most in largest.items()]
    still = moving.position[0, :-1]
    middle = 0.5 * (still.min(axis=0) + still.max(axis=0))
    radius = float(np.linalg.norm(still - middle, axis=1).max())
    counts = {"bodyCount": len(scene.bodies), "frameCount": len(moving.time)}
    return arrays, {**counts, "shades": shades, "orbit": _orbit(middle, radius, -1.1, 0.35)}


def _shades(parts: Array) -> np.ndarray:
    """Parts of the largest value, any shape, as places on a scale of equal factors from 0 to 255."""
    with np.errstate(divide="ignore"):
        return np.clip(np.rint(255.0 * (1.0 + np.log10(parts) / DECADES)), 0, 255).astype(np.uint8)


def _scale_words(shade: Mapping[str, Any]) -> str:
    """The ends of a scale: "speed, from 1e-05 (dark) to 0.1 m/s (yellow)"."""
    most = shade["largest"]
    ends = f"from {number(most * 10**-DECADES, 2)} (dark) to {number(most, 2)} {shade['unit']} (yellow)"
    return f"{SHADE_WORDS[shade['name']]}, {ends}"


def _continuous(orientation: Array) -> Array:
    """Quaternions [frame, body, 4] of signs that do not jump from frame to frame: both signs are the same turn."""
    dots = (orientation[1:] * orientation[:-1]).sum(axis=2)
    signs = np.cumprod(np.where(dots < 0.0, -1.0, 1.0), axis=0)
    return orientation * np.concatenate([np.ones_like(signs[:1]), signs])[:, :, None]


def _body(data: SampledPage) -> LiveSection:
    """The body, facets coloured as in its figure, and the paths of some flights."""
    vertices, faces = data.body_vertices, data.body_faces
    density = facet_density(vertices[faces], data.facet)
    low, high = colour_ends(density)
    colours = np.where(
        density[:, None] > 0.0, matplotlib.colormaps["viridis"](LogNorm(low, high)(density))[:, :3], BARE
    )
    arrays, facts = _body_arrays(data, colours)
    words = (
        f"Impacts per hectare as in the figure of the body, from {number(low, 2)} (dark) to {number(high, 2)} (yellow)."
    )
    if len(data.paths[0]):
        # The ways reach farther out than the body.
        facts["orbit"]["distance"] *= 1.5
        arrays |= _paths(*data.paths)
        met = [FATE_WORDS[FlightStatus(word)] for word in dict.fromkeys(data.paths[1])]
        words += f" Lines: the ways of the first {len(data.paths[1])} flights, seen from the turning body; "
        words += ", ".join(f"{colour}: {what}" for colour, what in met) + "."
    return _section("body-3d", "Where the lander comes down, to turn", words, arrays, facts)


def _body_arrays(data: PageData, colours: Array) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Arrays and numbers of the body, looked at from above the site; colours: of its facets [facet, 3], in 0 to 1."""
    site = np.array(data.results.site.place_m)
    longitude, latitude = np.arctan2(site[1], site[0]), np.arctan2(site[2], np.hypot(site[0], site[1]))
    arrays = {
        **_geometry([(data.body_vertices, data.body_faces)]),
        "paint": np.rint(255.0 * colours).astype(np.uint8),
    }
    radius = float(np.linalg.norm(data.body_vertices, axis=1).max())
    orbit = _orbit(np.zeros(3), radius, float(longitude) - 0.4, float(latitude) + 0.3)
    return arrays, {"bodyCount": 1, "frameCount": 1, "shades": [], "orbit": orbit}


def _ends(data: JourneyPage) -> list[LiveSection]:
    """The body with a pin at the place of each lander on the ground, and the flights of the first journeys."""
    table, (ways, ended) = data.journeys, data.paths
    place = np.column_stack([table[f"position_{axis}"] for axis in "xyz"])
    on_ground = np.isfinite(place).all(axis=1)
    if not (on_ground.any() or len(ways)):
        return []
    arrays, facts = _body_arrays(data, np.broadcast_to(np.array(BARE), (len(data.body_faces), 3)))
    foot, end = place[on_ground], table["end"][on_ground]
    radius = float(np.linalg.norm(data.body_vertices, axis=1).max())
    head = foot + PIN * radius * foot / np.linalg.norm(foot, axis=1)[:, None]
    pins, lines = _paths(np.stack([foot, head], axis=1), end), _paths(ways, ended)
    arrays |= {name: np.concatenate([pins[name], lines[name]]) for name in pins}
    words = f"Pins: where {on_ground.sum()} landers ended on the ground."
    if len(ways):
        words += " Lines: the flights of the first journeys, seen from the turning body."
    met = dict.fromkeys([*end.tolist(), *ended])
    words += f" Colours: {', '.join(f'{END_COLOUR_WORDS[one]}: {JourneyEnd(one).label}' for one in met)}."
    return [_section("body-3d", "Where the landers rest, to turn", words, arrays, facts)]


def _paths(position: Array, status: Sequence[str]) -> dict[str, np.ndarray]:
    """Ends of the pieces of all ways [2 piece_count, 3], and the colour of each."""
    ends = np.stack([position[:, :-1], position[:, 1:]], axis=2).reshape(-1, 3)
    paint = np.array([to_rgb((FATE_COLOURS | END_COLOURS)[word]) for word in status]).reshape(-1, 3)
    # Two ends of each piece.
    of_ends = np.repeat(np.rint(255.0 * paint), 2 * (position.shape[1] - 1), axis=0)
    return {"path_corner": ends.astype(np.float32), "path_paint": of_ends.astype(np.uint8)}


def _geometry(hulls: Sequence[tuple[Array, NDArray[np.int64]]]) -> dict[str, np.ndarray]:
    """Vertices of all hulls one after the other, their faces as places among all, and the hull of each vertex."""
    counts = np.array([len(vertices) for vertices, _ in hulls])
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    faces = np.concatenate([own + start for (_, own), start in zip(hulls, first, strict=True)])
    return {
        "vertices": np.concatenate([vertices for vertices, _ in hulls]).astype(np.float32),
        "faces": faces.astype(np.int32),
        "vertexBody": np.repeat(np.arange(len(hulls)), counts).astype(np.float32),
    }


def _painted(colours: Sequence[tuple[float, float, float]], face_counts: Sequence[int]) -> np.ndarray:
    """The colour of each face [face, 3]; a few per cent of tint keep neighbours of one colour apart."""
    tint = 1.0 + 0.09 * np.sin(2.399963 * np.arange(len(colours)))
    shades = np.clip(255.0 * np.array(colours) * tint[:, None], 0.0, 255.0)
    return np.repeat(np.rint(shades), face_counts, axis=0).astype(np.uint8)


def _orbit(target: Array, radius: float, azimuth: float, elevation: float) -> dict[str, Any]:
    """Where a view begins: at what it looks [m], from which side [rad], and how far away [m]."""
    return {"target": target.tolist(), "distance": AWAY * radius, "azimuth": azimuth, "elevation": elevation}


def _section(name: str, title: str, words: str, arrays: dict[str, np.ndarray], facts: dict[str, Any]) -> LiveSection:
    hint = "Drag to turn; with the picture chosen by a click, the wheel comes nearer; two fingers do both."
    html = f"""<section id="{name}" class="view3d">
<h3>{escape(title)}</h3>
<canvas tabindex="0" role="img" aria-label="{escape(title, quote=True)}"></canvas>
<div class="tools"></div>
<p class="note">{escape(words)} {hint}</p>
</section>
{script_data(f"{name}-data", {**facts, "arrays": deflated(arrays)})}"""
    return LiveSection("In three dimensions", html, SCRIPTS)
