"""The view of a landing in three dimensions, and what any such view is made of."""

from collections.abc import Mapping, Sequence
from html import escape
from types import MappingProxyType
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from lithobrake.report.content import LiveSection, in_html
from lithobrake.report.figures.ground_map import round_length
from lithobrake.report.figures.hulls import Scene, scene
from lithobrake.report.figures.style import RULE
from lithobrake.report.live.explorer import deflated, script_data
from lithobrake.results.page_data import PageData
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.number_words import number

SCRIPTS = ("live/overlay.js", "live/view3d.js", "live/moving.js", "live/ways.js", "live/start3d.js")
FLOOR = "#e9e4da"
# Half of the range of a signed number of 16 bits.
LARGEST = 32767
# Speeds and forces are told apart over so many decades below the largest.
DECADES = 4.0
SHADE_UNITS = {"speed": "m/s", "force": "N"}
SHADE_WORDS = {"speed": "speed", "force": "net contact force"}
# A view takes in a sphere when its middle is so many radii away.
AWAY = 4.2


def landing_views(data: PageData) -> list[LiveSection]:
    """The landing that was kept, if there is one."""
    if data.landing is None or len(data.landing.time) < 2:
        return []
    return [_landing(scene(data.landing, has_lander=True), data.shown_landing)]


def _landing(shown: Scene, which: str) -> LiveSection:
    arrays, facts = landing_arrays(shown)
    return section(
        "landing-3d",
        "The landing in three dimensions",
        f"{which}: {landing_words(shown, arrays, facts)}",
        arrays,
        facts,
    )


def landing_words(shown: Scene, arrays: Mapping[str, np.ndarray], facts: Mapping[str, Any]) -> str:
    """What a view of a landing shows, and how exactly."""
    quantum = 1e3 * float(arrays["quanta"].max())
    images = "" if shown.box is not None else ", periodic images included,"
    names = " or ".join(SHADE_WORDS[one["name"]] for one in facts["shades"])
    return (
        f"{len(shown.moving.vertices) - 1} grains{images} and the lander (blue) in {len(shown.moving.time)} frames, "
        f"interpolated linearly, on a floor with a grid of {number(facts['grid'], 2)} m. Positions are rounded to "
        f"{number(quantum, 2)} mm, those of grains that hardly move more finely. Colour of the grains: {names}, on a "
        "logarithmic scale."
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
        **geometry([(body.vertices, body.faces) for body in scene.bodies]),
        "paint": painted([to_rgb(body.colour) for body in scene.bodies], [len(body.faces) for body in scene.bodies]),
        "times": moving.time.astype(np.float32),
        "steps": steps,
        "middles": middles,
        "quanta": quanta,
        **{name: _shades(values / largest[name]) for name, values in shown.items()},
    }
    shades = [
        {"name": name, "unit": SHADE_UNITS[name], "low": number(most * 10**-DECADES, 2), "high": number(most, 2)}
        for name, most in largest.items()
    ]
    still = moving.position[0, :-1]
    middle = 0.5 * (still.min(axis=0) + still.max(axis=0))
    radius = float(np.linalg.norm(still - middle, axis=1).max())
    floor, step = _floor(scene)
    counts = {"bodyCount": len(scene.bodies), "frameCount": len(moving.time), "grid": step}
    return arrays | floor, {**counts, "shades": shades, "orbit": orbit(middle, radius, -1.1, 0.35)}


def _floor(scene: Scene) -> tuple[dict[str, np.ndarray], float]:
    """The floor under the ground of a scene and a grid on it, and the width of a mesh of that [m]."""
    low, high = scene.ground.min(axis=0), scene.ground.max(axis=0)
    # Ground without an extent is as wide as its largest body.
    least = max(float(np.linalg.norm(body.vertices, axis=1).max()) for body in scene.bodies)
    step = round_length(0.25 * max(float((high - low).max()), 2.0 * least))
    low, high = step * (np.floor(low / step) - 1.0), step * (np.ceil(high / step) + 1.0)
    (left, front), (right, back) = low, high
    corner = [(left, front), (right, front), (right, back), (left, front), (right, back), (left, back)]
    lines = [end for x in np.arange(left, right + 0.5 * step, step) for end in ((x, front), (x, back))]
    lines += [end for y in np.arange(front, back + 0.5 * step, step) for end in ((left, y), (right, y))]
    # The grid lies a little above the floor, which would else hide it here and there.
    return still("floor", corner, 0.0, FLOOR) | still("grid", lines, 1e-3 * step, RULE), step


def still(name: str, places: Sequence[tuple[float, ...]], height: float, colour: str) -> dict[str, np.ndarray]:
    """Corners that stand where they are, [count, 2] at a height or [count, 3] [m], in one colour."""
    corner = np.array(places, dtype=np.float32)
    if corner.shape[1] == 2:
        corner = np.column_stack([corner, np.full(len(corner), height, dtype=np.float32)])
    paint = np.rint(255.0 * np.array(to_rgb(colour))).astype(np.uint8)
    return {f"{name}_corner": corner, f"{name}_paint": np.tile(paint, (len(corner), 1))}


def _shades(parts: Array) -> np.ndarray:
    """Parts of the largest value, any shape, as places on a scale of equal factors from 0 to 255."""
    with np.errstate(divide="ignore"):
        return np.clip(np.rint(255.0 * (1.0 + np.log10(parts) / DECADES)), 0, 255).astype(np.uint8)


def _continuous(orientation: Array) -> Array:
    """Quaternions [frame, body, 4] of signs that do not jump from frame to frame: both signs are the same turn."""
    dots = (orientation[1:] * orientation[:-1]).sum(axis=2)
    signs = np.cumprod(np.where(dots < 0.0, -1.0, 1.0), axis=0)
    return orientation * np.concatenate([np.ones_like(signs[:1]), signs])[:, :, None]


def geometry(hulls: Sequence[tuple[Array, NDArray[np.int64]]]) -> dict[str, np.ndarray]:
    """Vertices of all hulls one after the other, their faces as places among all, and the hull of each vertex."""
    counts = np.array([len(vertices) for vertices, _ in hulls])
    first = np.concatenate([[0], np.cumsum(counts)[:-1]])
    faces = np.concatenate([own + start for (_, own), start in zip(hulls, first, strict=True)])
    return {
        "vertices": np.concatenate([vertices for vertices, _ in hulls]).astype(np.float32),
        "faces": faces.astype(np.int32),
        "vertexBody": np.repeat(np.arange(len(hulls)), counts).astype(np.float32),
    }


def painted(colours: Sequence[tuple[float, float, float]], face_counts: Sequence[int]) -> np.ndarray:
    """The colour of each face [face, 3]; a few per cent of tint keep neighbours of one colour apart."""
    tint = 1.0 + 0.09 * np.sin(2.399963 * np.arange(len(colours)))
    shades = np.clip(255.0 * np.array(colours) * tint[:, None], 0.0, 255.0)
    return np.repeat(np.rint(shades), face_counts, axis=0).astype(np.uint8)


def orbit(target: Array, radius: float, azimuth: float, elevation: float) -> dict[str, Any]:
    """Where a view begins: at what it looks [m], from which side [rad], and how far away [m]."""
    return {"target": target.tolist(), "distance": AWAY * radius, "azimuth": azimuth, "elevation": elevation}


def section(
    name: str,
    title: str,
    words: str,
    arrays: dict[str, np.ndarray],
    facts: dict[str, Any],
    legend: Mapping[str, str] = MappingProxyType({}),
) -> LiveSection:
    """A view with its data; legend: colours by what they stand for."""
    hint = "Drag to rotate; after a click on the picture the wheel zooms; two fingers do both."
    keys = "".join(f'<span style="--key: {colour}">{escape(one)}</span>' for one, colour in legend.items())
    html = f"""<section id="{name}" class="view3d">
<h3>{escape(title)}</h3>
<canvas tabindex="0" role="img" aria-label="{escape(title, quote=True)}"></canvas>
{f'<p class="keys">{keys}</p>' if keys else ""}<div class="tools"></div>
<p class="note">{in_html(words)} {hint}</p>
</section>
{script_data(f"{name}-data", {**facts, "arrays": deflated(arrays)})}"""
    return LiveSection(html, SCRIPTS)
