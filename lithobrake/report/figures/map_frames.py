"""The frames of maps: a local panel in metres and both halves of a body, and the track of one lander."""

from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from matplotlib.patheffects import Normal, Stroke

from lithobrake.report.figures import ground_map
from lithobrake.report.figures.style import INK, LANDER, QUIET, RULE, WASH
from lithobrake.results import JourneyTrack
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.outcomes import END_COLOURS

# The bar of lengths is at most this part of the width.
LONGEST_BAR = 0.3
RIM = [Stroke(linewidth=2.2, foreground="white"), Normal()]
WORDS: dict[str, Any] = {"fontsize": 7, "color": QUIET, "path_effects": RIM, "zorder": 3}
LINE: dict[str, Any] = {"color": RULE, "linewidth": 0.6, "zorder": 1}
SIZE = (9.2, 5.2)
TRACK_RIM = [Stroke(linewidth=2.6, foreground="white"), Normal()]


def frame_local(axes: Axes, ground: ground_map.GroundMap, panel: ground_map.MapPanel) -> None:
    """A panel in metres from the middle of its map, with the lines of latitude and longitude that cross it."""
    axes.set_xlim(panel.east - panel.half, panel.east + panel.half)
    axes.set_ylim(panel.north - panel.half, panel.north + panel.half)
    axes.set_aspect("equal")
    axes.set_xlabel("east of the aim point [m]")
    axes.set_ylabel("north of the aim point [m]")
    axes.locator_params(nbins=6)
    for spine in axes.spines.values():
        spine.set_visible(True)
    side = np.linspace(-panel.half, panel.half, 41)
    latitude, longitude = ground.back(*(part.ravel() for part in np.meshgrid(panel.east + side, panel.north + side)))
    for name, line_latitude, line_longitude in graticule(latitude, longitude, ground):
        x, y = ground.line(line_latitude, line_longitude)
        axes.plot(x, y, **LINE)
        end = _leaves(x, y, panel)
        if end is not None:
            place: dict[str, Any] = {"ha": "left", "va": "bottom"} if end[2] else {"ha": "center", "va": "bottom"}
            axes.annotate(name, end[:2], (2, 2), textcoords="offset points", annotation_clip=True, **place, **WORDS)
    _poles(axes, ground, panel)
    draw_bar(axes, 2.0 * panel.half)


def graticule(latitude: Array, longitude: Array, ground: ground_map.GroundMap) -> Iterator[tuple[str, Array, Array]]:
    """The lines over a part of the body with these latitudes and longitudes [deg]: name, latitude, longitude."""
    turned = (longitude - ground.longitude + 180.0) % 360.0 - 180.0
    step = ground_map.step_of(float(np.ptp(latitude)))
    around = np.linspace(-180.0, 180.0, ground_map.LINE_POINTS)
    for value in _multiples(float(latitude.min()), float(latitude.max()), step):
        yield degrees(value, "N", "S"), np.full(ground_map.LINE_POINTS, value), ground.longitude + around
    # About a pole all meridians meet, and few of them are enough.
    low, high = ground.longitude + float(turned.min()), ground.longitude + float(turned.max())
    across = ground_map.step_of(high - low)
    along = np.linspace(-90.0, 90.0, ground_map.LINE_POINTS)
    for value in _multiples(low, high, across):
        yield degrees((value + 180.0) % 360.0 - 180.0, "E", "W"), along, np.full(ground_map.LINE_POINTS, value)


def degrees(value: float, positive: str, negative: str) -> str:
    """An angle as maps have it: "12.5° N"; 0 and 180 degrees are on neither side."""
    rounded = round(value, 6)
    side = "" if rounded % 180.0 == 0.0 else f" {positive}" if rounded > 0.0 else f" {negative}"
    return f"{abs(rounded):g}°{side}"


def _multiples(low: float, high: float, step: float) -> Array:
    """The multiples of a step between two ends."""
    return step * np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1.0)


def _leaves(x: Array, y: Array, panel: ground_map.MapPanel) -> tuple[float, float, bool] | None:
    """Where a line meets the left edge of a panel, or else its lower one: place, and whether it is the left one."""
    for is_left, along, across, edge, middle in (
        (True, x, y, panel.east - panel.half, panel.north),
        (False, y, x, panel.north - panel.half, panel.east),
    ):
        for at in np.flatnonzero((along[:-1] - edge) * (along[1:] - edge) <= 0.0):
            if along[at] == along[at + 1]:
                continue
            part = (edge - along[at]) / (along[at + 1] - along[at])
            place = float(across[at] + part * (across[at + 1] - across[at]))
            # The lower left corner has the bar of lengths.
            if (-0.75 if is_left else -0.35) * panel.half < place - middle < 0.9 * panel.half:
                return (edge, place, True) if is_left else (place, edge, False)
    return None


def _poles(axes: Axes, ground: ground_map.GroundMap, panel: ground_map.MapPanel | None) -> None:
    """Both poles as points, as far as they lie on this side of the body, and within a panel."""
    for latitude, name in ((90.0, "N"), (-90.0, "S")):
        at = np.array([latitude]), np.array([0.0])
        east, north = ground.places(*at)
        if ground.facing(*at)[0] < -1e-9 or (panel is not None and not panel.holds(east, north)[0]):
            continue
        axes.plot(east, north, marker="+", color=INK, markersize=7, markeredgewidth=1.2, zorder=6, clip_on=False)
        axes.annotate(
            name, (float(east[0]), float(north[0])), (4, 2), textcoords="offset points", fontsize=8, weight="bold",
            path_effects=RIM, zorder=6,
        )  # fmt: skip


def frame_half(axes: Axes, ground: ground_map.GroundMap, title: str) -> Circle:
    """The half of the body around the middle of a map, as a disc; returns it, to clip by."""
    edge = ground.edge
    disc = Circle((0.0, 0.0), edge, facecolor=WASH, edgecolor=QUIET, linewidth=0.8, zorder=0)
    axes.add_patch(disc)
    axes.set_xlim(-1.06 * edge, 1.06 * edge)
    axes.set_ylim(-1.06 * edge, 1.06 * edge)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(title, loc="center", fontsize=8.5, fontweight="normal")
    around, along = np.linspace(-180.0, 180.0, ground_map.LINE_POINTS), np.linspace(-90.0, 90.0, ground_map.LINE_POINTS)
    for latitude in range(-60, 61, 30):
        name = degrees(latitude, "N", "S")
        _named_line(axes, ground, np.full(ground_map.LINE_POINTS, float(latitude)), ground.longitude + around, name)
    for longitude in range(-180, 180, 30):
        _named_line(axes, ground, along, np.full(ground_map.LINE_POINTS, float(longitude)), "")
    _poles(axes, ground, None)
    return disc


def _named_line(axes: Axes, ground: ground_map.GroundMap, latitude: Array, longitude: Array, name: str) -> None:
    x, y = ground.line(latitude, longitude)
    axes.plot(x, y, **LINE)
    if name and np.isfinite(x).any():
        left = int(np.nanargmin(x))
        axes.annotate(name, (float(x[left]), float(y[left])), (2, 2), textcoords="offset points", **WORDS)


def draw_bar(axes: Axes, width: float) -> None:
    """A bar of a round length in the lower left corner of axes that are so wide [m]."""
    length = ground_map.round_length(LONGEST_BAR * width)
    part = length / width
    style: dict[str, Any] = {"transform": axes.transAxes, "zorder": 7}
    axes.add_patch(Rectangle((0.025, 0.022), part + 0.03, 0.085, color="white", alpha=0.85, linewidth=0.0, **style))
    axes.plot([0.04, 0.04 + part], [0.04, 0.04], color=INK, linewidth=2.5, solid_capstyle="butt", **style)
    axes.text(0.04 + 0.5 * part, 0.052, f"{length:g} m", ha="center", va="bottom", fontsize=8, **style)


def track_map(track: JourneyTrack, shown: int | None = None) -> Figure:
    """Draw the impacts of a lander, joined by lines, and its end: in metres about the aim point, and on the body.

    Those on the partner of the body are left out.

    shown: up to the impact of this number, without the end; absent: all of it.
    """
    places, end = np.array(track.places_on_body), np.empty((0, 2))
    if track.end_place is not None and track.end_place[0] != track.partner:
        end = np.array([track.end_place[1:]])
    known = np.concatenate([places, end])
    latitude, longitude = known[np.isfinite(known).all(axis=1)].T
    ground = ground_map.GroundMap(*track.aim, track.radius)
    panel = ground_map.panel_around(ground, [(latitude, longitude)])
    if shown is not None:
        places, end = places[: shown + 1], end[:0]
    figure = Figure(figsize=SIZE)
    halves = (ground, ground.opposite)
    if panel is None:
        spots = [(0.01, 0.14, 0.49, 0.8), (0.5, 0.14, 0.49, 0.8)]
    else:
        spots = [(0.64, 0.5, 0.175, 0.36), (0.82, 0.5, 0.175, 0.36)]
        axes = figure.add_axes((0.085, 0.1, 0.49, 0.867))
        _draw_track(axes, track, ground, places, end, is_close=True)
        frame_local(axes, ground, panel)
    for side, (half, title, spot) in enumerate(
        zip(halves, ("the half around the aim point", "the other half"), spots, strict=True)
    ):
        own = figure.add_axes(spot)
        frame_half(own, half, title)
        _draw_track(own, track, half, places, end, is_close=panel is None)
        if side == 0:
            draw_bar(own, 2.12 * half.edge)
    handles, _ = figure.axes[0].get_legend_handles_labels()
    corner = (0.64, 0.1) if panel else (0.07, 0.01)
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=corner, ncols=1 if panel else 4, borderpad=0.0)
    return figure


def _draw_track(
    axes: Axes, track: JourneyTrack, ground: ground_map.GroundMap, places: Any, end: Any, *, is_close: bool
) -> None:
    """Impacts, lines between them, the end, and the aim point, as far as they are on this half; close: with numbers."""
    x, y = ground.line(*np.concatenate([places, end]).T)
    axes.plot(x, y, color=LANDER, linewidth=1.4 if is_close else 0.9, zorder=5)
    count = len(places)
    dots: dict[str, Any] = {"linestyle": "none", "marker": "o", "markeredgecolor": "white", "zorder": 6}
    size = 6 if is_close else 4
    axes.plot(x[:count], y[:count], color=LANDER, markersize=size, label="touchdown, and its number", **dots)
    for number in range(count if is_close else 0):
        if np.isfinite(x[number]):
            text = axes.annotate(str(number), (x[number], y[number]), (5, 5), textcoords="offset points", fontsize=9)
            text.set(path_effects=TRACK_RIM, zorder=8)
    if len(end):
        axes.plot(x[-1], y[-1], color=END_COLOURS[track.end], markersize=size + 2, label=track.end_label, **dots)
    if ground.facing(*(np.array([one]) for one in track.aim))[0] > 0.0 and is_close:
        ground_map.mark_site(axes, *(float(one[0]) for one in ground.places(*(np.array([one]) for one in track.aim))))
    axes.plot([], [], linestyle="none", label="aim point", **{**ground_map.SITE_STYLE, "markersize": 12})
