"""Bodies and planes as a person adds them to a world, and the checks of their values."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.dem.arrays import Floats
from lithobrake.dem.material import Material
from lithobrake.dem.shape import ConvexHull, Shape

ROUNDING = 1e-9  # of a moment of inertia: what the eigenvalues of a flat plate may be off


@dataclass(frozen=True, eq=False)
class RigidBody:
    """A body as it was added: what never changes of it."""

    shape: Shape
    material: Material
    mass: float  # kg
    inertia: Floats  # kg m2, [3, 3], about the centroid, in the frame the shape was given in

    @cached_property
    def smallest_mass_at_contact(self) -> float:
        """Smallest mass [kg] that a contact force meets: 1/(n . W . n) over the corners of the faces.

        A cube's corner pushed along the normal of one of its faces weighs a quarter of the cube.
        """
        if not isinstance(self.shape, ConvexHull):
            return self.mass
        surface = self.shape.polyhedron
        normals = np.repeat(surface.face_normals[surface.triangle_face], 3, axis=0)
        arms = surface.vertices[surface.triangles.ravel()] - self.shape.centroid
        turns = np.cross(arms, normals)
        turning = np.einsum("ij,ij->i", turns, np.linalg.solve(self.inertia, turns.T).T)
        return float(1.0 / (1.0 / self.mass + turning).max())


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
    tensor = shape.inertia_per_density * (mass / shape.volume) if inertia is None else inertia
    return RigidBody(shape, material, mass, checked_inertia(tensor, "add_body inertia"))


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


def unit(value: ArrayLike, name: str) -> Floats:
    """Return a vector of unit length. Raises ValueError where it has none."""
    array = np.array(value, dtype=np.float64)
    length = float(np.sqrt((array * array).sum()))
    if not 0.0 < length < np.inf:
        raise ValueError(f"{name} is {value!r}; allowed is any finite vector other than zero: change it")
    return array / length
