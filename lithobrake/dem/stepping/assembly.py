"""From what a person adds to a world to the arrays that kernels work on."""

from dataclasses import replace

import numpy as np

from lithobrake.dem.bodies.arrays import Bodies, Cores, Floats, Integers, Laws, Period, Planes
from lithobrake.dem.bodies.material import Material
from lithobrake.dem.bodies.motion import write_matrices, write_rotations
from lithobrake.dem.bodies.polyhedron import Polyhedron
from lithobrake.dem.bodies.rigid_body import AT_CENTRE, Offset, PlacedPart, Plane, RigidBody
from lithobrake.dem.bodies.shape import Shape
from lithobrake.dem.law.material_pair import pair_law

# A shape and where its centroid stands from the centre of mass [m], frame of the shape.
PlacedShape = tuple[Shape, Offset]


def parts_of(bodies: list[RigidBody]) -> list[PlacedPart]:
    """Return the parts of all bodies, body by body."""
    return [part for body in bodies for part in body.parts]


def part_starts(bodies: list[RigidBody]) -> Integers:
    """Return where the parts of each body begin among those of all, and how many there are, shape [body_count + 1]."""
    return np.cumsum([0, *(len(body.parts) for body in bodies)], dtype=np.int64)


def shapes_of(parts: list[PlacedPart]) -> list[PlacedShape]:
    """Return the shapes of parts, each once for every place that it has in a body."""
    return list({(id(part.shape), part.offset): (part.shape, part.offset) for part in parts}.values())


def shape_numbers(parts: list[PlacedPart], shapes: list[PlacedShape]) -> Integers:
    """Return which of the shapes each part has, shape [part_count]."""
    number = {(id(shape), offset): k for k, (shape, offset) in enumerate(shapes)}
    return np.array([number[id(part.shape), part.offset] for part in parts], dtype=np.int64)


def materials_of(parts: list[PlacedPart], planes: list[Plane]) -> list[Material]:
    """Return the materials of parts and planes, each once."""
    return list(dict.fromkeys([part.material for part in parts] + [plane.material for plane in planes]))


def material_numbers(made: list[PlacedPart] | list[Plane], materials: list[Material]) -> Integers:
    """Return which of the materials each part or plane is made of."""
    return np.array([materials.index(one.material) for one in made], dtype=np.int64)


def rotation_matrices(quaternions: Floats) -> Floats:
    """Return the rotation matrices [count, 3, 3], body to world, of unit quaternions w, x, y, z, shape [count, 4]."""
    rotation = np.zeros((len(quaternions), 3, 3))
    write_rotations(quaternions, rotation)
    return rotation


def cores_of(shapes: list[PlacedShape]) -> Cores:
    """Lay the convex cores of shapes one after the other, each where it stands in its body."""
    cores = [placed(shape.core_polyhedron, offset) for shape, offset in shapes]

    def starts(counts: list[int] | np.ndarray) -> np.ndarray:
        return np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)

    lines = np.concatenate([core.lines for core in cores])
    return Cores(
        np.concatenate([core.vertices for core in cores]), starts([len(core.vertices) for core in cores]),
        np.concatenate([core.face_normals for core in cores]), np.concatenate([core.face_offsets for core in cores]),
        starts([len(core.face_offsets) for core in cores]),
        np.concatenate([core.edges for core in cores]), starts([len(core.edges) for core in cores]),
        lines[:, 0].copy(), lines[:, 1] - lines[:, 0],
        np.concatenate([core.adjacent_faces for core in cores]),
        starts(np.concatenate([core.edges_of_face for core in cores])),
        np.array([shape.rounding for shape, _ in shapes]),
    )  # fmt: skip


def placed(core: Polyhedron, offset: Offset) -> Polyhedron:
    """Return a core that stands at an offset [m]."""
    if offset == AT_CENTRE:
        return core
    way = np.array(offset)
    return replace(core, vertices=core.vertices + way, face_offsets=core.face_offsets + core.face_normals @ way)


def laws_of(materials: list[Material], options: dict[str, str]) -> Laws:
    """Return the laws of all pairs of materials under the options of a world's contacts."""
    rules = options["shear_modulus_rule"], options["pair_rule"]
    table = np.array([[pair_law(a, b, *rules) for b in materials] for a in materials])
    laws = Laws(*(np.ascontiguousarray(table[:, :, k]) for k in range(table.shape[2])))
    if options["tangential_dashpot"] == "none":
        laws.shear_damping[:] = 0.0
    return laws


def planes_of(planes: list[Plane], materials: list[Material], body_count: int) -> Planes:
    """Return planes as arrays."""
    meets = np.ones((len(planes), body_count), dtype=np.bool_)
    for k, plane in enumerate(planes):
        if plane.meets is not None:
            meets[k] = np.isin(np.arange(body_count), list(plane.meets))
    normal = np.array([plane.normal for plane in planes]).reshape(-1, 3)
    offset = np.array([plane.normal @ plane.point for plane in planes])
    return Planes(normal, offset, material_numbers(planes, materials), meets)


def inverses(matrices: Floats) -> Floats:
    """Return the inverses of matrices, shape [count, 3, 3]."""
    inverse: Floats = np.linalg.inv(matrices).astype(np.float64)
    return inverse


def inertias(bodies: list[RigidBody]) -> Floats:
    """Return the inertias of bodies [kg m2], shape [body_count, 3, 3], body frame."""
    return np.array([body.inertia for body in bodies]).reshape(-1, 3, 3)


def bodies_of(
    bodies: list[RigidBody], parts: list[PlacedPart], shapes: list[PlacedShape], materials: list[Material],
    motion: dict[str, Floats], period: Period,
) -> Bodies:  # fmt: skip
    """Return bodies and their parts as arrays, in a motion of position, velocity, quaternion and angular_momentum."""
    n, inertia = len(bodies), inertias(bodies)
    arrays = Bodies(
        period=period,
        part_start=part_starts(bodies),
        shape=shape_numbers(parts, shapes),
        material=material_numbers(parts, materials),
        contact_radius=np.array([part.shape.contact_radius for part in parts]),
        curvature=np.array([1.0 / part.shape.contact_radius for part in parts]),
        mass=np.array([body.mass for body in bodies]), inverse_mass=np.array([1.0 / body.mass for body in bodies]),
        inverse_inertia_body=inverses(inertia),
        isotropic=(inertia == inertia[:, :1, :1] * np.eye(3)).all(axis=(1, 2)),
        bounding_radius=np.array([body.bounding_radius for body in bodies]),
        turning_radius=np.array([body.turning_radius for body in bodies]),
        position=motion["position"], velocity=motion["velocity"], quaternion=motion["quaternion"],
        angular_momentum=motion["angular_momentum"], rotation=np.zeros((n, 3, 3)), inverse_inertia=np.zeros((n, 3, 3)),
        force=np.zeros((n, 3)), torque=np.zeros((n, 3)), half_spin=np.zeros((n, 3)),
        velocity_predicted=np.zeros((n, 3)), spin_predicted=np.zeros((n, 3)),
        rates=np.zeros((n, 2)), dragged=np.zeros(n), travel=np.zeros(n), travel_listed=np.zeros(n),
    )  # fmt: skip
    write_matrices(arrays)
    return arrays
