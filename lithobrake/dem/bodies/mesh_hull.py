"""The convex envelope of a mesh that a file has."""

import os

import numpy as np

from lithobrake.dem.bodies.shape import ConvexHull
from lithobrake.geometry.mesh import refuse_malformed
from lithobrake.geometry.mesh_files import read_mesh


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
