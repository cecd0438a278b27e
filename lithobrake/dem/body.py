"""From what a person adds to a world to the arrays that kernels work on."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.dem.arrays import Bodies, Cores, Floats, Integers, Laws, Planes
from lithobrake.dem.material import Material, pair_law
from lithobrake.dem.motion import write_matrices, write_rotations
from lithobrake.dem.shape import ConvexHull, Shape, Sphere, equivalent_radius

ROUNDING = 1e-9  # of a moment of inertia: what the eigenvalues of a flat plate may be off


@dataclass(frozen=True, eq=False)
class Body:
    """A body as it was added: what never changes of it."""

    shape: Shape
    material: Material
    mass: float  # kg
    inertia: Floats  # kg m2, [3, 3], about the centroid, in the frame the shape was given in


@dataclass(frozen=True, eq=False)
class Plane:
    """A half-space of matter: everything on the far side of the normal. It meets the bodies listed, or all (None)."""

    point: Floats  # m, [3]
    normal: Floats  # [3], unit, out of the matter
    material: Material
    meets: frozenset[int] | None


def new_body(shape: Shape, material: Material, mass: float | None, inertia: ArrayLike | None) -> Body:
    """Return a body; its mass and inertia follow from the material's density unless given.

    Raises ValueError for a mass that is not positive, and for an inertia that no body has.
    """
    if mass is not None and not 0.0 < mass < np.inf:
        raise ValueError(f"add_body mass is {mass!r} kg; allowed is a finite value above 0: change it")
    mass = material.density * shape.volume if mass is None else float(mass)
    tensor = shape.inertia_per_density * (mass / shape.volume) if inertia is None else inertia
    return Body(shape, material, mass, checked_inertia(tensor, "add_body inertia"))


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


def rotation_matrices(quaternions: Floats) -> Floats:
    """Return the rotation matrices [count, 3, 3], body to world, of unit quaternions w, x, y, z, shape [count, 4]."""
    rotation = np.zeros((len(quaternions), 3, 3))
    write_rotations(quaternions, rotation)
    return rotation


def cores_of(shapes: list[Shape]) -> Cores:
    """Lay the convex cores of shapes one after the other."""
    vertex, normal, offset, edge, line, adjacent_face = [], [], [], [], [], []
    for shape in shapes:
        vertex.append(shape.core)
        if isinstance(shape, ConvexHull):
            core = shape.core_polyhedron
            normal.append(core.face_normals)
            offset.append(core.face_offsets)
            edge.append(core.edges)
            line.append(shape.core[core.edges[:, :2]])
            adjacent_face += [adjacent_faces(core.edges, face) for face in range(len(core.face_normals))]
        else:
            normal.append(np.zeros((0, 3)))
            offset.append(np.zeros(0))
            edge.append(np.zeros((0, 4), dtype=np.int64))

    def starts(parts: list) -> np.ndarray:
        return np.concatenate([[0], np.cumsum([len(part) for part in parts])]).astype(np.int64)

    ends = np.concatenate([np.zeros((0, 2, 3)), *line])
    no_face = np.zeros(0, dtype=np.int64)
    return Cores(
        np.concatenate(vertex), starts(vertex), np.concatenate(normal), np.concatenate(offset), starts(normal),
        np.concatenate(edge), starts(edge), ends[:, 0].copy(), ends[:, 1] - ends[:, 0],
        np.concatenate([no_face, *adjacent_face]), starts(adjacent_face),
        np.array([shape.rounding for shape in shapes]),
    )  # fmt: skip


def adjacent_faces(edges: Integers, face: int) -> Integers:
    """Return the faces across the edges [edge_count, 4] of a face."""
    return np.concatenate([edges[edges[:, 2] == face, 3], edges[edges[:, 3] == face, 2]])


def laws_of(materials: list[Material], shear_modulus_rule: str, pair_rule: str) -> Laws:
    """Return the laws of all pairs of materials."""
    table = np.array([[pair_law(a, b, shear_modulus_rule, pair_rule) for b in materials] for a in materials])
    return Laws(*(np.ascontiguousarray(table[:, :, k]) for k in range(table.shape[2])))


def planes_of(planes: list[Plane], materials: list[Material], body_count: int) -> Planes:
    """Return planes as arrays."""
    meets = np.ones((len(planes), body_count), dtype=np.bool_)
    for k, plane in enumerate(planes):
        if plane.meets is not None:
            meets[k] = np.isin(np.arange(body_count), list(plane.meets))
    normal = np.array([plane.normal for plane in planes]).reshape(-1, 3)
    offset = np.array([plane.normal @ plane.point for plane in planes])
    return Planes(normal, offset, np.array([materials.index(p.material) for p in planes], dtype=np.int64), meets)


def inverse_inertias(bodies: list[Body]) -> NDArray[Any]:
    """Return the inverses of the inertias of bodies [1/(kg m2)], shape [body_count, 3, 3], body frame."""
    return np.linalg.inv(np.array([body.inertia for body in bodies]).reshape(-1, 3, 3))


def bodies_of(bodies: list[Body], shapes: list[Shape], materials: list[Material], state: dict[str, Floats]) -> Bodies:
    """Return bodies as arrays, in a state of position, velocity, quaternion and angular_momentum."""
    n, bounding = len(bodies), np.array([body.shape.bounding_radius for body in bodies])
    shape_of = {id(shape): k for k, shape in enumerate(shapes)}
    arrays = Bodies(
        shape=np.array([shape_of[id(body.shape)] for body in bodies], dtype=np.int64),
        material=np.array([materials.index(body.material) for body in bodies], dtype=np.int64),
        mass=np.array([body.mass for body in bodies]), inverse_mass=np.array([1.0 / body.mass for body in bodies]),
        inverse_inertia_body=inverse_inertias(bodies),
        isotropic=np.array([np.array_equal(body.inertia, body.inertia[0, 0] * np.eye(3)) for body in bodies]),
        contact_radius=np.array([equivalent_radius(body.shape) for body in bodies]),
        curvature=np.array([1.0 / equivalent_radius(body.shape) for body in bodies]),
        bounding_radius=bounding, turning_radius=np.where([isinstance(b.shape, Sphere) for b in bodies], 0.0, bounding),
        position=state["position"], velocity=state["velocity"], quaternion=state["quaternion"],
        angular_momentum=state["angular_momentum"], rotation=np.zeros((n, 3, 3)), inverse_inertia=np.zeros((n, 3, 3)),
        force=np.zeros((n, 3)), torque=np.zeros((n, 3)), half_spin=np.zeros((n, 3)),
        velocity_predicted=np.zeros((n, 3)), spin_predicted=np.zeros((n, 3)),
        rates=np.zeros((n, 2)), dragged=np.zeros(n), travel=np.zeros(n), travel_listed=np.zeros(n),
    )  # fmt: skip
    write_matrices(arrays)
    return arrays
