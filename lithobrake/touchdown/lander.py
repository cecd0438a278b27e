"""The lander: a rigid convex body."""

import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem import Box, ConvexHull, Material, Sphere

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, eq=False)
class Lander:
    """A rigid convex body with a mass [kg] and an inertia [kg m2, 3 x 3, about its centroid; None: homogeneous]."""

    shape: Sphere | Box | ConvexHull
    mass: float
    material: Material
    inertia: Floats | None = None

    @property
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


def read_hull(path: str | os.PathLike[str]) -> ConvexHull:
    """Return the convex envelope of a closed OBJ or STL mesh with coordinates in metres.

    Raises ValueError for a mesh that is not closed, has no triangles, or is of another format.
    """
    name = os.fspath(path).lower()
    with open(path, "rb") as file:
        content = file.read()
    if name.endswith(".obj"):
        vertices, triangles = _read_obj(content.decode("utf-8", "replace"), path)
    elif name.endswith(".stl"):
        vertices, triangles = _read_stl(content, path)
    else:
        raise ValueError(f"lander mesh {path} has an unknown ending; allowed are .obj and .stl: convert it")
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    forward = {(int(a), int(b)) for a, b in edges}
    if len(triangles) < 4 or len(forward) != len(edges) or any((b, a) not in forward for a, b in forward):
        raise ValueError(f"lander mesh {path} is not closed, or its triangles turn both ways: mend it in a mesh editor")
    return ConvexHull(vertices)


def _read_obj(text: str, path: object) -> tuple[Floats, NDArray[np.int64]]:
    """Read vertices and faces of an OBJ file; polygons are cut into fans."""
    vertices, triangles = [], []
    for line in text.splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            index = [int(word.split("/")[0]) for word in words[1:]]
            index = [i - 1 if i > 0 else len(vertices) + i for i in index]
            triangles += [[index[0], index[k], index[k + 1]] for k in range(1, len(index) - 1)]
    if not triangles:
        raise ValueError(f"lander mesh {path} has no faces: export it with faces")
    return np.array(vertices), np.array(triangles)


def _read_stl(content: bytes, path: object) -> tuple[Floats, NDArray[np.int64]]:
    """Read an STL file, text or binary, joining corners with equal coordinates."""
    record = np.dtype([("normal", "<f4", 3), ("corner", "<f4", (3, 3)), ("attribute", "<u2")])
    count = int.from_bytes(content[80:84], "little")
    if len(content) == 84 + count * record.itemsize:
        corners = np.frombuffer(content, record, count, 84)["corner"].reshape(-1, 3).astype(np.float64)
    else:
        words = content.decode("utf-8", "replace").split()
        starts = [k for k, word in enumerate(words) if word == "vertex"]
        corners = np.array([[float(word) for word in words[k + 1 : k + 4]] for k in starts]).reshape(-1, 3)
    if len(corners) == 0 or len(corners) % 3:
        raise ValueError(f"lander mesh {path} has no whole triangles: export it again as STL")
    vertices, index = np.unique(corners, axis=0, return_inverse=True)
    return vertices, index.reshape(-1, 3)
