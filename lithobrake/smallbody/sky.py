"""What a place on the ground sees of a body far away, over a day of the small body: the Sun, Earth."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.compilation.compiled import compiled
from lithobrake.smallbody.arrays import Floats
from lithobrake.smallbody.ray_facet import intersect_facet
from lithobrake.smallbody.shape import Shape
from lithobrake.vocabulary.given_numbers import numbers

# Directions in a day: rise and set are known to half of one each, a fraction of the day to one over this.
DIRECTIONS = 144
# Part of the radius by which an eye stands above its own facet, so that it does not hide itself.
EYE = 1e-6


def day_directions(latitude_deg: ArrayLike) -> NDArray[np.float64]:
    """Unit vectors, body-fixed, to bodies far away that stand over latitudes [deg], [count, DIRECTIONS, 3].

    They are evenly spaced over a day of the body, from longitude 0 westward.
    """
    latitude = np.radians(numbers("latitude_deg", latitude_deg))[:, None]
    longitude = -2.0 * np.pi * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    along = np.cos(latitude)
    up = np.broadcast_to(np.sin(latitude), (len(latitude), DIRECTIONS))
    return np.stack([along * np.cos(longitude), along * np.sin(longitude), up], axis=-1)


def seen_over_a_day(
    shape: Shape, points: ArrayLike, up: ArrayLike, latitude_deg: ArrayLike, mask_deg: float = 0.0
) -> NDArray[np.bool_]:
    """Whether a body far away is seen from places on the ground at each of its directions, [count, DIRECTIONS].

    points [m] and outward normals up of the ground, [count, 3]; latitude_deg over which the body stands at each,
    [count]. It is seen where it stands higher above the plane of the ground than mask_deg, and no facet hides it.
    """
    place, normal = numbers("points", points), numbers("up", up)
    directions = day_directions(latitude_deg)
    height = np.einsum("pdi,pi->pd", directions, normal)
    seen = height > np.sin(np.radians(mask_deg))
    eyes = place + EYE * shape.radius * normal
    _take_out_hidden(shape.corners, np.ascontiguousarray(eyes), np.ascontiguousarray(normal), directions, seen)
    return seen


@compiled
def _take_out_hidden(corner: Floats, eyes: Floats, up: Floats, directions: Floats, seen: NDArray[np.bool_]) -> None:
    """Write False where a facet stands in the way; only facets that rise above the plane of the ground can."""
    for p in range(len(eyes)):
        for f in range(len(corner)):
            highest = -np.inf
            for c in range(3):
                rise = 0.0
                for i in range(3):
                    rise += (corner[f, c, i] - eyes[p, i]) * up[p, i]
                highest = max(highest, rise)
            if highest <= 0.0:
                continue
            for d in range(directions.shape[1]):
                if seen[p, d]:
                    t, _ = intersect_facet(corner, f, eyes[p], directions[p, d])
                    if t > 0.0:
                        seen[p, d] = False
