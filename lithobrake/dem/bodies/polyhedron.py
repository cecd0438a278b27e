"""Convex polyhedra: faces, edges and exact mass properties of a cloud of points."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull as Quickhull
from scipy.spatial import QhullError

# Facets whose unit normals differ by less are one face: far above round-off, far below any angle one would draw.
COPLANAR = 1e-9


@dataclass(frozen=True)
class Polyhedron:
    """A convex polyhedron. Faces are polygons; an edge's two normals satisfy left x right = along the edge."""

    vertices: NDArray[np.float64]  # [vertex_count, 3], m
    face_normals: NDArray[np.float64]  # [face_count, 3], outward unit normals
    face_offsets: NDArray[np.float64]  # [face_count], m: normal . x = offset on the face
    triangles: NDArray[np.int64]  # [triangle_count, 3], counter-clockwise from outside
    triangle_face: NDArray[np.int64]  # [triangle_count], the face a triangle is part of
    edges: NDArray[np.int64]  # [edge_count, 4]: from vertex, to vertex, left face, right face

    @cached_property
    def lines(self) -> NDArray[np.float64]:
        """Where each edge begins and ends [m], [edge_count, 2, 3]."""
        return self.vertices[self.edges[:, :2]]

    @cached_property
    def adjacent_faces(self) -> NDArray[np.int64]:
        """The faces across the edges of each face, face by face, [2 edge_count]."""
        left, right = self.edges[:, 2:].T
        return np.concatenate([right, left])[np.argsort(np.concatenate([left, right]), kind="stable")]

    @cached_property
    def edges_of_face(self) -> NDArray[np.int64]:
        """How many edges each face has, [face_count]."""
        return np.bincount(self.edges[:, 2:].ravel(), minlength=len(self.face_normals))


def single_point() -> Polyhedron:
    """Return a point at the origin: the core of a sphere."""
    none, vectors = np.zeros(0, dtype=np.int64), np.zeros((0, 3))
    return Polyhedron(np.zeros((1, 3)), vectors, np.zeros(0), none.reshape(0, 3), none, none.reshape(0, 4))


def power_of_two_above(value: float) -> float:
    """Return the smallest power of two above a value: dividing by it is exact, so results scale to the last bit."""
    return math.ldexp(1.0, math.frexp(value)[1])


def convex_polyhedron(points: NDArray[np.float64]) -> Polyhedron:
    """Return the convex envelope of points [m], shape [count, 3]; interior points are dropped.

    Raises ValueError for fewer than four points, values that are not finite, or a cloud that encloses no volume.
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 4:
        raise ValueError(
            f"a convex hull needs at least 4 points of 3 coordinates, not an array of shape {points.shape}"
        )
    if not np.isfinite(points).all():
        raise ValueError("a convex hull needs finite points: remove NaN and infinite coordinates")
    # COPLANAR compares normals and offsets alike, which needs coordinates of order one about the origin.
    scale = power_of_two_above(float(np.ptp(points, axis=0).max()))
    origin = points.mean(axis=0)
    scaled = (points - origin) / scale if scale > 0.0 else points
    try:
        hull = Quickhull(scaled)
    except QhullError as error:
        raise ValueError(
            f"the {len(points)} points enclose no volume (they lie in a plane, on a line or together): "
            "give points that span three dimensions"
        ) from error
    index = np.full(len(points), -1)
    index[hull.vertices] = np.arange(len(hull.vertices))
    triangles = _outward(index[hull.simplices], scaled[hull.vertices], hull.equations[:, :3])
    vertices = points[hull.vertices]
    face_of, normals = _merge_coplanar(hull.equations, hull.neighbors)
    # The normal of a merged face is a mean over its facets, so its offset must be one too: the plane then lies amid all
    # corners of the face.
    heights = np.einsum("ijk,ik->i", vertices[triangles], normals[face_of]) / 3.0
    offsets = np.bincount(face_of, heights) / np.bincount(face_of)
    return Polyhedron(vertices, normals, offsets, triangles, face_of, _edges(triangles, face_of, normals, vertices))


def _outward(
    triangles: NDArray[np.int64], vertices: NDArray[np.float64], normals: NDArray[np.float64]
) -> NDArray[np.int64]:
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), normals) < 0.0
    result = triangles.copy()
    result[inward] = result[inward][:, ::-1]
    return result


def _merge_coplanar(
    equations: NDArray[np.float64], neighbours: NDArray[np.int32]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Group facets with the same plane; return the face of each facet and the faces' normals."""
    face_of = np.arange(len(equations))
    # Of a face that is split some facets are neighbours; mostly there is none.
    if (np.abs(equations[neighbours] - equations[:, None]).max(axis=2) < COPLANAR).any():
        face_of[:], faces = -1, 0
        for facet, equation in enumerate(equations):
            if face_of[facet] < 0:
                face_of[(face_of < 0) & (np.abs(equations - equation).max(axis=1) < COPLANAR)] = faces
                faces += 1
    total = np.zeros((face_of.max() + 1, 3))
    np.add.at(total, face_of, equations[:, :3])
    return face_of, total / np.linalg.norm(total, axis=1, keepdims=True)


def _edges(
    triangles: NDArray[np.int64],
    face_of: NDArray[np.int64],
    normals: NDArray[np.float64],
    vertices: NDArray[np.float64],
) -> NDArray[np.int64]:
    """Return the edges between different faces, ordered so that left normal x right normal points from start to end."""
    start, end, face = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel(), np.repeat(face_of, 3)
    # The same edge, from the triangle on its other side: sorted by (end, start) it stands where this one does.
    other = np.empty_like(face)
    other[np.lexsort((end, start))] = face[np.lexsort((start, end))]
    kept = (start < end) & (face != other)
    start, end, face, other = start[kept], end[kept], face[kept], other[kept]
    along = np.einsum("ij,ij->i", np.cross(normals[face], normals[other]), vertices[end] - vertices[start])
    left, right = np.where(along > 0.0, face, other), np.where(along > 0.0, other, face)
    rows: NDArray[np.int64] = np.column_stack([start, end, left, right])
    return rows


@dataclass(frozen=True)
class MassProperties:
    """Volume [m3], centroid [m], shape [3], and inertia about the centroid per unit density [m5], shape [3, 3]."""

    volume: float
    centroid: NDArray[np.float64]
    inertia_per_density: NDArray[np.float64]


def mass_properties(vertices: NDArray[np.float64], triangles: NDArray[np.int64]) -> MassProperties:
    """Integrate 1, x and x x^T over a closed, outward oriented triangle mesh (exact up to round-off).

    Source: [Blow-2004] (signed tetrahedra).
    """
    # About the mean of the vertices: far from the origin the volume would be a small difference of large terms.
    middle = vertices.mean(axis=0)
    corners = (vertices - middle)[triangles]
    six_volumes = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    volume = float(six_volumes.sum() / 6.0)
    total = corners.sum(axis=1)
    centroid = np.einsum("i,ij->j", six_volumes, total) / (24.0 * volume)
    products = np.einsum("ikj,ikl->ijl", corners, corners) + np.einsum("ij,il->ijl", total, total)
    second = np.einsum("i,ijl->jl", six_volumes, products) / 120.0 - volume * np.outer(centroid, centroid)
    inertia = np.trace(second) * np.eye(3) - second
    # `checked_inertia` accepts only tensors that are symmetric to the last bit.
    return MassProperties(volume, centroid + middle, 0.5 * (inertia + inertia.T))
