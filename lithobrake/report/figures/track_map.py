"""The way of one lander over the ground: its impacts in their order, and where it ended."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import Normal, Stroke

from lithobrake.report.figures.ground_map import GroundMap, panel_around
from lithobrake.report.figures.map_frames import draw_bar, frame_half, frame_local
from lithobrake.report.figures.map_marks import SITE_STYLE, mark_site
from lithobrake.report.figures.style import LANDER
from lithobrake.results import JourneyTrack
from lithobrake.vocabulary.fate_colours import END_COLOURS

SIZE = (9.2, 5.2)
RIM = [Stroke(linewidth=2.6, foreground="white"), Normal()]


def track_map(track: JourneyTrack, shown: int | None = None) -> Figure:
    """Draw the impacts of a lander, joined by lines, and its end: in metres about the aim point, and on the body.

    shown: up to the impact of this number, without the end; absent: all of it.
    """
    places = np.array([one.place for one in track.touchdowns])
    end = np.array([track.end_place]) if track.end_place is not None else np.empty((0, 2))
    latitude, longitude = np.concatenate([places, end]).T
    ground = GroundMap(*track.aim, track.radius)
    panel = panel_around(ground, [(latitude, longitude)])
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


def _draw_track(axes: Axes, track: JourneyTrack, ground: GroundMap, places: Any, end: Any, *, is_close: bool) -> None:
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
            text.set(path_effects=RIM, zorder=8)
    if len(end):
        axes.plot(x[-1], y[-1], color=END_COLOURS[track.end], markersize=size + 2, label=track.end.label, **dots)
    if ground.facing(*(np.array([one]) for one in track.aim))[0] > 0.0 and is_close:
        mark_site(axes, *(float(one[0]) for one in ground.places(*(np.array([one]) for one in track.aim))))
    axes.plot([], [], linestyle="none", label="aim point", **{**SITE_STYLE, "markersize": 12})
