"""Figure 7: where the lander comes down after the first bounce, and in how many cases it does."""

from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.interpolate import LinearNDInterpolator
from scipy.spatial import cKDTree

from lithobrake.report.look import INK, INPUT_COLOURS, INTERACTIONS, QUIET, SITE, TEST

Array = NDArray[np.float64]

# Below this, cells of 3 deg would be mostly empty.
MANY_IMPACTS = 10_000


@dataclass(frozen=True)
class Share:
    """A share of the samples with its interval, all in [0, 1]."""

    name: str
    value: float
    lower: float
    upper: float


def map_figure(
    latitude: Array,
    longitude: Array,
    site: tuple[float, float],
    shares: list[Share],
    vertices: Array | None = None,
) -> Figure:
    """Draw the density of impacts on a map, and the shares of what became of the samples.

    latitude, longitude: of the impacts [deg], shape [impact]; site: latitude and longitude [deg];
    vertices: of the body [m], shape [vertex, 3], for the relief under the map; absent: a plain map.
    """
    figure = Figure(figsize=(9.2, 5.9))
    axes = figure.add_axes((0.06, 0.335, 0.84, 0.645))
    if vertices is not None:
        _relief(axes, vertices)
    _density(figure, axes, latitude, longitude)
    axes.plot(
        site[1], site[0], marker="*", markersize=15, color=SITE, markeredgecolor="white", markeredgewidth=1.0, zorder=6
    )
    axes.annotate(
        "landing site",
        (site[1], site[0]),
        xytext=(9, 9),
        textcoords="offset points",
        color=SITE,
        fontweight="bold",
        fontsize=8.5,
        zorder=6,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.2},
    )
    axes.set_xlim(-180, 180)
    axes.set_ylim(-90, 90)
    axes.set_aspect("equal")
    axes.set_xticks(range(-180, 181, 45))
    axes.set_yticks(range(-90, 91, 30))
    axes.set_xlabel("longitude, east [deg]")
    axes.set_ylabel("latitude [deg]")
    _shares(figure.add_axes((0.2, 0.095, 0.7, 0.15)), shares)
    return figure


def _density(figure: Figure, axes: Axes, latitude: Array, longitude: Array) -> None:
    """Many impacts: how many fall in each cell. Fewer: a dot each, coloured by how many lie around it."""
    if not len(latitude):
        axes.text(0, -50, "no impact among the flights", ha="center", fontsize=11, color=QUIET)
        return
    drawn: Any
    if len(latitude) >= MANY_IMPACTS:
        cells = (np.arange(-180, 181, 3), np.arange(-90, 91, 3))
        counts, x_edges, y_edges = np.histogram2d(longitude, latitude, bins=cells)
        shown = np.ma.masked_equal(counts.T, 0)
        norm = LogNorm(1, max(counts.max(), 10))
        drawn = axes.pcolormesh(x_edges, y_edges, shown, norm=norm, cmap="viridis", zorder=2, rasterized=True)
        words = "impacts per cell of 3 x 3 deg"
    else:
        around = _neighbour_count(latitude, longitude, 5.0)
        order = np.argsort(around, kind="stable")
        norm = LogNorm(1, max(around.max(), 10))
        drawn = axes.scatter(
            longitude[order], latitude[order], c=around[order], norm=norm, cmap="viridis", s=11, linewidths=0, zorder=2
        )
        words = "impacts within 5 deg"
    bar = figure.colorbar(drawn, cax=figure.add_axes((0.915, 0.36, 0.014, 0.57)), format="%g")
    bar.set_label(words)
    outline: Any = bar.outline
    outline.set_visible(False)


def _neighbour_count(latitude: Array, longitude: Array, distance_deg: float) -> Array:
    """How many impacts, itself among them, lie within a distance on the sphere of each impact, shape [impact]."""
    lat, lon = np.radians(latitude), np.radians(longitude)
    points = np.column_stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])
    chord = 2.0 * np.sin(np.radians(distance_deg) / 2.0)
    count: Array = cKDTree(points).query_ball_point(points, chord, return_length=True).astype(float)
    return count


def _relief(axes: Axes, vertices: Array) -> None:
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


def _shares(axes: Axes, shares: list[Share]) -> None:
    """One bar a fate, with its interval and its figure in per cent."""
    colours = (INPUT_COLOURS[0], INPUT_COLOURS[5], TEST, QUIET, INTERACTIONS)
    place = np.arange(len(shares))[::-1]
    for y, share, colour in zip(place, shares, colours * 3, strict=False):
        axes.barh(y, 100 * share.value, color=colour, height=0.68)
        axes.plot([100 * share.lower, 100 * share.upper], [y, y], color=INK, linewidth=1.4, solid_capstyle="butt")
        text = f"{100 * share.value:.2f} %   [{100 * share.lower:.2f}, {100 * share.upper:.2f}]"
        axes.text(100 * share.upper + 1, y, text, va="center", fontsize=8)
    axes.set_yticks(place, [share.name for share in shares])
    axes.set_xlim(0, 125)
    axes.set_xticks(range(0, 101, 20))
    axes.set_xlabel("share of all samples [%], with 95 % interval")
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
