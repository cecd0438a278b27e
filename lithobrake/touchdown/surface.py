"""The surface of a bed, as a vertical ray sees it."""

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem import ConvexHull, rotation_matrices

Floats = NDArray[np.float64]
RAYS_PER_DIAMETER = 4


def rotation_matrix(quaternion: Floats) -> Floats:
    """Return the rotation matrix [3, 3], body to world, of a unit quaternion w, x, y, z."""
    return rotation_matrices(quaternion[None])[0]


def height_map(grains: list[ConvexHull], position: Floats, orientation: Floats, width: tuple[float, float]) -> Floats:
    """Return the height [m] of the topmost grain over a regular grid of the box, 0 where only the floor is seen."""
    spacing = np.mean([2.0 * grain.bounding_radius for grain in grains]) / RAYS_PER_DIAMETER
    axes = [(np.arange(n := max(1, round(w / spacing))) + 0.5) * w / n - 0.5 * w for w in width]
    x, y = np.meshgrid(*axes, indexing="ij")
    heights = np.zeros_like(x)
    for grain, place, turn in zip(grains, position, orientation, strict=True):
        near = (x - place[0]) ** 2 + (y - place[1]) ** 2 <= grain.bounding_radius**2
        if near.any():
            heights[near] = np.maximum(heights[near], _top(grain, place, turn, x[near], y[near]))
    return heights


def _top(grain: ConvexHull, place: Floats, turn: Floats, x: Floats, y: Floats) -> Floats:
    """Return where vertical rays at x, y [m] leave a grain at the top; minus infinity where they miss it."""
    normals = grain.polyhedron.face_normals @ rotation_matrix(turn).T
    offsets = grain.polyhedron.face_offsets - grain.polyhedron.face_normals @ grain.centroid
    rest = offsets[:, None] - normals[:, :1] * (x - place[0]) - normals[:, 1:2] * (y - place[1])
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = rest / normals[:, 2:]
    top = np.where(normals[:, 2:] > 0.0, crossing, np.inf).min(axis=0)
    bottom = np.where(normals[:, 2:] < 0.0, crossing, -np.inf).max(axis=0)
    beside = ((normals[:, 2:] == 0.0) & (rest < 0.0)).any(axis=0)
    return np.where((top >= bottom) & ~beside, top + place[2], -np.inf)
