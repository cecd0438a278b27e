"""The ground about a place laid flat, the density of places on it, and their marks."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, LogNorm, to_rgb
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.patheffects import Normal, Stroke
from numpy.typing import NDArray

from lithobrake.report.figures.style import INK
from lithobrake.results.dispersion import RestRegion
from lithobrake.vocabulary.array_types import Array

# Lines of the graticule: so many points each, and round steps between them [deg].
LINE_POINTS = 361
STEPS_DEG = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0)
# A panel has about so many lines of each kind.
LINES = 4.0
# A panel has so much more than what it has to hold; one wider than a part of the half sphere is drawn as both halves.
MARGIN, WIDEST = 1.12, 0.7
# Below this cells would be mostly empty, and each place is a dot.
MANY = 1000
# Cells along the width of a map.
CELLS = 60
# Four strokes that point at the place and leave it open: a site is where impacts may be densest.
CROSSHAIR = Path(
    [(0.4, 0.0), (1.0, 0.0), (-0.4, 0.0), (-1.0, 0.0), (0.0, 0.4), (0.0, 1.0), (0.0, -0.4), (0.0, -1.0)],
    [Path.MOVETO, Path.LINETO] * 4,
)
# The white rim keeps the thin strokes readable on dark and on bright places alike.
SITE_STYLE: dict[str, Any] = {
    "marker": CROSSHAIR,
    "markersize": 17,
    "fillstyle": "none",
    "markeredgecolor": INK,
    "markeredgewidth": 1.6,
    "path_effects": [Stroke(linewidth=3.4, foreground="white"), Normal()],
}
# Of the edges of regions with a soil of their own.
SOIL_STYLE: dict[str, Any] = {"color": INK, "linewidth": 1.1, "linestyle": (0, (1.0, 1.6))}
Outlines = Sequence[Sequence[tuple[float, float]]]
# Beyond this a region is dashed.
LARGE_SHARE = 0.9


@dataclass(frozen=True)
class GroundMap:
    """Lambert's azimuthal map of a sphere about a place: latitude and longitude [deg] of it, and the radius [m].

    Source: [Snyder-1987], chapter 24.
    """

    latitude: float
    longitude: float
    radius: float

    @property
    def edge(self) -> float:
        """How far from the middle the half of the sphere around it reaches on the map [m]."""
        return float(np.sqrt(2.0)) * self.radius

    @property
    def opposite(self) -> "GroundMap":
        """The map about the place on the other side."""
        return GroundMap(-self.latitude, self.longitude + 180.0, self.radius)

    def places(self, latitude: Array, longitude: Array) -> tuple[Array, Array]:
        """Metres east and north on the map of latitudes and longitudes [deg], [count] each."""
        facing, east, north = self._axes(latitude, longitude)
        size = self.radius * np.sqrt(2.0 / np.maximum(1.0 + facing, 1e-12))
        return size * east, size * north

    def facing(self, latitude: Array, longitude: Array) -> Array:
        """Cosine of the angle from the middle, [count]: above 0 on the half of the sphere around it."""
        return self._axes(latitude, longitude)[0]

    def line(self, latitude: Array, longitude: Array, least: float = 0.0) -> tuple[Array, Array]:
        """A line on the map, broken where it lies farther from the middle than an angle of this cosine."""
        east, north = self.places(latitude, longitude)
        is_far = self.facing(latitude, longitude) < least
        return np.where(is_far, np.nan, east), np.where(is_far, np.nan, north)

    def back(self, east: Array, north: Array) -> tuple[Array, Array]:
        """Latitude and longitude [deg] of places on the map [m], within its edge."""
        x, y = east / self.radius, north / self.radius
        square = np.minimum(x**2 + y**2, 4.0)
        scale = np.sqrt(1.0 - 0.25 * square)
        facing, along, up = 1.0 - 0.5 * square, scale * x, scale * y
        middle = np.radians(self.latitude)
        height = facing * np.sin(middle) + up * np.cos(middle)
        turn = np.arctan2(along, facing * np.cos(middle) - up * np.sin(middle))
        return np.degrees(np.arcsin(np.clip(height, -1.0, 1.0))), self.longitude + np.degrees(turn)

    def _axes(self, latitude: Array, longitude: Array) -> tuple[Array, Array, Array]:
        """Parts of the direction of a place along the middle, east and north there."""
        lat, middle = np.radians(np.asarray(latitude, dtype=float)), np.radians(self.latitude)
        turn = np.radians(np.asarray(longitude, dtype=float) - self.longitude)
        facing = np.sin(middle) * np.sin(lat) + np.cos(middle) * np.cos(lat) * np.cos(turn)
        north = np.cos(middle) * np.sin(lat) - np.sin(middle) * np.cos(lat) * np.cos(turn)
        return facing, np.cos(lat) * np.sin(turn), north


@dataclass(frozen=True)
class MapPanel:
    """A square part of a map: its middle [m east and north] and half of its width [m]."""

    east: float
    north: float
    half: float

    def holds(self, east: Array, north: Array) -> NDArray[np.bool_]:
        """Which places lie within it."""
        return np.asarray((np.abs(east - self.east) <= self.half) & (np.abs(north - self.north) <= self.half))


def panel_around(ground: GroundMap, lines: Sequence[tuple[Array, Array]]) -> MapPanel | None:
    """The panel that holds the middle and these latitudes and longitudes [deg]; None where they lie too far apart."""
    latitude, longitude = (np.concatenate([np.array([middle]), *parts]) for middle, parts in zip(
        (ground.latitude, ground.longitude), zip(*lines, strict=True) if lines else ((), ()), strict=True
    ))  # fmt: skip
    if ground.facing(latitude, longitude).min() < 0.0:
        return None
    east, north = ground.places(latitude, longitude)
    half = MARGIN * 0.5 * max(float(np.ptp(east)), float(np.ptp(north)), 1e-6 * ground.radius)
    middle = 0.5 * float(east.min() + east.max()), 0.5 * float(north.min() + north.max())
    return MapPanel(*middle, half) if half < WIDEST * ground.edge else None


def step_of(width_deg: float) -> float:
    """The round step [deg] between lines of a graticule over a width [deg]."""
    return min(STEPS_DEG, key=lambda step: abs(np.log(width_deg / step / LINES)))


def round_length(most: float) -> float:
    """The largest of 1, 2 and 5 times a power of ten that is not more."""
    power = 10.0 ** np.floor(np.log10(most))
    return float(max(step * power for step in (1.0, 2.0, 5.0) if step * power <= most * (1.0 + 1e-12)))


def density_colours(colour: str) -> LinearSegmentedColormap:
    """From a pale tint of a colour over itself to a dark shade, ever darker."""
    own = np.array(to_rgb(colour))
    ends = [tuple(1.0 - 0.3 * (1.0 - own)), tuple(own), tuple(0.3 * own)]
    return LinearSegmentedColormap.from_list(f"density of {colour}", ends)


def draw_cells(
    axes: Axes, ground: GroundMap, places: tuple[Array, Array], panel: MapPanel | None, norm: LogNorm, colour: str
) -> None:
    """Draw how many places lie in each cell of a panel, or of the half of the body.

    places: latitude and longitude [deg], shape [count] each.
    """
    counts, (x, y), _ = cell_counts(ground, places, panel)
    shown = np.ma.masked_equal(counts.T, 0)
    axes.pcolormesh(x, y, shown, norm=norm, cmap=density_colours(colour), zorder=1.4, rasterized=True)


def cell_counts(
    ground: GroundMap, places: tuple[Array, Array], panel: MapPanel | None
) -> tuple[Array, tuple[Array, Array], float]:
    """Counts in cells [CELLS, CELLS], the edges of these east and north [m], and the width of a cell [m]."""
    shown = panel or MapPanel(0.0, 0.0, ground.edge)
    seen = ground.facing(*places) >= 0.0
    east, north = ground.places(*(one[seen] for one in places))
    edges = np.linspace(-shown.half, shown.half, CELLS + 1)
    x, y = shown.east + edges, shown.north + edges
    return np.histogram2d(east, north, bins=(x, y))[0], (x, y), 2.0 * shown.half / CELLS


def density_norm(counts: Sequence[Array]) -> LogNorm:
    """One scale for several maps."""
    return LogNorm(1.0, max([10.0, *(float(one.max()) for one in counts)]))


def mark_site(axes: Axes, x: float, y: float) -> None:
    """Mark the landing site; what lies there stays in sight."""
    axes.plot(x, y, zorder=6, **SITE_STYLE)


def region_style(region: RestRegion) -> Literal["-", "--"]:
    return "-" if region.share < LARGE_SHARE else "--"


def fill_regions(axes: Axes, regions: Sequence[RestRegion], ground: GroundMap, colour: str) -> None:
    """Fill regions on a map that holds them whole; the smaller lies in the larger, and the ground is darker there."""
    for region in regions:
        pieces = [Path(np.column_stack(ground.places(*np.array(line).T)), closed=False) for line in region.outlines]
        if pieces:
            path = Path.make_compound_path(*pieces)
            axes.add_patch(PathPatch(path, facecolor=colour, alpha=0.16, linewidth=0.0, zorder=1.5))


def draw_edges(axes: Axes, regions: Sequence[RestRegion], ground: GroundMap, colour: str) -> None:
    """The edges of regions, as far as they lie on this half of the body."""
    for region in regions:
        for line in region.outlines:
            x, y = ground.line(*np.array(line).T)
            axes.plot(x, y, color="white", linewidth=2.4, zorder=3.5, alpha=0.8)
            axes.plot(x, y, region_style(region), color=colour, linewidth=1.3, zorder=4)


def draw_soils(axes: Axes, soils: Mapping[str, Outlines], ground: GroundMap) -> None:
    """The edges of regions with a soil of their own, latitude and longitude [deg], on this half of the body."""
    for lines in soils.values():
        for line in lines:
            axes.plot(*ground.line(*np.array(line).T), zorder=2.5, **SOIL_STYLE)
