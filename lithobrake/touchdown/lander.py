"""The lander: a rigid convex body."""

import os
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem import Box, ConvexHull, Material, Sphere, checked_inertia
from lithobrake.geometry.mesh import refuse_malformed
from lithobrake.geometry.mesh_files import read_mesh

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Lander:
    """A rigid convex body with a mass [kg] and an inertia [kg m2, 3 x 3, about its centroid; None: homogeneous].

    Raises ValueError for a mass that is not positive, and for an inertia that no body has.
    """

    shape: Sphere | Box | ConvexHull
    mass: float
    material: Material
    inertia: Floats | None = None

    def __post_init__(self) -> None:
        if not 0.0 < self.mass < np.inf:
            raise ValueError(f"Lander.mass is {self.mass!r} kg; allowed is a finite value above 0: change it")
        if self.inertia is not None:
            checked_inertia(self.inertia, "Lander.inertia")

    @cached_property
    def smallest_edge(self) -> float:
        """Smallest extent of the body [m]: the shortest edge of a box, the least width of a hull across a face."""
        if isinstance(self.shape, Box):
            return min(self.shape.lengths)
        if isinstance(self.shape, Sphere):
            return 2.0 * self.shape.radius
        heights = self.shape.polyhedron.face_normals @ self.shape.vertices.T
        return float((heights.max(axis=1) - heights.min(axis=1)).min())

    def lowest(self, position: Floats, rotation: Floats) -> float:
        """Return the height [m] of the lowest point of the body at a position and rotation matrix, body to world."""
        if isinstance(self.shape, Sphere):
            return float(position[2]) - self.shape.radius
        return float(position[2] + ((self.shape.vertices - self.shape.centroid) @ rotation[2]).min())


def read_hull(path: str | os.PathLike[str], unit: str = "m") -> ConvexHull:
    """Return the convex envelope of a closed OBJ or STL mesh whose coordinates are in `unit` (m, km, cm, mm).

    The mesh may have several pieces, say solar panels. Raises ValueError for one that is not closed or cannot be read.
    """
    vertices, faces = read_mesh(path, unit)
    refuse_malformed(vertices, faces, f"lander mesh {path}")
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forward = {(a, b) for a, b in edges.tolist()}
    if len(forward) != len(edges) or any((b, a) not in forward for a, b in forward):
        raise ValueError(f"lander mesh {path} is not closed, or its triangles turn both ways: mend it in a mesh editor")
    # Vertices that no face uses are not of the lander.
    return ConvexHull(vertices[np.unique(faces)])
