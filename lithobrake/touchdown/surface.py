"""The surface of a bed, as a vertical ray sees it."""

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem import ConvexHull, folded, period_of, rotation_matrices

Floats = NDArray[np.float64]
RAYS_PER_DIAMETER = 4


def rotation_matrix(quaternion: Floats) -> Floats:
    """Return the rotation matrix [3, 3], body to world, of a unit quaternion w, x, y, z."""
    return rotation_matrices(quaternion[None])[0]


def height_map(
    grains: list[ConvexHull], position: Floats, orientation: Floats, width: tuple[float, float],
    period: tuple[float, float] | None = None,
) -> Floats:  # fmt: skip
    """Return the height [m] of the topmost grain over a regular grid of the bed, 0 where only the floor is seen.

    period [m]: after which the ground repeats; None in a box.
    """
    spacing = np.mean([2.0 * grain.bounding_radius for grain in grains]) / RAYS_PER_DIAMETER
    axes = [(np.arange(n := max(1, round(w / spacing))) + 0.5) * w / n - 0.5 * w for w in width]
    x, y = np.meshgrid(*axes, indexing="ij")
    return np.maximum(heights_at(x, y, grains, position, orientation, period), 0.0)


def heights_at(
    x: Floats, y: Floats, grains: list[ConvexHull], position: Floats, orientation: Floats,
    period: tuple[float, float] | None = None,
) -> Floats:  # fmt: skip
    """Return the height [m] of the topmost grain at places x, y [m] of any one shape, minus infinity where none is.

    period [m]: after which the ground repeats; None in a box.
    """
    heights = np.full_like(x, -np.inf)
    for grain, place, turn in zip(grains, position, orientation, strict=True):
        way = folded(np.stack([x - place[0], y - place[1]], axis=-1), period_of(period))
        near = way[..., 0] ** 2 + way[..., 1] ** 2 <= grain.bounding_radius**2
        if near.any():
            heights[near] = np.maximum(heights[near], place[2] + _top(grain, turn, *way[near].T))
    return heights


def _top(grain: ConvexHull, turn: Floats, x: Floats, y: Floats) -> Floats:
    """Return how far above the centroid vertical rays at x, y [m] from it leave a grain; minus infinity: they miss."""
    normals = grain.polyhedron.face_normals @ rotation_matrix(turn).T
    offsets = grain.polyhedron.face_offsets - grain.polyhedron.face_normals @ grain.centroid
    rest = offsets[:, None] - normals[:, :1] * x - normals[:, 1:2] * y
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = rest / normals[:, 2:]
    top = np.where(normals[:, 2:] > 0.0, crossing, np.inf).min(axis=0)
    bottom = np.where(normals[:, 2:] < 0.0, crossing, -np.inf).max(axis=0)
    beside = ((normals[:, 2:] == 0.0) & (rest < 0.0)).any(axis=0)
    found: Floats = np.where((top >= bottom) & ~beside, top, -np.inf)
    return found
