"""Places on a small body laid flat without a change of area, and cells of equal area that cover it."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.given_numbers import whole_number

# Places farther than this from their mean direction [rad] lie all around the body.
FARTHEST = math.radians(120.0)
# Directions among which the emptiest is sought: some 4 degrees apart.
CANDIDATES = 3000
FEWEST, MOST = 4, 20_000


@dataclass(frozen=True)
class EqualAreaMap:
    """Lambert's azimuthal projection of a sphere, in metres on the ground.

    axes    rows: two directions across the middle, and that of the middle, [3, 3]
    radius  of the sphere [m]
    """

    axes: Array
    radius: float

    @classmethod
    def of(cls, points: Array) -> "EqualAreaMap":
        """The map of points [count, 3] body-fixed [m], none at the origin: a sphere of their root mean square radius.

        About their mean direction; where some lie farther than 120 deg from it, opposite the emptiest direction, since
        the map tears what lies opposite its middle.
        """
        radii = np.linalg.norm(points, axis=1)
        directions = points / radii[:, None]
        middle = directions.sum(axis=0)
        size = float(np.linalg.norm(middle))
        middle = middle / size if size > 0.0 else directions[0]
        if (directions @ middle).min() < math.cos(FARTHEST):
            candidates = _even_directions(CANDIDATES)
            middle = -candidates[np.argmin((candidates @ directions.T).max(axis=1))]
        across = np.cross(np.eye(3)[np.argmin(np.abs(middle))], middle)
        across /= np.linalg.norm(across)
        return cls(np.stack([across, np.cross(middle, across), middle]), float(np.sqrt(np.mean(radii**2))))

    def laid_flat(self, points: Array) -> Array:
        """Places [m] on the map, [count, 2], of points [count, 3]. Source: [Snyder-1987], chapter 24."""
        x, y, z = self.axes @ (points / np.linalg.norm(points, axis=1)[:, None]).T
        # Half of the squared distance to the point opposite the middle, of which nothing is lost near it.
        opposite = 0.5 * (x**2 + y**2 + (1.0 + z) ** 2)
        flat: Array = self.radius * np.sqrt(2.0 / np.maximum(opposite, 1e-300)) * np.stack([x, y])
        return flat.T

    def directions(self, places: Array) -> Array:
        """Directions [..., 3] of places [m] on the map, [..., 2]; beyond its edge, of the edge."""
        flat = places / self.radius
        square = np.sum(flat**2, axis=-1, keepdims=True)
        inside = np.minimum(square, 4.0)
        flat = flat * np.sqrt(np.divide(inside, square, out=np.ones_like(square), where=square > 0.0))
        level = flat * np.sqrt(1.0 - 0.25 * inside)
        return np.concatenate([level, 1.0 - 0.5 * inside], axis=-1) @ self.axes

    def holds(self, places: Array) -> np.ndarray:
        """Whether places [m], [..., 2], lie within the edge of the map, [...]."""
        return np.sum(places**2, axis=-1) <= (2.0 * self.radius) ** 2


def latitude_longitude(directions: Array) -> Array:
    """Latitude and east longitude in (-180, 180] [deg], [..., 2], of directions [..., 3]."""
    x, y, z = np.moveaxis(directions, -1, 0)
    latitude, longitude = np.degrees(np.arctan2(z, np.hypot(x, y))), np.degrees(np.arctan2(y, x))
    return np.stack([latitude, np.where(longitude == -180.0, 180.0, longitude)], axis=-1)


def _even_directions(count: int) -> Array:
    """Directions [count, 3] that lie evenly over the sphere, on a spiral of the golden angle."""
    height = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = np.pi * (3.0 - math.sqrt(5.0)) * np.arange(count)
    across = np.sqrt(1.0 - height**2)
    return np.stack([across * np.cos(turn), across * np.sin(turn), height], axis=1)


@dataclass(frozen=True)
class EqualAreaCells:
    """Cells of one solid angle each, seen from the centre, numbered from the south and in each band from west to east.

    count   of the cells in each band, [band_count]
    edges   sines of the latitudes of the bands' borders, from -1 to 1, [band_count + 1]
    """

    count: Labels
    edges: Array

    @classmethod
    def of(cls, total: int) -> "EqualAreaCells":
        """So many cells, 4 to 20 000. Raises ValueError for another number."""
        number = whole_number("cells", total, FEWEST, MOST)
        bands = max(2, round(0.5 * math.sqrt(math.pi * number)))
        borders = np.sin(np.linspace(-0.5 * np.pi, 0.5 * np.pi, bands + 1))
        # Bands of equal height, moved until each holds a whole number of cells.
        below = np.rint(0.5 * number * (1.0 + borders)).astype(np.int64)
        kept = np.unique(below)
        return cls(np.diff(kept), 2.0 * kept / number - 1.0)

    @property
    def total(self) -> int:
        """How many cells there are."""
        return int(self.count.sum())

    @property
    def bounds_deg(self) -> Array:
        """South, north, west and east of each cell [deg], [cell_count, 4]; longitudes from -180 to 180."""
        latitude = np.degrees(np.arcsin(self.edges))
        parts = [
            np.column_stack([np.full(count, south), np.full(count, north), meridians[:-1], meridians[1:]])
            for count, south, north in zip(self.count.tolist(), latitude[:-1], latitude[1:], strict=True)
            for meridians in (np.linspace(-180.0, 180.0, count + 1),)
        ]
        return np.concatenate(parts)

    @property
    def centres_deg(self) -> Array:
        """Latitude and longitude of the middle of each cell [deg], [cell_count, 2]: half of its area on either side."""
        half = np.full((self.total, 1, 2), 0.5)
        # Without the rounding that leaves the equator and longitude 0 beside themselves.
        return np.round(self.places_deg(half)[:, 0], 12) + 0.0

    def places_deg(self, uniforms: ArrayLike) -> Array:
        """Latitude and longitude [deg], [cell_count, place_count, 2], of places spread evenly over each cell.

        uniforms: numbers from 0 to 1, [cell_count, place_count, 2], northward and eastward within the cell.
        """
        northward, eastward = np.moveaxis(np.asarray(uniforms, dtype=float), -1, 0)
        south, north = (np.repeat(ends, self.count)[:, None] for ends in (self.edges[:-1], self.edges[1:]))
        west, east = (self.bounds_deg[:, which, None] for which in (2, 3))
        latitude = np.degrees(np.arcsin(np.clip(south + northward * (north - south), -1.0, 1.0)))
        return np.stack([latitude, west + eastward * (east - west)], axis=-1)

    def cell_of(self, latitude_deg: ArrayLike, longitude_deg: ArrayLike) -> Labels:
        """Number of the cell in which each place lies, [count]; longitudes of any turn."""
        sine = np.sin(np.radians(np.asarray(latitude_deg, dtype=float)))
        band = np.clip(np.searchsorted(self.edges, sine, side="right") - 1, 0, len(self.count) - 1)
        turn = (np.asarray(longitude_deg, dtype=float) + 180.0) / 360.0 % 1.0
        column = np.minimum((turn * self.count[band]).astype(np.int64), self.count[band] - 1)
        first = np.concatenate([[0], np.cumsum(self.count)])
        return first[band] + column
