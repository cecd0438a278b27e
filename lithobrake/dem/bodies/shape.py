"""Shapes a body can have: each is a convex core swept by a sphere, and has exact mass properties of its own.

A hull's core is the given polyhedron with every face moved inward by the rounding radius; sweeping the sphere along it
gives the body its faces back and only its edges and corners are rounded. A sphere's core is a point. Rounding changes
contact, never mass properties.
"""

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.dem.bodies.polyhedron import (
    MassProperties,
    Polyhedron,
    convex_polyhedron,
    mass_properties,
    single_point,
)

# Rounding radius over the distance from the centroid to the nearest face.
ROUNDING_FRACTION = 0.02


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
        if not 0.0 < radius < math.inf:
            raise ValueError(f"Sphere radius is {radius!r} m; allowed is a finite value above 0: change it")
        self.radius = float(radius)
        self.volume = 4.0 / 3.0 * math.pi * self.radius**3
        self.centroid = np.array(centre, dtype=np.float64)
        if self.centroid.shape != (3,) or not np.isfinite(self.centroid).all():
            raise ValueError(f"Sphere centre is {centre!r} m; allowed are three finite numbers: change it")
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
            raise ValueError(
                f"Box lengths are {tuple(lengths)!r} m; allowed are three finite values above 0: change them"
            )
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
