"""Pictures of a bed, of one landing at several instants, and of a journey on one sheet."""

import io
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lithobrake.report.figures.hulls import Camera, Scene, draw_box, frame_axes, paint, scene
from lithobrake.report.figures.map_frames import SIZE, track_map
from lithobrake.report.figures.style import GRAIN, INK, LANDER, QUIET, SITE, figure_style
from lithobrake.results import JourneyMotion
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.plain_text import wrapped

# Of each touchdown.
PICTURES = 4
# Characters on a line of a caption, and its height [inch].
LINE, LINE_HEIGHT = 118, 0.2


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
    column = float(np.clip(4.1 * _aspect(_bed_extent(position[[first, falling]], shown, far)), 1.1, 1.6)) / 9.2
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
        frame_axes(axes, *_bed_extent(position[list(scale)], shown, camera))
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


def _bed_extent(position: Array, shown: Scene, camera: Camera) -> tuple[tuple[float, float], tuple[float, float]]:
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


def journey_sheet(motion: JourneyMotion) -> bytes:
    """The sheet as a PNG."""
    from PIL import Image

    track = motion.track
    with figure_style():
        figures = [caption(f"Journey {track.number}. {track.end_words}"), track_map(track)]
        for facts, bodies in zip(track.touchdowns, motion.bodies, strict=False):
            figures += [caption(facts.words), landing_figure(scene(bodies, has_lander=True), PICTURES)]
        strips = [picture(figure) for figure in figures]
    width = max(strip.shape[1] for strip in strips)
    padding = [((0, 0), (0, width - strip.shape[1]), (0, 0)) for strip in strips]
    whole = [np.pad(strip, pad, constant_values=255) for strip, pad in zip(strips, padding, strict=True)]
    memory = io.BytesIO()
    Image.fromarray(np.concatenate(whole)).save(memory, "PNG")
    return memory.getvalue()


def picture(figure: Figure, dpi: float | None = None) -> np.ndarray:
    """A figure as pixels, shape [height, width, 3]."""
    from PIL import Image

    memory = io.BytesIO()
    figure.savefig(memory, format="png", dpi=dpi or matplotlib.rcParams["savefig.dpi"])
    return np.asarray(Image.open(memory).convert("RGB"))


def caption(words: str, size: tuple[float, float] | None = None) -> Figure:
    """Words on a strip of a size [inch], or as wide as the figures and as high as they need."""
    text = wrapped(words[:1].upper() + words[1:], LINE)
    figure = Figure(figsize=size or (SIZE[0], LINE_HEIGHT * (text.count("\n") + 2)))
    style: dict[str, Any] = {"fontsize": 10, "color": INK, "va": "center"}
    figure.text(0.01, 0.45, text, **style)
    return figure
