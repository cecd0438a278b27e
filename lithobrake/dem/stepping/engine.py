"""The compiled side of a world: from what a person adds to arrays, and the stepping that renews lists."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from lithobrake.dem.bodies.arrays import DAMPING, Bodies, Cores, Laws, Pairs, Period, Planes, Reactions, Step
from lithobrake.dem.bodies.orientation import write_matrices, write_rotations
from lithobrake.dem.bodies.rigid_body import AT_CENTRE, Offset, PlacedPart, Plane, RigidBody
from lithobrake.dem.bodies.shape import Polyhedron, Shape
from lithobrake.dem.bodies.vectors import refuse_short_period
from lithobrake.dem.law.restitution import pair_law
from lithobrake.dem.narrow_phase.feature_distance import INLINE_FEATURES
from lithobrake.dem.narrow_phase.feature_list import BOUND_SLACK
from lithobrake.dem.narrow_phase.scratch import Scratch, System, scratch_for
from lithobrake.dem.stepping.neighbours import carry_over, neighbouring_pairs, with_more_overflow, without_joined
from lithobrake.dem.stepping.time_loop import (
    DONE,
    FEATURES_OVERFLOW,
    LIST_USED_UP,
    Team,
    advance,
    new_reactions,
    partitions_of,
)
from lithobrake.vocabulary.array_types import Floats, Integers
from lithobrake.vocabulary.material_properties import Material

# A shape and where its centroid stands from the centre of mass [m], frame of the shape.
PlacedShape = tuple[Shape, Offset]
# Skin of the neighbour list over the smallest bounding radius: costs or saves time, changes no result.
# A wider skin lasts longer but lists more pairs: from 0.2 to 0.3 landings gain 5 % and spheres at rest lose 10 %.
SKIN = 0.25
NO_REACTIONS = new_reactions(0)
# What changes of bodies and does not follow from the rest; what a checkpoint keeps of them.
MOVING = (
    "position", "velocity", "quaternion", "angular_momentum", "force", "torque", "half_spin", "travel", "travel_listed",
    "dragged",
)  # fmt: skip


def parts_of(bodies: list[RigidBody]) -> list[PlacedPart]:
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
    rules = options["shear_modulus_rule"], options["pair_rule"]
    table = np.array([[pair_law(a, b, *rules) for b in materials] for a in materials])
    laws = Laws(*(np.ascontiguousarray(table[:, :, k]) for k in range(table.shape[2])))
    if options["tangential_dashpot"] == "none":
        laws.shear_damping[:] = 0.0
    return laws


def planes_of(planes: list[Plane], materials: list[Material], body_count: int) -> Planes:
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
    # `isotropic` means equal to the last bit: motion.py then leaves out what would change nothing.
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


def pool_of(thread_count: int) -> ThreadPoolExecutor | None:
    return ThreadPoolExecutor(thread_count - 1) if thread_count > 1 else None


class Engine:
    """Arrays of a world in which nothing is added any more.

    motion holds position, velocity, quaternion and angular_momentum and is advanced in place; pairs carry the history
    of contacts; lost [3] (see Pairs) and watch_record count on across engines. leader [body_count]: see leaders_of.
    """

    def __init__(
        self,
        bodies: list[RigidBody],
        planes: list[Plane],
        options: dict[str, str],
        motion: dict[str, Floats],
        pairs: Pairs,
        lost: Floats,
        watch_record: Floats,
        thread_count: int,
        period: Period,
        leader: Integers,
    ) -> None:
        parts = parts_of(bodies)
        shapes, materials = shapes_of(parts), materials_of(parts, planes)
        self.cores: Cores = cores_of(shapes)
        self.laws: Laws = laws_of(materials, options)
        self.planes: Planes = planes_of(planes, materials, len(bodies))
        self.bodies: Bodies = bodies_of(bodies, parts, shapes, materials, motion, period)
        self.pairs: Pairs
        self.scratch: Scratch
        self.team: Team | None
        self.lost, self.watch_record = lost, watch_record
        self.leader = leader
        self.skin = SKIN * float(self.bodies.bounding_radius.min())
        refuse_short_period(period, self.bodies.bounding_radius, self.skin)
        self.thread_count, self.pool = thread_count, pool_of(thread_count)
        # Neighbours are not listed yet, and no list of features says when it was made.
        self.gather(pairs)
        self.pairs.wake[:] = 0.0

    def advance(self, steps: int, step: Step, watched: int) -> tuple[int, int]:
        """Take steps; return how many were taken, and why it ended (DONE, or what is wrong).

        A step of no duration computes the forces at hand.
        """
        left, drifted = steps, False
        while left > 0:
            taken, reason, drifted = self._advance(left, drifted, step, watched)
            left -= taken
            if reason == LIST_USED_UP:
                self.list_neighbours()
            elif reason == FEATURES_OVERFLOW:
                self.gather(with_more_overflow(self.pairs))
            elif reason != DONE:
                return steps - left, reason
        return steps, DONE

    def _advance(self, steps: int, drifted: bool, step: Step, watched: int) -> tuple[int, int, bool]:
        if self.team is None:
            return advance(
                self.system(NO_REACTIONS), step, self.whole, steps, drifted, self._travel_limit, watched,
                self.watch_record,
            )  # fmt: skip
        return self.team.advance(
            self.system(self.team.reactions), step, steps, drifted, self._travel_limit, watched, self.watch_record
        )

    def system(self, reactions: Reactions) -> System:
        return System(self.bodies, self.cores, self.planes, self.pairs, self.laws, self.scratch, reactions)

    def losses(self) -> Floats:
        """Return what damping, friction and rolling have taken so far [J], shape [3]."""
        lost = self.lost + self.pairs.lost.sum(axis=0)
        lost[DAMPING] += self.bodies.dragged.sum()
        return lost

    def book(self) -> None:
        """Enter the losses of pairs and bodies into the sums, before these arrays are left."""
        self.lost[:] = self.losses()
        self.pairs.lost[:], self.bodies.dragged[:] = 0.0, 0.0

    def restore(self, moving: dict[str, Floats], pairs: Pairs, skin: float) -> None:
        """Go on from where another engine for the same bodies stood: its MOVING arrays, pairs, and skin [m]."""
        for name, values in moving.items():
            getattr(self.bodies, name)[:] = values
        write_matrices(self.bodies)
        self.skin = skin
        self.gather(pairs)

    def use_threads(self, thread_count: int) -> None:
        self.thread_count, self.pool = thread_count, pool_of(thread_count)
        self.gather(self.pairs)

    def gather(self, pairs: Pairs) -> None:
        """Take on pairs: make scratch for them, and divide them among the threads."""
        self.pairs, self.scratch = pairs, self.scratch_of(pairs)
        self.whole, *_ = partitions_of(pairs, len(self.bodies.mass), 1)
        self.team = None
        if self.pool is not None:
            scratches = [self.scratch_of(pairs) for _ in range(self.thread_count)]
            self.team = Team(self.pool, scratches, len(self.bodies.mass), pairs)

    def scratch_of(self, pairs: Pairs) -> Scratch:
        shape = self.bodies.shape
        vertices, edges = (
            np.sort(np.diff(start)[shape])[-2:] for start in (self.cores.vertex_start, self.cores.edge_start)
        )
        # All corners and all pairs of edges of the two largest bodies, should they cross, and a list's worth beside.
        points = 1 + int(vertices.sum() + 2 * edges.prod()) + INLINE_FEATURES + pairs.overflow.shape[1]
        return scratch_for(int(vertices.max() + edges.max()), points)

    @property
    def _travel_limit(self) -> float:
        """How far a surface may come nearer to others before neighbours are listed anew [m]."""
        # Both members of a pair may move, each by half of the skin; the slack covers the round-off of summed travels.
        return 0.5 * (1.0 - BOUND_SLACK) * self.skin

    def list_neighbours(self) -> None:
        """List neighbours anew; contacts keep their history."""
        # Pairs that leave the list would take along what they have lost so far.
        self.book()
        pairs = neighbouring_pairs(self.bodies, self.cores, self.planes, self.scratch, self.skin)
        self.gather(carry_over(self.pairs, without_joined(pairs, self.leader)))
        self.bodies.travel_listed[:] = self.bodies.travel
