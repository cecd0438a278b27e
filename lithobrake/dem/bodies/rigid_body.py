"""Bodies and planes as a person adds them to a world, and the checks of their values."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import repeat

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.dem.bodies.arrays import Floats
from lithobrake.dem.bodies.material import Material
from lithobrake.dem.bodies.shape import ConvexHull, Shape

ROUNDING = 1e-9  # of a moment of inertia: what the eigenvalues of a flat plate may be off


@dataclass(frozen=True, eq=False)
class RigidBody:
    """A body as it was added: what never changes of it."""

    shape: Shape
    material: Material
    mass: float  # kg
    inertia: Floats  # kg m2, [3, 3], about the centroid, in the frame the shape was given in
    is_uniform: bool = False  # its mass is known to be spread evenly

    @cached_property
    def smallest_mass_at_contact(self) -> float:
        """Smallest mass [kg] that a contact force meets."""
        if self.is_uniform or not isinstance(self.shape, ConvexHull):
            return self.mass * self.shape.smallest_mass_fraction
        return self.mass * self.shape.mass_fraction(self.inertia / self.mass)


@dataclass(frozen=True, eq=False)
class Plane:
    """A half-space of matter: everything on the far side of the normal. It meets the bodies listed, or all (None)."""

    point: Floats  # m, [3]
    normal: Floats  # [3], unit, out of the matter
    material: Material
    meets: frozenset[int] | None


def new_body(shape: Shape, material: Material, mass: float | None, inertia: ArrayLike | None) -> RigidBody:
    """Return a body; its mass and inertia follow from the material's density unless given.

    Raises ValueError for a mass that is not positive, and for an inertia that no body has.
    """
    if mass is not None and not 0.0 < mass < np.inf:
        raise ValueError(f"add_body mass is {mass!r} kg; allowed is a finite value above 0: change it")
    mass = material.density * shape.volume if mass is None else float(mass)
    if inertia is None:
        return RigidBody(shape, material, mass, shape.inertia_per_density * (mass / shape.volume), is_uniform=True)
    return RigidBody(shape, material, mass, checked_inertia(inertia, "add_body inertia"), is_uniform=False)


def uniform_bodies(shapes: Sequence[Shape], material: Material) -> list[RigidBody]:
    """Return bodies of one material, as new_body makes each."""
    volume = np.array([shape.volume for shape in shapes])
    mass = material.density * volume
    inertia = (
        np.array([shape.inertia_per_density for shape in shapes]).reshape(-1, 3, 3) * (mass / volume)[:, None, None]
    )
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
        raise ValueError(
            f"{name} is {tensor.tolist()} kg m2; allowed is a symmetric positive definite 3 x 3 tensor: mend it"
        )
    if moments[2] > (moments[0] + moments[1]) * (1.0 + ROUNDING):
        raise ValueError(
            f"{name} has the principal moments {', '.join(f'{moment:.6g}' for moment in moments)} kg m2; allowed is "
            "each at most the sum of the other two, as every body has it: mend it"
        )
    return tensor


def vector(value: ArrayLike, name: str) -> Floats:
    """Return three finite numbers. Raises ValueError for anything else."""
    array = np.array(value, dtype=np.float64)
    if array.shape != (3,) or not np.isfinite(array).all():
        raise ValueError(f"{name} is {value!r}; allowed are three finite numbers: change it")
    return array


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
    return units(np.array(value, dtype=np.float64)[None], name)[0]


def units(vectors: Floats, name: str) -> Floats:
    """Return vectors of unit length, [count, 3 or 4]. Raises ValueError where one has none."""
    length = np.sqrt((vectors * vectors).sum(axis=1))
    if not ((length > 0.0) & (length < np.inf)).all():
        wrong = vectors[~((length > 0.0) & (length < np.inf))][0].tolist()
        raise ValueError(f"{name} is {wrong}; allowed is any finite vector other than zero: change it")
    unit: Floats = vectors / length[:, None]
    return unit
