"""The part of the ground on which a lander at rest may meet a limit state, as its edge on a map."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from lithobrake.report.figures.ground_map import GroundMap, MapPanel
from lithobrake.report.figures.style import INPUT_COLOURS, SITE
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.journey_names import PLACE
from lithobrake.vocabulary.limit_state import Comparison, Condition, Junction, LimitState, Negation

# Places along each axis at which a condition is looked at.
POINTS = 401
# Of what a place does not decide [m].
ANYWHERE = -1e12
# Of half the width of a map: a larger circle would leave the landers a dot, and is drawn as far as it lies on the map.
LARGE_CIRCLE = 2.0
AREA_COLOURS = (SITE, *INPUT_COLOURS[4:])


def circles(states: Iterable[LimitState], ground: GroundMap, panel: MapPanel) -> list[Array]:
    """Latitudes and longitudes [deg], [2, count], of the circles about the middle of a map that it is to hold."""
    turn, found = np.linspace(0.0, 2.0 * np.pi, 73), []
    for state in states:
        if state.radius is not None and state.radius < LARGE_CIRCLE * panel.half:
            chord = 2.0 * ground.radius * np.sin(0.5 * state.radius / ground.radius)
            found.append(np.array(ground.back(chord * np.cos(turn), chord * np.sin(turn))))
    return found


def draw_areas(
    axes: Axes, areas: Mapping[str, LimitState], aim: tuple[float, float], ground: GroundMap, panel: MapPanel | None
) -> None:
    """Draw the edge of the area of each limit state, as far as it lies in a panel, or on the half of the body.

    aim: latitude and longitude of the aim point [deg].
    """
    shown = panel or MapPanel(0.0, 0.0, ground.edge)
    edges = np.linspace(-shown.half, shown.half, POINTS)
    east, north = np.meshgrid(shown.east + edges, shown.north + edges)
    latitude, longitude = ground.back(east, north)
    facing = GroundMap(*aim, ground.radius).facing(latitude, longitude)
    places = {
        "distance": ground.radius * np.arccos(np.clip(facing, -1.0, 1.0)),
        "latitude_deg": latitude,
        "longitude_deg": (longitude + 180.0) % 360.0 - 180.0,
    }
    degree = np.radians(1.0) * ground.radius
    scale = {"distance": 1.0, "latitude_deg": degree, "longitude_deg": degree}
    is_far = np.hypot(east, north) > ground.edge
    for state, style in zip(areas.values(), area_styles(areas), strict=True):
        margin = np.where(is_far, np.nan, _margin(state.condition, places, scale, is_so=True))
        if np.nanmin(margin) < 0.0 < np.nanmax(margin):
            drawn = {"colors": [style["color"]], "linewidths": style["linewidth"], "linestyles": [style["linestyle"]]}
            axes.contour(east, north, margin, levels=[0.0], zorder=4.5, **drawn)


def area_styles(areas: Mapping[str, LimitState]) -> list[dict[str, Any]]:
    """The line of the edge of each, one colour each as far as there are colours."""
    dashes = (0, (5.0, 1.5, 1.0, 1.5))
    return [
        {"color": AREA_COLOURS[place % len(AREA_COLOURS)], "linewidth": 1.4, "linestyle": dashes}
        for place in range(len(areas))
    ]


def _margin(condition: Condition, places: Mapping[str, Array], scale: Mapping[str, float], *, is_so: bool) -> Array:
    """How far places are from where a condition may be met, or not met [m]; at most 0 where it may.

    places: numbers of each place by name; scale: metres of one unit of these.
    """
    match condition:
        case Negation(other):
            return _margin(other, places, scale, is_so=not is_so)
        case Junction(parts, needs_all):
            join = np.maximum if needs_all == is_so else np.minimum
            return np.asarray(join.reduce([_margin(part, places, scale, is_so=is_so) for part in parts]))
        case Comparison(sides, signs) if {side for side in sides if isinstance(side, str)} <= PLACE:
            size = max(scale[side] for side in sides if isinstance(side, str))
            numbers = [places[side] if isinstance(side, str) else side for side in sides]
            pairs = zip(signs, numbers, numbers[1:], strict=False)
            gaps = [size * np.asarray(a - b if sign in ("<", "<=") else b - a) for sign, a, b in pairs]
            farthest: Array = np.maximum.reduce(np.broadcast_arrays(*gaps))
            return farthest if is_so else -farthest
    return np.full_like(places["distance"], ANYWHERE)
