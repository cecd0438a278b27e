"""Figure 1: how the surface came to be, in pictures of its grains and in the history of its settling."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from lithobrake.report.hulls import Body, Camera, draw_box, frame_axes, paint
from lithobrake.report.look import GRAIN, LANDER, QUIET, SITE

Array = NDArray[np.float64]


def three_moments(position: Array) -> list[int]:
    """First frame, last frame, and between them the one in which the middle height is nearest to half-way down."""
    height = np.median(position[:, :, 2], axis=1)
    half_way = int(np.argmin(np.abs(height - 0.5 * (height[0] + height[-1]))))
    return sorted({0, half_way, len(position) - 1})


def bed_figure(
    bodies: Sequence[Body],
    time: Array,
    position: Array,
    orientation: Array,
    width: tuple[float, float],
    surface_height: float,
    history: dict[str, Array],
) -> Figure:
    """Draw the cloud, the fall and the settled bed, and beside them how the settling went.

    time [s], shape [frame]; position [m], shape [frame, body, 3]; orientation (w, x, y, z), shape [frame, body, 4];
    history: time [s], kinetic_ratio, unbalanced_force, gravity [m/s2], each of shape [record].
    """
    moments = three_moments(position)
    top = max(float(position[moments, :, 2].max()), surface_height)
    camera = Camera((0.0, 0.0, 0.5 * top), -58.0, 16.0, 7.0 * max(top, *width))
    x_range, y_range = _extent(position[moments], bodies, width, camera)
    picture_width = 4.1 * (x_range[1] - x_range[0]) / (y_range[1] - y_range[0])
    picture_width = float(np.clip(picture_width, 1.2, 1.9))
    figure = Figure(figsize=(9.2, 4.5))
    names = {0: "random cloud", len(position) - 1: "settled in the open box"}
    for column, moment in enumerate(moments):
        axes = figure.add_axes((0.005 + column * picture_width / 9.2, 0.01, picture_width / 9.2, 0.9))
        draw_box(axes, width, 1.25 * surface_height, camera, front=False)
        paint(axes, bodies, position[moment], orientation[moment], camera, surface_height)
        draw_box(axes, width, 1.25 * surface_height, camera, front=True)
        frame_axes(axes, x_range, y_range)
        axes.set_title(f"{names.get(moment, 'falling')}\n$t$ = {time[moment]:.3g} s", loc="center", fontsize=8.5)
    left = 3 * picture_width / 9.2 + 0.095
    upper = figure.add_axes((left, 0.46, 0.985 - left, 0.45))
    lower = figure.add_axes((left, 0.12, 0.985 - left, 0.24), sharex=upper)
    _history(upper, lower, history)
    return figure


def _extent(
    position: Array, bodies: Sequence[Body], width: tuple[float, float], camera: Camera
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Part of the picture plane [m] that holds all grains of the frames shown, and the box."""
    margin = max(float(np.linalg.norm(body.vertices, axis=1).max()) for body in bodies)
    corners = np.array([(x, y, 0.0) for x in (-width[0] / 2, width[0] / 2) for y in (-width[1] / 2, width[1] / 2)])
    flat, _ = camera.project(np.concatenate([position.reshape(-1, 3), corners]))
    low, high = flat.min(axis=0) - 1.1 * margin, flat.max(axis=0) + 1.1 * margin
    return (float(low[0]), float(high[0])), (float(low[1]), float(high[1]))


def _history(upper: Axes, lower: Axes, history: dict[str, Array]) -> None:
    """Draw the two measures of rest above, the acceleration that was applied below; all over the simulated time."""
    time = history["time"]
    for name, words, colour in (
        ("kinetic_ratio", "kinetic energy ratio", LANDER),
        ("unbalanced_force", "unbalanced force", SITE),
    ):
        known = np.isfinite(history[name]) & (history[name] > 0)
        upper.plot(time[known], history[name][known], color=colour, linewidth=1.3, label=words)
    upper.set_yscale("log")
    upper.set_title("Coming to rest", fontsize=9)
    upper.set_ylabel("ratio [-]")
    upper.grid(visible=True, axis="y")
    upper.tick_params(labelbottom=False)
    upper.legend(loc="upper right")
    lower.plot(time, history["gravity"], color=GRAIN, linewidth=1.6, drawstyle="default")
    if np.all(history["gravity"] > 0) and history["gravity"].max() > 20 * history["gravity"].min():
        lower.set_yscale("log")
    lower.set_ylabel("gravity [m/s$^2$]")
    lower.set_xlabel("simulated time [s]")
    lower.grid(visible=True, axis="y", color=QUIET, alpha=0.2)
