"""Figure 7: where the lander comes down after the first bounce, and in how many cases it does."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from numpy.typing import NDArray
from scipy.interpolate import LinearNDInterpolator

from lithobrake.report.figures.density import WHOLE, Window, close_window, draw_density, near
from lithobrake.report.figures.ellipse_line import draw_ellipses, fitting, follows_gaussian
from lithobrake.report.figures.site_mark import draw_legend, mark_site
from lithobrake.report.figures.style import INK, QUIET, TRAINING
from lithobrake.vocabulary.percentages import percent, with_interval

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Share:
    """A share of the samples with its interval, if it has one, all in [0, 1]; upper alone: no run had it.

    level: probability that the interval stands for; colour: of its bar; digits: of its figure in per cent where it has
    no interval.
    """

    name: str
    value: float
    lower: float | None = None
    upper: float | None = None
    level: float = 0.9
    colour: str = TRAINING
    digits: int = 0

    @property
    def words(self) -> str:
        """The share in per cent, with its interval or its limit."""
        if self.lower is None and self.upper is not None:
            return f"at most {percent(self.upper, 1)}"
        return with_interval({"share": self.value, "lower": self.lower, "upper": self.upper}, self.digits)


def map_figure(
    latitude: Array,
    longitude: Array,
    site: tuple[float, float],
    shares: list[Share],
    vertices: Array | None = None,
    ellipses: Mapping[str, Any] | None = None,
    whole: str = "all samples",
) -> Figure:
    """Draw the density of impacts on a map, and the shares of what became of the samples.

    latitude, longitude: of the impacts [deg], shape [impact]; site: latitude and longitude [deg];
    vertices: of the body [m], shape [vertex, 3], for the relief under the map; absent: a plain map; ellipses: of the
    summary, or None; whole: what the shares are shares of.
    """
    # In inches from below: the axis of the bars, a row for each bar, the axis of the map, the map, the legend.
    rows, map_height = 0.2 * len(shares), 3.86
    height = 0.5 + rows + 0.65 + map_height + 0.38
    figure = Figure(figsize=(9.2, height))
    bottom = (1.15 + rows) / height
    axes = figure.add_axes((0.06, bottom, 0.84, map_height / height))
    if vertices is not None:
        draw_relief(axes, vertices)
    mark_site(axes, float(near(np.array([site[1]]), 0.0)[0]), site[0])
    axes.set_xlim(-180, 180)
    axes.set_ylim(-90, 90)
    axes.set_aspect("equal")
    axes.set_xticks(range(-180, 181, 45))
    axes.set_yticks(range(-90, 91, 30))
    axes.set_xlabel("longitude, east [deg]")
    axes.set_ylabel("latitude [deg]")
    bar_place = (0.915, bottom + 0.03 * map_height / height, 0.014, 0.94 * map_height / height)
    window = close_window(latitude, longitude, site)
    drawn = _impacts(axes, latitude, longitude, site, window, ellipses)
    if drawn is not None:
        draw_scale(figure, *drawn, bar_place)
    held, is_gaussian = fitting(ellipses, window or WHOLE), follows_gaussian(ellipses, len(latitude))
    draw_legend(figure, held, "impacts", (0.06, 1.0 - 0.28 / height), is_gaussian=is_gaussian)
    draw_shares(figure.add_axes((0.2, 0.5 / height, 0.52, rows / height)), shares, whole)
    return figure


def inset_left(site: tuple[float, float]) -> bool:
    """Whether a close view stands in the left half of the map: the site is in the right one."""
    return bool(near(np.array([site[1]]), 0.0)[0] > 0)


def _impacts(
    axes: Axes,
    latitude: Array,
    longitude: Array,
    site: tuple[float, float],
    window: Window | None,
    ellipses: Mapping[str, Any] | None,
) -> tuple[Any, str] | None:
    """Draw the impacts, in a close view beside the site where on the whole map they would lie under its mark.

    Returns what a colour bar needs, None where there is no impact.
    """
    if not len(latitude):
        axes.text(0, -50, "no impact among the flights", ha="center", fontsize=11, color=QUIET)
        return None
    if window is None:
        draw_ellipses(axes, ellipses, WHOLE)
        return draw_density(axes, latitude, longitude, WHOLE, 11.0)
    # In one colour: the colour bar is that of the close view.
    axes.scatter(near(longitude, 0.0), latitude, s=5.0, color=QUIET, linewidths=0, zorder=2, rasterized=True)
    view, drawn = _close_view(axes, latitude, longitude, site, window)
    draw_ellipses(view, ellipses, window)
    return drawn


def draw_scale(figure: Figure, drawn: Any, words: str, place: tuple[float, float, float, float]) -> None:
    """Draw the colour bar of a density at a place in parts of the figure: left, bottom, width, height."""
    bar = figure.colorbar(drawn, cax=figure.add_axes(place), format="%g")
    bar.set_label(words)
    outline: Any = bar.outline
    outline.set_visible(False)


def _close_view(
    axes: Axes, latitude: Array, longitude: Array, site: tuple[float, float], window: Window
) -> tuple[Axes, tuple[Any, str]]:
    """Draw the impacts around the site enlarged, on the side of the map where the site is not."""
    left = 0.045 if inset_left(site) else 0.615
    frame = Rectangle((left - 0.03, 0.07), 0.4, 0.88, transform=axes.transAxes, color="white", alpha=0.94, zorder=7)
    axes.add_patch(frame)
    view = axes.inset_axes((left + 0.015, 0.15, 0.34, 0.71), zorder=8)
    drawn = draw_density(view, latitude, longitude, window, 9.0)
    mark_site(view, float(near(np.array([site[1]]), window.longitude)[0]), site[0])
    view.set_xlim(window.longitude - window.half_longitude, window.longitude + window.half_longitude)
    view.set_ylim(window.latitude - window.half, window.latitude + window.half)
    view.set_title("around the site [deg]", fontsize=8, pad=4)
    view.tick_params(labelsize=7)
    view.locator_params(nbins=4)
    view.grid(visible=True)
    for spine in view.spines.values():
        spine.set_visible(True)
    return view, drawn


def draw_relief(axes: Axes, vertices: Array) -> None:
    """Shade the body's height over latitude and longitude by a light from the north-west."""
    radius = np.linalg.norm(vertices, axis=1)
    latitude = np.degrees(np.arcsin(vertices[:, 2] / radius))
    longitude = np.degrees(np.arctan2(vertices[:, 1], vertices[:, 0]))
    # Two turns more than one, so that the interpolation closes across the date line.
    x = np.concatenate([longitude - 360, longitude, longitude + 360])
    y, height = np.tile(latitude, 3), np.tile(radius, 3)
    poles = np.array([[lon, lat] for lat in (-90.0, 90.0) for lon in np.arange(-540, 541, 30)])
    pole_height = np.where(poles[:, 1] > 0, radius[np.argmax(latitude)], radius[np.argmin(latitude)])
    surface = LinearNDInterpolator(np.vstack([np.column_stack([x, y]), poles]), np.concatenate([height, pole_height]))
    lon, lat = np.meshgrid(np.arange(-180, 181, 1.5), np.arange(-90, 91, 1.5))
    grid = surface(lon, lat)
    light = matplotlib.colors.LightSource(azdeg=315, altdeg=40)
    scale = np.ptp(grid) / 10.0 or 1.0
    shaded = light.hillshade(grid[::-1] / scale, dx=1.5, dy=1.5)[::-1]
    axes.imshow(
        # Stretched between the darkest and the lightest slope, and kept pale so that the impacts stand out.
        0.78 + 0.2 * (shaded - shaded.min()) / (np.ptp(shaded) or 1.0),
        extent=(-180, 180, -90, 90),
        origin="lower",
        cmap="gray",
        vmin=0,
        vmax=1,
        zorder=0,
        interpolation="bicubic",
    )


def draw_shares(axes: Axes, shares: list[Share], whole: str) -> None:
    """One bar an outcome, the interval of a share that has one, and in the margin to the right its figure in per cent.

    whole: what they are shares of, "all samples".
    """
    place = np.arange(len(shares))[::-1]
    words = f"share of {whole} [%]"
    for y, share in zip(place, shares, strict=True):
        axes.barh(y, 100 * share.value, color=share.colour, height=0.68)
        if share.upper is not None:
            ends = [100 * (share.lower or 0.0), 100 * share.upper]
            # At the very ends of the axis a clipped line would look as if there were no interval.
            axes.plot(ends, [y, y], color=INK, linewidth=1.4, solid_capstyle="butt", clip_on=False)
        if share.lower is not None:
            words = f"share of {whole} [%], with {percent(share.level)} interval"
        axes.text(1.025, y, share.words, transform=axes.get_yaxis_transform(), va="center_baseline", fontsize=8)
    axes.set_yticks(place, [share.name for share in shares])
    axes.set_xlim(0, 100)
    axes.set_xticks(range(0, 101, 20))
    axes.set_xlabel(words)
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
