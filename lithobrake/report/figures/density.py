"""How densely impacts lie on a map, for the whole body and for a close view around the site."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Array = NDArray[np.float64]

# Below this, cells of a sixtieth of the map's height would be mostly empty.
MANY_IMPACTS = 10_000
# A close view is drawn where most impacts and the site fit into a window of less than this height [deg].
CLOSE_DEG = 45.0


@dataclass(frozen=True)
class Window:
    """A part of the map: its middle, half its height and half its width [deg]."""

    latitude: float
    longitude: float
    half: float
    half_longitude: float


WHOLE = Window(latitude=0.0, longitude=0.0, half=90.0, half_longitude=180.0)


def close_window(latitude: Array, longitude: Array, site: tuple[float, float]) -> Window | None:
    """The window that holds the site and 98 of 100 impacts, or None when they lie too far apart, or near a pole."""
    if not len(latitude):
        return None
    low, high = (np.append(np.quantile(near(latitude, site[0]), share), site[0]) for share in (0.01, 0.99))
    left, right = (np.append(np.quantile(near(longitude, site[1]), share), site[1]) for share in (0.01, 0.99))
    middle = 0.5 * float(low.min() + high.max())
    shrink = float(np.cos(np.radians(middle)))
    half = 0.58 * max(float(high.max() - low.min()), shrink * float(right.max() - left.min()))
    if half > CLOSE_DEG / 2 or abs(middle) + half > 80.0:
        return None
    half = max(half, 1e-3)
    # As wide as it is high on the ground.
    return Window(middle, 0.5 * float(left.min() + right.max()), half, half / float(np.cos(np.radians(middle))))


def near(angle: Array, reference: float) -> Array:
    """Angles [deg] turned by whole turns to within half a turn of a reference."""
    turned: Array = reference + (angle - reference + 180.0) % 360.0 - 180.0
    return turned


def draw_density(axes: Axes, latitude: Array, longitude: Array, window: Window, size: float) -> tuple[Any, str]:
    """Draw impacts and give what a colour bar needs: the drawn thing, and its words.

    Many impacts: how many fall in each cell. Fewer: a dot each (`size` in points squared), coloured by how many lie
    around it. latitude, longitude [deg], shape [impact].
    """
    x = near(longitude, window.longitude)
    if len(latitude) >= MANY_IMPACTS:
        columns = 121 if window is WHOLE else 61
        edges_x = window.longitude + np.linspace(-window.half_longitude, window.half_longitude, columns)
        edges_y = window.latitude + np.linspace(-window.half, window.half, 61)
        counts = np.histogram2d(x, latitude, bins=(edges_x, edges_y))[0]
        norm = LogNorm(1, max(counts.max(), 10))
        shown = np.ma.masked_equal(counts.T, 0)
        drawn: Any = axes.pcolormesh(edges_x, edges_y, shown, norm=norm, cmap="viridis", zorder=2, rasterized=True)
        return drawn, f"impacts per cell of {window.half / 30:.2g} deg"
    distance = window.half / 18.0
    around = neighbour_count(latitude, longitude, distance)
    order = np.argsort(around, kind="stable")
    norm = LogNorm(1, max(around.max(), 10))
    drawn = axes.scatter(
        x[order], latitude[order], c=around[order], norm=norm, cmap="viridis", s=size, linewidths=0, zorder=2
    )
    return drawn, f"impacts within {distance:.2g} deg"


def neighbour_count(latitude: Array, longitude: Array, distance_deg: float) -> Array:
    """How many impacts, itself among them, lie within a distance on the sphere of each impact, shape [impact]."""
    lat, lon = np.radians(latitude), np.radians(longitude)
    points = np.column_stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])
    chord = 2.0 * np.sin(np.radians(distance_deg) / 2.0)
    count: Array = cKDTree(points).query_ball_point(points, chord, return_length=True).astype(float)
    return count
