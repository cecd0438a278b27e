"""How the surface came to be, in pictures of its grains and in the history of its settling."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from lithobrake.report.figures.hulls import Camera, Scene, draw_box, frame_axes, paint
from lithobrake.report.figures.style import GRAIN, LANDER, QUIET, SITE

Array = NDArray[np.float64]


def three_moments(position: Array) -> tuple[int, int, int]:
    """First frame, the one in which the middle height is nearest to half-way down, and last frame."""
    height = np.median(position[:, :, 2], axis=1)
    half_way = int(np.argmin(np.abs(height - 0.5 * (height[0] + height[-1]))))
    return 0, half_way, len(position) - 1


def bed_figure(shown: Scene, surface_height: float) -> Figure:
    """Draw the cloud, the fall and the settled bed, and beside them how the settling went.

    Of ground that repeats one tile is drawn. surface_height [m].
    """
    moving, span = shown.moving, float(np.ptp(shown.ground, axis=0).max())
    position, orientation = moving.position, moving.orientation
    first, falling, last = three_moments(position)
    top = max(float(position[first, :, 2].max()), surface_height)
    figure = Figure(figsize=(9.2, 4.6))
    # The cloud may be ten times as high as the bed: it and its fall share one scale, the bed has a larger one.
    far = Camera((0.0, 0.0, 0.5 * top), -58.0, 14.0, 7.0 * max(top, span))
    near = Camera((0.0, 0.0, 0.5 * surface_height), -58.0, 24.0, 5.0 * span)
    column = float(np.clip(4.1 * _aspect(_extent(position[[first, falling]], shown, far)), 1.1, 1.6)) / 9.2
    bed_width = 0.62 - 2 * column
    pictures = (
        (first, "random cloud", far, (0.005, 0.01, column, 0.89), (first, falling)),
        (falling, "falling", far, (0.005 + column, 0.01, column, 0.89), (first, falling)),
        (last, "settled bed", near, (0.02 + 2 * column, 0.01, bed_width, 0.89), (last,)),
    )
    for frame, name, camera, place, scale in pictures:
        axes = figure.add_axes(place)
        draw_box(axes, shown.box, 1.25 * surface_height, camera, front=False)
        paint(axes, shown.bodies, position[frame], orientation[frame], camera, surface_height)
        draw_box(axes, shown.box, 1.25 * surface_height, camera, front=True)
        frame_axes(axes, *_extent(position[list(scale)], shown, camera))
        axes.set_anchor("S")
        middle = place[0] + 0.5 * place[2]
        figure.text(
            middle,
            0.985,
            f"{name}\n$t$ = {moving.time[frame]:.3g} s",
            ha="center",
            va="top",
            fontsize=8.5,
            weight="bold",
        )
    upper = figure.add_axes((0.725, 0.47, 0.255, 0.45))
    lower = figure.add_axes((0.725, 0.12, 0.255, 0.26), sharex=upper)
    _history(upper, lower, moving.history)
    return figure


def _aspect(extent: tuple[tuple[float, float], tuple[float, float]]) -> float:
    """Width over height of a part of the picture plane."""
    (left, right), (low, high) = extent
    return (right - left) / (high - low)


def _extent(position: Array, shown: Scene, camera: Camera) -> tuple[tuple[float, float], tuple[float, float]]:
    """Part of the picture plane [m] that holds all grains of the frames shown, and the ground."""
    margin = max(float(np.linalg.norm(body.vertices, axis=1).max()) for body in shown.bodies)
    corners = np.array([(x, y, 0.0) for x in shown.ground[:, 0] for y in shown.ground[:, 1]])
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
        upper.plot(time[known], history[name][known], color=colour, linewidth=1.0, label=words)
    upper.set_yscale("log")
    upper.set_ylabel("ratio [-]")
    upper.grid(visible=True, axis="y")
    upper.tick_params(labelbottom=False)
    upper.legend(loc="lower left", bbox_to_anchor=(-0.16, 1.0), ncols=2, columnspacing=1.2, handlelength=1.4)
    lower.plot(time, history["gravity"], color=GRAIN, linewidth=1.6, drawstyle="default")
    if np.all(history["gravity"] > 0) and history["gravity"].max() > 20 * history["gravity"].min():
        lower.set_yscale("log")
    positive = time[time > 0]
    if len(positive) and positive[-1] > 50 * positive[0]:
        # The fall lasts a second and the rest minutes: on a logarithmic axis both can be read.
        lower.set_xscale("log")
    lower.set_ylabel("gravity [m/s$^2$]")
    lower.set_xlabel("simulated time [s]")
    lower.grid(visible=True, axis="y", color=QUIET, alpha=0.2)
