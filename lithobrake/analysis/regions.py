"""Regions of the ground that hold shares of the places: ellipses, and the smallest regions."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import distance

from lithobrake.analysis.equal_area import EqualAreaMap, latitude_longitude
from lithobrake.analysis.outlines import thinned, to_the_tolerance
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import finite_number, numbers

# Places whose directions cancel more than this have no middle that means anything.
SMALLEST_RESULTANT = 0.7
SMALLEST_COUNT = 10
# Places closer together than this [rad] differ by rounding only.
SMALLEST_SIZE = 1e-12
FEWEST_POINTS = 5
# Points this much nearer to a line than they reach along it have no area.
THINNEST = 1e-6
# Median of the squared distance from the middle in standard deviations, of a normal law in the plane.
NORMAL_MEDIAN = 2.0 * math.log(2.0)
# The map reaches so many bandwidths beyond the points; a region, fewer: a lone point keeps an island about it.
MARGIN, REACH = 4.0, 3.0
# Cells of the map along each axis: three to a bandwidth, within these bounds.
FEWEST_CELLS, MOST_CELLS = 300, 1200
# Cells of a region, and then points of its cells and outlines, among which its extent is looked for.
EXTENT_CELLS, EXTENT_POINTS = 1500, 3000
# Of the bandwidth, along each of its axes: how far a thinned outline may lie from the edge of its region.
TOLERANCE = 0.1
# Points whose distances from all others are worked out at once: bounds the memory.
BLOCK = 1000


@dataclass(frozen=True)
class Ellipses:
    """Ellipses about the mean direction of places on a sphere, similar to each other, one for each share.

    latitude_deg, longitude_deg   of the middle
    heading_deg                   of the longer axis there, from north toward east, in [0, 180)
    semi_axes_deg                 of each share, longer and shorter, as angles at the sphere's centre; a share whose
                                  ellipse would reach round more than half of the sphere is left out
    """

    latitude_deg: float
    longitude_deg: float
    heading_deg: float
    semi_axes_deg: dict[float, tuple[float, float]]


def dispersion_ellipses(
    latitude_deg: ArrayLike, longitude_deg: ArrayLike, shares: tuple[float, ...] = (0.5, 0.95)
) -> Ellipses | None:
    """Ellipses that contain given fractions of places; None for few places, one place, or places all around the body.

    The places are laid flat about their mean direction, keeping distance and direction from it (azimuthal equidistant);
    the axes are those of their second moments, and each ellipse is as large as it takes to hold its share of them: no
    law is assumed. Raises ValueError for shares outside 0 to 1, for places that are not finite or of other latitudes.
    Source: [Mardia-2000], section 9.2 (mean direction, resultant length).
    """
    if not all(0.0 < share < 1.0 for share in shares):
        raise ValueError(f"shares are {shares}; each must lie between 0 and 1")
    latitude, longitude = _angles(latitude_deg, longitude_deg)
    if latitude.size < SMALLEST_COUNT:
        return None
    across = np.cos(latitude)
    places = np.stack([across * np.cos(longitude), across * np.sin(longitude), np.sin(latitude)], axis=-1)
    mean = places.mean(axis=0)
    if np.linalg.norm(mean) < SMALLEST_RESULTANT:
        return None
    flat, middle = _laid_flat(places, mean / np.linalg.norm(mean))
    values, vectors = np.linalg.eigh(flat.T @ flat / len(flat))
    # Places on one line have no width; a billionth of the length keeps the division below.
    sizes = np.sqrt(np.maximum(values, 1e-18 * values[1]))
    if sizes[1] < SMALLEST_SIZE:
        return None
    distance = np.linalg.norm(flat @ vectors / sizes, axis=1)
    scales = {share: float(np.quantile(distance, share)) for share in shares}
    north, east = vectors[:, 1]
    return Ellipses(
        *middle,
        math.degrees(math.atan2(east, north)) % 180.0,
        {
            share: (math.degrees(k * sizes[1]), math.degrees(k * sizes[0]))
            for share, k in scales.items()
            if k * sizes[1] <= 0.5 * math.pi
        },
    )


def _angles(latitude_deg: ArrayLike, longitude_deg: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Latitudes and longitudes [rad], both [count]; raises ValueError for what is no place on a sphere."""
    latitude, longitude = numbers("latitude_deg", latitude_deg), numbers("longitude_deg", longitude_deg)
    if latitude.ndim != 1 or latitude.shape != longitude.shape:
        raise ValueError(
            f"latitude_deg has shape {latitude.shape} and longitude_deg {longitude.shape}, but both must be [count]"
        )
    wrong = ~((np.abs(latitude) <= 90.0) & (np.abs(longitude) <= 360.0))
    if wrong.any():
        place = int(np.flatnonzero(wrong)[0])
        raise ValueError(
            f"place {place} has latitude_deg {latitude[place]:g} and longitude_deg {longitude[place]:g}, but they must "
            "lie in -90 to 90 and -360 to 360: leave out places that are not known"
        )
    return np.radians(latitude), np.radians(longitude)


def _laid_flat(
    places: NDArray[np.float64], middle: NDArray[np.float64]
) -> tuple[NDArray[np.float64], tuple[float, float]]:
    """Distances north and east [rad] of unit vectors [count, 3] from a middle, [count, 2], and its place [deg]."""
    latitude, longitude = math.asin(min(max(middle[2], -1.0), 1.0)), math.atan2(middle[1], middle[0])
    c, s = math.cos(longitude), math.sin(longitude)
    north = np.array([-math.sin(latitude) * c, -math.sin(latitude) * s, math.cos(latitude)])
    level = np.stack([places @ north, places @ np.array([-s, c, 0.0])], axis=1)
    length = np.linalg.norm(level, axis=1)
    angle = np.arctan2(length, places @ middle)
    flat = level * np.divide(angle, length, out=np.ones_like(angle), where=length > 0.0)[:, None]
    return flat, (math.degrees(latitude), math.degrees(longitude))


@dataclass(frozen=True)
class DensityRegion:
    """The smallest region that holds a share of the places.

    share             that it holds, of 1
    area_m2           of the sphere of the local radius that it covers
    largest_extent_m  largest distance between two of its points, straight through the body
    island_extents_m  the same of each of its separate parts, the one of the largest area first
    outlines          latitude and east longitude in (-180, 180] [deg] along its edge, [count, 2] each, all of them
                      closed: an edge that crosses the date line goes on from 180 at -180; area and extents are of the
                      edge before it was thinned
    """

    share: float
    area_m2: float
    largest_extent_m: float
    island_extents_m: tuple[float, ...]
    outlines: tuple[Array, ...]


@dataclass(frozen=True)
class HighestDensity:
    """Regions of highest density, one for each fraction; empty, with the reason in `why`, if there are none.

    regions      in the order of the shares
    bandwidth_m  of the density along its longer and shorter axis; None without regions
    why          why there is no region; None where there are
    """

    regions: tuple[DensityRegion, ...]
    bandwidth_m: tuple[float, float] | None
    why: str | None


@dataclass(frozen=True)
class _Density:
    """A density of places on a map, in units of its bandwidths along its own axes.

    middle [2] and axes [2, 2] (rows) of the map [m], bandwidth [m] [2]; points [count, 2] in bandwidths
    """

    map: EqualAreaMap
    middle: Array
    axes: Array
    bandwidth: Array
    points: Array

    def level(self, share: float) -> float:
        """The density above which this share of places lies: each point counts with the density of all others."""
        blocks = (self.points[start : start + BLOCK] for start in range(0, len(self.points), BLOCK))
        squares = (distance.cdist(block, self.points, "sqeuclidean") for block in blocks)
        others = np.concatenate([np.exp(-0.5 * one).sum(axis=1) for one in squares]) - 1.0
        return max(float(np.quantile(others, 1.0 - share, method="hazen")), math.exp(-0.5 * REACH**2))

    def grid(self) -> tuple[Array, Array, Array]:
        """Coordinates of the cells along both axes [bandwidths], and the density there; 0 beyond the map."""
        low, high = self.points.min(axis=0) - MARGIN, self.points.max(axis=0) + MARGIN
        counts = np.clip(np.ceil(3.0 * (high - low)), FEWEST_CELLS, MOST_CELLS).astype(int)
        x, y = (np.linspace(*ends) for ends in zip(low, high, counts, strict=True))
        along, across = (
            np.exp(-0.5 * (cells - own[:, None]) ** 2) for cells, own in zip((x, y), self.points.T, strict=True)
        )
        places = self.places(np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1))
        return x, y, np.where(self.map.holds(places), along.T @ across, 0.0)

    def places(self, own: Array) -> Array:
        """Places on the map [m] of coordinates [..., 2] in bandwidths."""
        return self.middle + (own * self.bandwidth) @ self.axes


def highest_density(
    points: ArrayLike, shares: Sequence[float] = (0.5, 0.95), *, tolerance: float = TOLERANCE
) -> HighestDensity:
    """Find the smallest regions that hold shares of the places of which points [count, 3] body-fixed [m] are a sample.

    The points are laid on a sphere of their root mean square radius and that on a map without a change of area: slopes
    and an uneven radius are left out of the area. Their density is a sum of normal laws, with the covariance of the
    points times n^(-1/3) (Scott's rule), less where half of the points lie closer together than in a normal law of
    that covariance. A region is where the density exceeds a level; the level is that which the share of the points
    exceeds, each by the density of the others, so that the region holds the share of the next landers as well. No
    region reaches farther than three bandwidths from every point. Outlines keep within a tolerance of the edge, in
    bandwidths; 0 keeps all its points.
    Fewer than five points, or points on a line, have no region, and `why` has the reason. Raises ValueError for points
    that are not finite or lie at the origin, and for shares outside 0 to 1.
    Two clouds far apart widen the bandwidth, and with it the regions. Source: [Scott-2015], section 6.3 (bandwidth);
    [Silverman-1986], section 4.3.2 (spread); [Hyndman-1996b] (level from points).
    """
    if not all(0.0 < share < 1.0 for share in shares):
        raise ValueError(f"shares are {tuple(shares)}; each must lie between 0 and 1")
    finite_number("tolerance", tolerance, at_least=0.0)
    places = numbers("points", points)
    if places.ndim != 2 or places.shape[1] != 3 or not np.isfinite(places).all():
        raise ValueError(f"points have shape {places.shape}, but must be [count, 3] of finite numbers, body-fixed in m")
    if not np.any(places, axis=1).all():
        raise ValueError("points hold the origin of the body's frame, which is no place on the ground")
    if len(places) < FEWEST_POINTS:
        return HighestDensity((), None, f"{len(places)} places are too few for a region: {FEWEST_POINTS} are needed")
    density = _density(places)
    if density is None:
        return HighestDensity((), None, "the places lie on one line or on top of each other, which has no area")
    grid = density.grid()
    longer, shorter = sorted(density.bandwidth.tolist(), reverse=True)
    return HighestDensity(tuple(_region(density, grid, share, tolerance) for share in shares), (longer, shorter), None)


def _density(places: Array) -> _Density | None:
    """The density of places [count, 3]; None where they have no area."""
    flat_map = EqualAreaMap.of(places)
    flat = flat_map.laid_flat(places)
    middle = flat.mean(axis=0)
    variances, vectors = np.linalg.eigh(np.cov(flat.T))
    if variances[0] <= THINNEST**2 * variances[1]:
        return None
    own = (flat - middle) @ vectors
    squares = np.sum(own**2 / variances, axis=1)
    # A few places far off would blur all the others.
    spread = np.sqrt(variances * min(1.0, float(np.median(squares)) / NORMAL_MEDIAN))
    bandwidth = spread * len(flat) ** (-1.0 / 6.0)
    return _Density(flat_map, middle, vectors.T, bandwidth, own / bandwidth)


def _region(density: _Density, grid: tuple[Array, Array, Array], share: float, tolerance: float) -> DensityRegion:
    from contourpy import contour_generator

    x, y, values = grid
    level = density.level(share)
    # Lines keep the higher side on their left, so the areas of holes are negative.
    lines = [np.asarray(line, dtype=float) for line in contour_generator(x, y, values.T).lines(level)]
    areas = np.array([_enclosed(line) for line in lines])
    edges = [density.map.directions(density.places(line)) for line in lines]
    inside = np.argwhere(values >= level)
    inside = inside[:: math.ceil(len(inside) / EXTENT_CELLS)]
    cells = density.map.directions(density.places(np.column_stack([x[inside[:, 0]], y[inside[:, 1]]])))
    extent = _extent(np.concatenate([*edges, cells])) * density.map.radius
    largest_first = [edges[one] for one in np.argsort(-areas, kind="stable") if areas[one] > 0.0]
    islands = tuple(_extent(edge) * density.map.radius for edge in largest_first)
    area = float(areas.sum()) * float(np.prod(density.bandwidth))
    return DensityRegion(share, area, extent, islands, tuple(_outline(density, line, tolerance) for line in lines))


def _outline(density: _Density, line: Array, tolerance: float) -> Array:
    """Latitude and longitude [deg], [fewer, 2], along a closed edge [count, 2] in bandwidths."""
    if tolerance == 0.0:
        return latitude_longitude(density.map.directions(density.places(line)))
    few = density.map.directions(density.places(thinned(line, tolerance)))
    return to_the_tolerance(latitude_longitude(few), tolerance * float(density.bandwidth.min()) / density.map.radius)


def _enclosed(line: Array) -> float:
    """Area that a closed line [count, 2] goes round counter-clockwise."""
    x, y = (line - line[0]).T
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def _extent(directions: Array) -> float:
    """Largest distance between two of some points of a unit sphere [count, 3]."""
    few = directions[:: math.ceil(len(directions) / EXTENT_POINTS)]
    return float(distance.pdist(few).max(initial=0.0))
