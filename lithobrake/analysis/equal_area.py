"""Places on a small body laid flat without a change of area, and back."""

import math
from dataclasses import dataclass

import numpy as np

from lithobrake.vocabulary.arrays import Array

# Places farther than this from their mean direction [rad] lie all around the body.
FARTHEST = math.radians(120.0)
# Directions among which the emptiest is sought: some 4 degrees apart.
CANDIDATES = 3000


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
        found: Array = np.concatenate([level, 1.0 - 0.5 * inside], axis=-1) @ self.axes
        return found

    def holds(self, places: Array) -> np.ndarray:
        """Whether places [m], [..., 2], lie within the edge of the map, [...]."""
        held: np.ndarray = np.sum(places**2, axis=-1) <= (2.0 * self.radius) ** 2
        return held


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
