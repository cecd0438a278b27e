"""Shapes of bodies: a convex core, such as a polyhedron, swept by a sphere, with exact mass properties."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import ConvexHull as Quickhull
from scipy.spatial import QhullError

from lithobrake.vocabulary.field_errors import FieldError, field_number, field_numbers

# Facets whose unit normals differ by less are one face: far above round-off, far below any angle one would draw.
COPLANAR = 1e-9
# Rounding radius over the distance from the centroid to the nearest face.
ROUNDING_FRACTION = 0.02


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


class Shape(Protocol):
    """What a world needs to know of a shape."""

    @property
    def volume(self) -> float: ...  # m3
    @property
    def centroid(self) -> NDArray[np.float64]: ...  # m, [3], in the frame the shape was given in
    @property
    def inertia_per_density(self) -> NDArray[np.float64]: ...  # m5, [3, 3], about the centroid
    @property
    def rounding(self) -> float: ...  # m
    @property
    def core(self) -> NDArray[np.float64]: ...  # m, [vertex_count, 3], about the centroid
    @property
    def core_polyhedron(self) -> Polyhedron: ...  # the same, with its faces and edges
    @property
    def bounding_radius(self) -> float: ...  # m, about the centroid
    @property
    def contact_radius(self) -> float: ...  # m, of the sphere of equal volume: enters Hertz' law
    @property
    def smallest_mass_fraction(self) -> float: ...  # of a uniform body's mass, that a contact force meets
    def mass_fraction(self, inertia_per_mass: NDArray[np.float64], centre: NDArray[np.float64]) -> float: ...


class Sphere:
    """A sphere of a given radius [m] about a centre [m], shape [3].

    Raises ValueError unless the radius is finite and positive, and the centre finite.
    """

    def __init__(self, radius: float, centre: ArrayLike = (0.0, 0.0, 0.0)) -> None:
        self.radius = field_number("Sphere.radius", radius, "is a finite value above 0", "m", above=0.0)
        self.volume = 4.0 / 3.0 * math.pi * self.radius**3
        self.centroid = np.array(field_numbers("Sphere.centre", centre, 3, "are three finite numbers", "m"))
        self.inertia_per_density = 0.4 * self.volume * self.radius**2 * np.eye(3)
        self.rounding = self.radius
        self.core_polyhedron = single_point()
        self.core = self.core_polyhedron.vertices
        self.bounding_radius = self.radius
        self.contact_radius = self.radius
        # About its own centre, which every push on a ball passes through.
        self.smallest_mass_fraction = 1.0

    def mass_fraction(self, inertia_per_mass: NDArray[np.float64], centre: NDArray[np.float64]) -> float:
        """Return the part of a mass that a contact force meets at least, see ConvexHull.mass_fraction."""
        # A ball can be pushed along any direction, always through its own centre: the largest eigenvalue is that of the
        # worst direction.
        x, y, z = self.centroid - centre
        arm = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
        return float(1.0 / (1.0 + np.linalg.eigvalsh(arm.T @ np.linalg.solve(inertia_per_mass, arm))[-1]))


class ConvexHull:
    """The convex envelope of points [m], shape [count, 3].

    Raises ValueError for a cloud that is flat, has fewer than four distinct points, or is not finite.
    """

    def __init__(self, vertices: ArrayLike) -> None:
        self.given = np.array(vertices, dtype=np.float64)
        self.polyhedron: Polyhedron = convex_polyhedron(self.given)
        self._mass: MassProperties = mass_properties(self.polyhedron.vertices, self.polyhedron.triangles)
        self.volume = self._mass.volume
        self.centroid = self._mass.centroid
        self.inertia_per_density = self._mass.inertia_per_density

    @property
    def vertices(self) -> NDArray[np.float64]:
        """Vertices of the envelope [m], shape [vertex_count, 3], in the frame they were given in."""
        return self.polyhedron.vertices

    @property
    def triangles(self) -> NDArray[np.int64]:
        """Triangles of the surface, shape [triangle_count, 3], counter-clockwise from outside."""
        return self.polyhedron.triangles

    @cached_property
    def rounding(self) -> float:
        """Rounding radius of edges and corners [m]."""
        heights = self.polyhedron.face_offsets - self.polyhedron.face_normals @ self.centroid
        return ROUNDING_FRACTION * float(heights.min())

    @cached_property
    def core_polyhedron(self) -> Polyhedron:
        """The polyhedron inside the rounding, about the centroid: each vertex stands that far behind its own faces."""
        given = self.polyhedron
        corners = np.column_stack([given.triangles.ravel(), np.repeat(given.triangle_face, 3)])
        vertex, face = np.unique(corners, axis=0).T
        count = np.bincount(vertex)
        place = np.arange(len(vertex)) - np.repeat(np.cumsum(count) - count, count)
        normals, there = np.zeros((len(count), count.max(), 3)), np.zeros((len(count), count.max(), 1))
        normals[vertex, place], there[vertex, place] = given.face_normals[face], 1.0
        # Least squares: where more than three faces meet, they may not after each has moved.
        core = given.vertices - self.centroid - self.rounding * (np.linalg.pinv(normals) @ there)[:, :, 0]
        return convex_polyhedron(core)

    @property
    def core(self) -> NDArray[np.float64]:
        """Vertices of the core [m], shape [core_vertex_count, 3], about the centroid."""
        return self.core_polyhedron.vertices

    @cached_property
    def bounding_radius(self) -> float:
        """Radius of a sphere about the centroid that holds the rounded body [m]."""
        return float(np.linalg.norm(self.core, axis=1).max()) + self.rounding

    @cached_property
    def contact_radius(self) -> float:
        """Radius of the sphere of equal volume [m]."""
        return equivalent_radius(self)

    @cached_property
    def smallest_mass_fraction(self) -> float:
        """Part of its mass, spread evenly, that a contact force meets at least."""
        return self.mass_fraction(self.inertia_per_density / self.volume, self.centroid)

    def mass_fraction(self, inertia_per_mass: NDArray[np.float64], centre: NDArray[np.float64]) -> float:
        """Return the part of a mass that a contact force meets at least, with an inertia over mass [m2, 3 x 3] about a
        centre of mass [m], shape [3], in the frame the shape was given in.

        1/(1 + m n . W . n) over the corners of the faces: a cube's corner pushed along the normal of one of its faces
        weighs a quarter of the cube.
        """
        surface = self.polyhedron
        normals = np.repeat(surface.face_normals[surface.triangle_face], 3, axis=0)
        arms = surface.vertices[surface.triangles.ravel()] - centre
        turns = np.cross(arms, normals)
        turning = np.einsum("ij,ij->i", turns, np.linalg.solve(inertia_per_mass, turns.T).T)
        return float(1.0 / (1.0 + turning.max()))


class Box(ConvexHull):
    """A box with three edge lengths [m], its centroid at the origin."""

    def __init__(self, lengths: Sequence[float]) -> None:
        if len(lengths) != 3 or not all(0.0 < length < math.inf for length in lengths):
            raise FieldError("Box.lengths", tuple(lengths), "are three finite values above 0", "change them", "m")
        self.lengths = tuple(float(length) for length in lengths)
        signs = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
        super().__init__(signs * np.array(self.lengths))


def equivalent_radius(shape: Shape) -> float:
    """Return the radius of the sphere of equal volume [m]: the radius that enters Hertz' law."""
    if isinstance(shape, Sphere):
        return shape.radius
    # Split off whole powers of eight, so that a shape twice as large has a radius exactly twice as large.
    mantissa, exponent = math.frexp(3.0 * shape.volume / (4.0 * math.pi))
    doublings, rest = divmod(exponent, 3)
    return math.ldexp(math.cbrt(math.ldexp(mantissa, rest)), doublings)
