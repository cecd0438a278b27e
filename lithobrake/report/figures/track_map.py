"""The way of one lander over the ground: its impacts in their order, and where it ended."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import Normal, Stroke

from lithobrake.report.figures.close_view import draw_bar, frame_view, view_around, whole_body
from lithobrake.report.figures.density import WHOLE, Window, near
from lithobrake.report.figures.map_figure import draw_relief
from lithobrake.report.figures.map_marks import SITE_STYLE, mark_site
from lithobrake.report.figures.style import LANDER
from lithobrake.results import JourneyTrack
from lithobrake.vocabulary.fate_colours import END_COLOURS

SIZE = (9.2, 5.2)
RIM = [Stroke(linewidth=2.6, foreground="white"), Normal()]


def track_map(track: JourneyTrack, shown: int | None = None) -> Figure:
    """Draw the impacts of a lander, joined by straight lines, and its end.

    shown: up to the impact of this number, without the end; absent: all of it.
    """
    places = np.array([one.place for one in track.touchdowns])
    end = np.array([track.end_place]) if track.end_place is not None else np.empty((0, 2))
    latitude, longitude = np.concatenate([places, end]).T
    window = view_around(latitude, longitude, track.aim)
    figure = Figure(figsize=SIZE)
    if window is None:
        axes = figure.add_axes((0.07, 0.14, 0.9, 0.84))
        draw_relief(axes, track.vertices)
    else:
        axes = figure.add_axes((0.085, 0.1, 0.49, 0.867))
        whole_body(figure.add_axes((0.64, 0.6, 0.34, 0.33)), window, track.vertices)
    if shown is not None:
        places, end = places[: shown + 1], end[:0]
    _draw_track(axes, track, places, end, window or WHOLE)
    frame_view(axes, window or WHOLE)
    if window is not None:
        draw_bar(axes, window, track.radius)
    handles, _ = axes.get_legend_handles_labels()
    corner = (0.64, 0.1) if window else (0.07, 0.01)
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=corner, ncols=1 if window else 4, borderpad=0.0)
    return figure


def _draw_track(axes: Axes, track: JourneyTrack, places: Any, end: Any, window: Window) -> None:
    """Impacts with their numbers, lines between them, the end, and the aim point."""
    way = np.concatenate([places, end])
    x, y = near(way[:, 1], window.longitude), way[:, 0]
    jumps = np.flatnonzero(np.abs(np.diff(x)) > 180.0) + 1
    axes.plot(np.insert(x, jumps, np.nan), np.insert(y, jumps, np.nan), color=LANDER, linewidth=1.4, zorder=5)
    count = len(places)
    dots: dict[str, Any] = {"linestyle": "none", "marker": "o", "markeredgecolor": "white", "zorder": 6}
    axes.plot(x[:count], y[:count], color=LANDER, markersize=6, label="touchdown, and its number", **dots)
    for number in range(count):
        text = axes.annotate(str(number), (x[number], y[number]), (5, 5), textcoords="offset points", fontsize=9)
        text.set(path_effects=RIM, zorder=8)
    if len(end):
        axes.plot(x[-1], y[-1], color=END_COLOURS[track.end], markersize=8, label=track.end.label, **dots)
    mark_site(axes, float(near(np.array([track.aim[1]]), window.longitude)[0]), track.aim[0])
    axes.plot([], [], linestyle="none", label="aim point", **{**SITE_STYLE, "markersize": 12})
