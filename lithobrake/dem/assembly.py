"""From what a person adds to a world to the arrays that kernels work on."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem.arrays import Bodies, Cores, Floats, Integers, Laws, Planes
from lithobrake.dem.material import Material, pair_law
from lithobrake.dem.motion import write_matrices, write_rotations
from lithobrake.dem.rigid_body import Plane, RigidBody
from lithobrake.dem.shape import ConvexHull, Shape, Sphere, equivalent_radius


def shapes_of(bodies: list[RigidBody]) -> list[Shape]:
    """Return the shapes of bodies, each once."""
    return list({id(body.shape): body.shape for body in bodies}.values())


def shape_numbers(bodies: list[RigidBody], shapes: list[Shape]) -> Integers:
    """Return which of the shapes each body has, shape [body_count]."""
    number = {id(shape): k for k, shape in enumerate(shapes)}
    return np.array([number[id(body.shape)] for body in bodies], dtype=np.int64)


def materials_of(bodies: list[RigidBody], planes: list[Plane]) -> list[Material]:
    """Return the materials of bodies and planes, each once."""
    return list(dict.fromkeys([body.material for body in bodies] + [plane.material for plane in planes]))


def material_numbers(made: list[RigidBody] | list[Plane], materials: list[Material]) -> Integers:
    """Return which of the materials each body or plane is made of."""
    return np.array([materials.index(one.material) for one in made], dtype=np.int64)


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
            adjacent_face += core.adjacent_faces
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
    return Planes(normal, offset, material_numbers(planes, materials), meets)


def inverse_inertias(bodies: list[RigidBody]) -> NDArray[Any]:
    """Return the inverses of the inertias of bodies [1/(kg m2)], shape [body_count, 3, 3], body frame."""
    return np.linalg.inv(np.array([body.inertia for body in bodies]).reshape(-1, 3, 3))


def bodies_of(
    bodies: list[RigidBody], shapes: list[Shape], materials: list[Material], motion: dict[str, Floats]
) -> Bodies:
    """Return bodies as arrays, in a motion of position, velocity, quaternion and angular_momentum."""
    n, bounding = len(bodies), np.array([body.shape.bounding_radius for body in bodies])
    arrays = Bodies(
        shape=shape_numbers(bodies, shapes),
        material=material_numbers(bodies, materials),
        mass=np.array([body.mass for body in bodies]), inverse_mass=np.array([1.0 / body.mass for body in bodies]),
        inverse_inertia_body=inverse_inertias(bodies),
        isotropic=np.array([np.array_equal(body.inertia, body.inertia[0, 0] * np.eye(3)) for body in bodies]),
        contact_radius=np.array([equivalent_radius(body.shape) for body in bodies]),
        curvature=np.array([1.0 / equivalent_radius(body.shape) for body in bodies]),
        bounding_radius=bounding, turning_radius=np.where([isinstance(b.shape, Sphere) for b in bodies], 0.0, bounding),
        position=motion["position"], velocity=motion["velocity"], quaternion=motion["quaternion"],
        angular_momentum=motion["angular_momentum"], rotation=np.zeros((n, 3, 3)), inverse_inertia=np.zeros((n, 3, 3)),
        force=np.zeros((n, 3)), torque=np.zeros((n, 3)), half_spin=np.zeros((n, 3)),
        velocity_predicted=np.zeros((n, 3)), spin_predicted=np.zeros((n, 3)),
        rates=np.zeros((n, 2)), dragged=np.zeros(n), travel=np.zeros(n), travel_listed=np.zeros(n),
    )  # fmt: skip
    write_matrices(arrays)
    return arrays
