"""One landing, at several instants from the same place."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from lithobrake.report.figures.hulls import Camera, Scene, draw_box, frame_axes, paint
from lithobrake.report.figures.style import INK, SITE

Array = NDArray[np.float64]


def instants(lander_height: Array, count: int = 6) -> list[int]:
    """Frames to show: half of them up to the deepest point, the rest after it, evenly spaced."""
    last = len(lander_height) - 1
    deepest = int(np.argmin(lander_height))
    if last < count:
        return list(range(last + 1))
    before = np.linspace(0, deepest, count // 2)
    after = np.linspace(deepest, last, count - count // 2 + 1)[1:]
    chosen = sorted(set(np.rint(np.concatenate([before, after])).astype(int).tolist()))
    # A landing that never goes down, or ends at its deepest, is shown evenly instead.
    return chosen if len(chosen) == count else sorted(set(np.rint(np.linspace(0, last, count)).astype(int).tolist()))


def landing_figure(shown: Scene, picture_count: int = 6) -> Figure:
    """Draw a landing; the lander is the last body and its path so far is a line."""
    time, position, orientation = shown.moving.time, shown.moving.position, shown.moving.orientation
    path = position[:, -1]
    chosen = instants(path[:, 2], picture_count)
    surface_height = float(np.quantile(position[0, :-1, 2], 0.98))
    camera = _camera(path, surface_height, shown.ground)
    x_range, y_range = _extent(path[chosen], shown, surface_height, camera)
    column_count = 4 if len(chosen) > 6 else 3 if len(chosen) > 4 else 2
    row_count = -(-len(chosen) // column_count)
    picture_width = 9.2 / column_count
    picture_height = picture_width * (y_range[1] - y_range[0]) / (x_range[1] - x_range[0])
    picture_height = min(picture_height, 4.2)
    figure = Figure(figsize=(9.2, row_count * (picture_height + 0.3)))
    for place, frame in enumerate(chosen):
        row, column = divmod(place, column_count)
        share = picture_height / (picture_height + 0.3) / row_count
        axes = figure.add_axes((column / column_count, 1 - (row + 1) / row_count, 0.995 / column_count, share))
        draw_box(axes, shown.box, 1.1 * surface_height, camera, front=False)
        paint(axes, shown.bodies, position[frame], orientation[frame], camera, surface_height)
        draw_box(axes, shown.box, 1.1 * surface_height, camera, front=True)
        _trail(axes, path[: frame + 1], camera)
        frame_axes(axes, x_range, y_range)
        note = "  (deepest)" if frame == int(np.argmin(path[:, 2])) else ""
        axes.set_title(f"$t$ = {time[frame]:.3g} s{note}", loc="center", fontsize=9, color=INK)
    return figure


def _camera(path: Array, surface_height: float, ground: Array) -> Camera:
    """A camera that sees the lander go from left to right, a little from the side and from above."""
    (x, y), span = ground.mean(axis=0), float(np.ptp(ground, axis=0).max())
    travel = path[min(len(path) - 1, max(1, int(np.argmin(path[:, 2]))))] - path[0]
    heading = np.degrees(np.arctan2(travel[1], travel[0])) if np.hypot(travel[0], travel[1]) > 1e-6 * span else 0.0
    return Camera((float(x), float(y), 0.8 * surface_height), float(heading) - 90.0 + 18.0, 17.0, 6.0 * span)


def _extent(
    path: Array, shown: Scene, surface_height: float, camera: Camera
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Part of the picture plane [m] that holds the ground and the lander in all frames shown."""
    # A little more than its radius, since perspective enlarges what comes towards the viewer.
    reach = 1.15 * float(np.linalg.norm(shown.bodies[-1].vertices, axis=1).max())
    ground, around = shown.ground, 0.02 * float(np.ptp(shown.ground, axis=0).max())
    corners = np.array([(x, y, z) for x in ground[:, 0] for y in ground[:, 1] for z in (0.0, 1.25 * surface_height)])
    flat_box, _ = camera.project(corners)
    flat_path, _ = camera.project(path)
    low = np.minimum(flat_box.min(axis=0) - around, flat_path.min(axis=0) - reach)
    high = np.maximum(flat_box.max(axis=0) + around, flat_path.max(axis=0) + reach)
    return (float(low[0]), float(high[0])), (float(low[1]), float(high[1]))


def _trail(axes: Axes, path: Array, camera: Camera) -> None:
    """Draw the way of the lander's centre up to now, over a white rim that keeps it readable on grains."""
    flat, _ = camera.project(path)
    axes.plot(flat[:, 0], flat[:, 1], color="white", linewidth=2.6, alpha=0.8, zorder=4)
    axes.plot(flat[:, 0], flat[:, 1], color=SITE, linewidth=1.2, zorder=5)
    axes.plot(
        flat[-1, 0],
        flat[-1, 1],
        "o",
        color=SITE,
        markersize=3.2,
        markeredgecolor="white",
        markeredgewidth=0.6,
        zorder=6,
    )
