"""Materials, bodies and planes as a person gives them to a world, and the checks of their values."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import repeat
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.dem.bodies.shape import ConvexHull, Shape, Sphere
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.field_errors import FieldError, field_number, field_numbers
from lithobrake.vocabulary.material_properties import Material

Offset = tuple[float, ...]
AT_CENTRE: Offset = (0.0, 0.0, 0.0)
ROUNDING = 1e-9  # of a moment of inertia: what the eigenvalues of a flat plate may be off


@dataclass(frozen=True, eq=False)
class Part:
    """A convex part of a body: its shape, in the frame of the body's own, and what it is made of."""

    shape: Shape
    material: Material

    @property
    def mass(self) -> float:
        """Mass [kg] by the density of its material."""
        return self.material.density * self.shape.volume


class PlacedPart(NamedTuple):
    shape: Shape
    material: Material
    offset: Offset  # m, from the centre of mass of the body to the centroid of the shape, frame of the shape


@dataclass(frozen=True, eq=False)
class RigidBody:
    """A body as it was added: what never changes of it. It has one part of its own, and may have others."""

    shape: Shape
    material: Material
    mass: float  # kg
    inertia: Floats  # kg m2, [3, 3], about the centre of mass, in the frame the shape was given in
    is_uniform: bool = False  # its mass is known to be spread evenly
    others: tuple[Part, ...] = ()
    centre: Floats | None = None  # m, [3], of mass, in the frame the shape was given in; None: the shape's centroid

    @property
    def centre_of_mass(self) -> Floats:
        """Centre of mass [m], shape [3], in the frame the shape was given in."""
        return self.shape.centroid if self.centre is None else self.centre

    @property
    def is_plain(self) -> bool:
        """Whether it is one convex part about its centroid."""
        return not self.others and self.centre is None

    @cached_property
    def parts(self) -> tuple[PlacedPart, ...]:
        """Its parts, its own first."""
        if self.is_plain:
            return (PlacedPart(self.shape, self.material, AT_CENTRE),)
        return tuple(
            PlacedPart(part.shape, part.material, tuple((part.shape.centroid - self.centre_of_mass).tolist()))
            for part in (Part(self.shape, self.material), *self.others)
        )

    @cached_property
    def bounding_radius(self) -> float:
        """Radius of a sphere about the centre of mass that holds the rounded body [m]."""
        return max(placed_radius(part) for part in self.parts)

    @property
    def turning_radius(self) -> float:
        """Arm at which a spin moves the surface [m]: 0 for a ball about its centre, which looks the same."""
        if self.is_plain:
            return 0.0 if isinstance(self.shape, Sphere) else self.shape.bounding_radius
        # A ball off the centre of mass is carried round with its centre, but its own turning moves none of its surface.
        return max(placed_radius(part) - isinstance(part.shape, Sphere) * part.shape.rounding for part in self.parts)

    @property
    def surface_mobility(self) -> float:
        """Largest square of the speed of a point of its surface over twice the energy of its turning [1/kg].

        A point at r moves by spin x r: for a spin of the energy 1/2 J.I^-1.J this is largest for an eigenvector of
        R I^-1 R^T, with the matrix R of that product.
        """
        inverse, found = np.linalg.inv(self.inertia), [0.0]
        for part in self.parts:
            arms = part.shape.core + np.array(part.offset)
            # The rounding of a hull lies farther out; a ball that turns about its own centre moves no surface.
            rounding = 0.0 if isinstance(part.shape, Sphere) else part.shape.rounding
            across = np.cross(np.eye(3)[None], arms[:, None, :])
            squares = np.linalg.eigvalsh(np.transpose(across, (0, 2, 1)) @ inverse @ across)[:, -1]
            length = np.linalg.norm(arms, axis=1)
            found += list(squares * ((length + rounding) / np.maximum(length, 1e-300)) ** 2)
        return float(max(found))

    @cached_property
    def smallest_masses_at_contact(self) -> tuple[float, ...]:
        """Smallest mass [kg] that a contact force meets on each part."""
        # A push on a plain ball passes through its centre, whatever its inertia; for a uniform hull the fraction
        # depends on the shape alone, which keeps it for all bodies that share it.
        if self.is_plain and (self.is_uniform or not isinstance(self.shape, ConvexHull)):
            return (self.mass * self.shape.smallest_mass_fraction,)
        per_mass, centre = self.inertia / self.mass, self.centre_of_mass
        return tuple(self.mass * part.shape.mass_fraction(per_mass, centre) for part in self.parts)


def placed_radius(part: PlacedPart) -> float:
    """Return the radius of a sphere about the centre of mass of its body that holds a part [m]."""
    if part.offset == AT_CENTRE:
        return part.shape.bounding_radius
    return float(np.linalg.norm(part.shape.core + np.array(part.offset), axis=1).max()) + part.shape.rounding


@dataclass(frozen=True, eq=False)
class Plane:
    """A half-space of matter: everything on the far side of the normal. It meets the bodies listed, or all (None)."""

    point: Floats  # m, [3]
    normal: Floats  # [3], unit, out of the matter
    material: Material
    meets: frozenset[int] | None


def new_body(
    shape: Shape, material: Material, mass: float | None, inertia: ArrayLike | None, others: Sequence[Part] = (),
    centre_of_mass: ArrayLike | None = None,
) -> RigidBody:  # fmt: skip
    """Return a body; what is not given of its mass, centre of mass and inertia follows from the materials' densities.

    Raises ValueError for a mass that is not positive, a centre that is not finite, and an inertia that no body has.
    """
    if not hasattr(shape, "inertia_per_density"):
        raise FieldError("add_body shape", shape, "is a Sphere, a ConvexHull or another shape of dem")
    if not isinstance(material, Material):
        raise FieldError("add_body material", material, "is a Material")
    if mass is not None:
        field_number("add_body mass", mass, "is a finite value above 0", "kg", above=0.0)
    centre = None if centre_of_mass is None else vector(centre_of_mass, "add_body centre_of_mass")
    if others or centre is not None:
        return _body_of_parts((Part(shape, material), *others), mass, inertia, centre)
    mass = material.density * shape.volume if mass is None else float(mass)
    if inertia is None:
        return RigidBody(shape, material, mass, shape.inertia_per_density * (mass / shape.volume), is_uniform=True)
    return RigidBody(shape, material, mass, checked_inertia(inertia, "add_body inertia"), is_uniform=False)


def _body_of_parts(
    parts: tuple[Part, ...], mass: float | None, inertia: ArrayLike | None, centre: Floats | None
) -> RigidBody:
    """Return a body of several parts, or with its centre of mass off the centroid.

    Where the centre alone is given, the inertia about it is that of the homogeneous parts about their own.
    """
    whole = sum_of_parts([(part.shape, part.mass) for part in parts])
    mass = whole.mass if mass is None else float(mass)
    centre = whole.centre if centre is None else centre
    tensor = whole.inertia * (mass / whole.mass) if inertia is None else checked_inertia(inertia, "add_body inertia")
    return RigidBody(parts[0].shape, parts[0].material, mass, tensor, False, parts[1:], centre)


class Assembly(NamedTuple):
    mass: float  # kg
    centre: Floats  # m, [3], of mass
    inertia: Floats  # kg m2, [3, 3], about that


def inertia_about(body: RigidBody | Assembly, arm: Floats) -> Floats:
    """Return the inertia of a body [kg m2, 3 x 3] about a point at an arm [m] from its centre of mass.

    Source: [Landau-1976], section 32.
    """
    return body.inertia + body.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))


def sum_of_parts(parts: Sequence[tuple[Shape, float]]) -> Assembly:
    """Return mass, centre of mass and inertia of homogeneous parts, each a shape and its mass [kg].

    All shapes are given in one frame; where parts overlap, the mass of both is there.
    """
    mass = sum(mass for _, mass in parts)
    centre = sum((mass * shape.centroid for shape, mass in parts), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for shape, own in parts:
        part = Assembly(own, shape.centroid, shape.inertia_per_density * (own / shape.volume))
        inertia += inertia_about(part, part.centre - centre)
    return Assembly(mass, centre, inertia)


def rest_of(whole: Assembly, taken: Sequence[Assembly]) -> Assembly:
    """Return what is left of a body when others are taken off it, all given in one frame.

    Its inertia need not be one that a body has.
    """
    mass = whole.mass - sum(one.mass for one in taken)
    moment = whole.mass * whole.centre - sum((one.mass * one.centre for one in taken), np.zeros(3))
    centre = moment / mass
    inertia = np.zeros((3, 3))
    for sign, one in ((1.0, whole), *((-1.0, one) for one in taken)):
        inertia += sign * inertia_about(one, one.centre - centre)
    return Assembly(mass, centre, 0.5 * (inertia + inertia.T))


def uniform_bodies(shapes: Sequence[Shape], material: Material) -> list[RigidBody]:
    """Return bodies of one material, as new_body makes each."""
    volume = np.array([shape.volume for shape in shapes])
    # The operations are those of `new_body` in the same order, so both ways give the same bits.
    mass = material.density * volume
    inertia = (
        np.array([shape.inertia_per_density for shape in shapes]).reshape(-1, 3, 3) * (mass / volume)[:, None, None]
    )
    # `repeat` has no end, so the lengths cannot be compared.
    return [
        RigidBody(*one, is_uniform=True) for one in zip(shapes, repeat(material), mass.tolist(), inertia, strict=False)
    ]


def checked_inertia(inertia: ArrayLike, name: str) -> Floats:
    """Return an inertia [kg m2, 3 x 3]. Raises ValueError for one that no body has; `name` says whose it is.

    Mass anywhere adds at most as much to one principal moment as to the other two together; a flat plate reaches that.
    """
    tensor = np.array(inertia, dtype=float)
    symmetric = tensor.shape == (3, 3) and np.isfinite(tensor).all() and np.array_equal(tensor, tensor.T)
    moments = np.linalg.eigvalsh(tensor) if symmetric else np.zeros(3)
    if moments[0] <= 0.0:
        raise FieldError(name, tensor.tolist(), "is a symmetric positive definite 3 x 3 tensor", "mend it", "kg m2")
    if moments[2] > (moments[0] + moments[1]) * (1.0 + ROUNDING):
        shown = ", ".join(f"{moment:.6g}" for moment in moments)
        raise FieldError(
            name, tensor.tolist(),
            f"are principal moments each at most the sum of the other two, as every body has it, and not {shown}",
            "mend it", "kg m2",
        )  # fmt: skip
    return tensor


def vector(value: ArrayLike, name: str) -> Floats:
    """Return three finite numbers. Raises ValueError for anything else."""
    return np.array(field_numbers(name, value, 3, "are three finite numbers"))


def rows(value: ArrayLike, width: int, count: int, name: str) -> Floats:
    """Return finite numbers, [count, width]. Raises ValueError for anything else."""
    array = np.array(value, dtype=np.float64)
    if array.shape != (count, width) or not np.isfinite(array).all():
        raise ValueError(
            f"add_bodies {name} has shape {array.shape}; allowed are finite numbers in {(count, width)}, one row a "
            "shape: change it"
        )
    return array


def unit(value: ArrayLike, name: str) -> Floats:
    """Return a vector of unit length. Raises ValueError where it has none."""
    allowed = "is any finite vector other than zero"
    array = np.array(field_numbers(name, value, np.size(value), allowed))
    # Over the largest part, as the squares of very large and very small ones would be infinite or 0.
    largest = float(np.abs(array).max(initial=0.0))
    if largest == 0.0:
        raise FieldError(name, value, allowed)
    return units((array if 1e-100 < largest < 1e100 else array / largest)[None], name)[0]


def units(vectors: Floats, name: str) -> Floats:
    """Return vectors of unit length, [count, 3 or 4]. Raises ValueError where one has none."""
    length = np.sqrt((vectors * vectors).sum(axis=1))
    # Stated as what is allowed: NaN fails every comparison, so it would pass a test for what is not.
    if not ((length > 0.0) & (length < np.inf)).all():
        wrong = vectors[~((length > 0.0) & (length < np.inf))][0].tolist()
        raise FieldError(name, wrong, "is any finite vector other than zero")
    unit: Floats = vectors / length[:, None]
    return unit
