"""The arrays that kernels work on, and the convex parts that meet in a pair. Lengths in metres, world frame."""

from typing import NamedTuple

from lithobrake.compilation.compiled import kernel
from lithobrake.vocabulary.array_types import Flags, Floats, Integers

# Columns of `lost`.
DAMPING, FRICTION, ROLLING = 0, 1, 2
LOSSES = 3


class Cores(NamedTuple):
    """Constant: the convex cores of all shapes, one after the other. `start[s]:start[s + 1]` belongs to shape s.

    A shape that stands at different places of bodies counts as several.
    """

    vertex: Floats  # [vertex_total, 3], about the centre of mass of the body
    vertex_start: Integers  # [shape_count + 1]
    normal: Floats  # [face_total, 3]
    offset: Floats  # [face_total]
    face_start: Integers  # [shape_count + 1]
    edge: Integers  # [edge_total, 4]: from, to, left face, right face, counted within the shape
    edge_start: Integers  # [shape_count + 1]
    edge_begin: Floats  # [edge_total, 3], about the centre of mass of the body
    edge_along: Floats  # [edge_total, 3], from begin to end
    adjacent_face: Integers  # [2 edge_total]: the faces across the edges of each face, counted within the shape
    adjacent_start: Integers  # [face_total + 1]
    rounding: Floats  # [shape_count]


class Period(NamedTuple):
    """Lengths after which the world repeats along x and y, and one over them; all 0 where it does not."""

    x: float  # m
    y: float
    inverse_x: float  # 1/m
    inverse_y: float


class Bodies(NamedTuple):
    """Per body, or per convex part of one; constants first, then what a step changes.

    The parts of a body move as one. Their cores are about its centre of mass, in its own frame.
    """

    period: Period
    part_start: Integers  # [body_count + 1]: parts part_start[b] to before part_start[b + 1] belong to body b
    shape: Integers  # [part_count]
    material: Integers  # [part_count]
    contact_radius: Floats  # [part_count], radius of the volume-equivalent sphere
    curvature: Floats  # [part_count], 1/m, one over that
    mass: Floats  # [body_count], kg
    inverse_mass: Floats  # [body_count], 1/kg
    inverse_inertia_body: Floats  # [body_count, 3, 3], body frame, 1/(kg m2)
    isotropic: Flags  # [body_count], whether all moments of inertia are the same number
    bounding_radius: Floats  # [body_count]
    turning_radius: Floats  # [body_count], arm at which a spin moves the surface; 0 for spheres, which look the same
    position: Floats  # [body_count, 3], centre of mass
    velocity: Floats  # [body_count, 3], m/s
    quaternion: Floats  # [body_count, 4], w x y z, body to world
    angular_momentum: Floats  # [body_count, 3], kg m2/s
    rotation: Floats  # [body_count, 3, 3], body to world
    inverse_inertia: Floats  # [body_count, 3, 3], world frame
    force: Floats  # [body_count, 3], N, without gravity
    torque: Floats  # [body_count, 3], N m
    half_spin: Floats  # [body_count, 3], rad/s, that made the last rotation
    velocity_predicted: Floats  # [body_count, 3], m/s, at the instant of the positions
    spin_predicted: Floats  # [body_count, 3], rad/s, at the instant of the positions
    rates: Floats  # [body_count, 2], 1/s2 and 1/s, see stability.py; holds at the last look
    dragged: Floats  # [body_count], J, what drag has taken
    travel: Floats  # [body_count], m, a bound on how much nearer to anything the surface may have come so far
    travel_listed: Floats  # [body_count], m, the same when the neighbour list was made


class Planes(NamedTuple):
    """Constant: half-spaces of matter below `offset` along the outward normal."""

    normal: Floats  # [plane_count, 3]
    offset: Floats  # [plane_count], m
    material: Integers  # [plane_count]
    meets: Flags  # [plane_count, body_count]


class Pairs(NamedTuple):
    """Per pair of neighbouring parts, ordered by bodies and then by parts; plane k is second = -1 - k."""

    first: Integers  # [pair_count], body
    second: Integers  # [pair_count], body
    first_part: Integers  # [pair_count], part of the first
    second_part: Integers  # [pair_count], part of the second; of a plane as second
    wake: Floats  # [pair_count], m: its list of features serves until the travels of both add up to this
    overlap: Floats  # [pair_count], m, effective, and elastic where it has yielded; 0 where apart
    deepest: Floats  # [pair_count], m, largest overlap since they touched, of those that yield
    normal: Floats  # [pair_count, 3], unit, from first to second
    point: Floats  # [pair_count, 3], centre of pressure, at the image of the first
    normal_force: Floats  # [pair_count], N, less cohesion
    elastic_force: Floats  # [pair_count], N, derivative of the elastic energy by the overlap
    cohesion: Floats  # [pair_count], N, the same of the cohesive energy
    spring: Floats  # [pair_count, 3], N, tangential spring force on second
    tangential_force: Floats  # [pair_count, 3], N, spring and dashpot on second
    tangential_stiffness: Floats  # [pair_count], N/m
    twist: Floats  # [pair_count], N m, couple of the twisting spring about the normal on second
    twist_stiffness: Floats  # [pair_count], N m
    roll: Floats  # [pair_count, 3], N m, couple of the rolling spring on second
    roll_stiffness: Floats  # [pair_count], N m
    tilt_stiffness: Floats  # [pair_count], N m, against tilting of a patch of several points
    lost: Floats  # [pair_count, LOSSES], J, what damping, friction and rolling took since the list was made
    feature_count: Integers  # [pair_count], features near enough to touch before waking; -1: all of them
    feature: Integers  # [pair_count, INLINE_FEATURES], the first of them, see feature_id.py
    overflow_row: Integers  # [pair_count], row of those that found no room there, -1: none
    overflow: Integers  # [row_count, overflow_max]


class Laws(NamedTuple):
    """Constant: per pair of materials [material_count, material_count]."""

    young_modulus: Floats  # effective, Pa
    shear_modulus: Floats  # effective, Pa
    damping_ratio: Floats
    shear_damping: Floats  # dashpot across the normal over that along it
    friction: Floats
    rolling_friction: Floats
    spinning_friction: Floats
    cohesion_force: Floats  # N
    cohesion_line: Floats  # N/m, cohesion over contact radius
    yield_pressure: Floats  # Pa, at the middle of a contact; 0: it does not yield
    viscosity: Floats  # see PairLaw


class Partition(NamedTuple):
    """A run of bodies, and the pairs of which they are the first: what one thread works on, see threads.py."""

    start: int
    stop: int  # bodies from start to before stop
    first_pair: int
    last_pair: int  # pairs from first_pair to before last_pair
    outgoing: Integers  # those of them whose second is in a later partition, in order
    incoming: Integers  # pairs of earlier partitions of which these bodies are the second, in order


class Reactions(NamedTuple):
    """What contacts do to their bodies, kept where these are in different partitions; no room where there is one."""

    force: Floats  # [pair_count, 3] or [0, 3], N, on the second
    first_torque: Floats  # the same, N m
    second_torque: Floats  # the same, N m


class Step(NamedTuple):
    time_step: float  # s
    drag: float  # 1/s, viscous damping of all motion, 0 but in settling
    gravity: tuple[float, float, float]  # m/s2
    rotation: tuple[float, float, float]  # rad/s, of the frame
    paper_mass: bool  # damping with the reduced mass of the bodies, not the mass seen at the contact point


@kernel
def first_shape(pair: int, bodies: Bodies, pairs: Pairs) -> int:
    return bodies.shape[pairs.first_part[pair]]


@kernel
def both_shapes(pair: int, bodies: Bodies, pairs: Pairs) -> tuple[int, int]:
    return bodies.shape[pairs.first_part[pair]], bodies.shape[pairs.second_part[pair]]


@kernel
def both_roundings(cores: Cores, shapes: tuple[int, int]) -> float:
    """Return the sum of the rounding radii of two shapes [m]."""
    return cores.rounding[shapes[0]] + cores.rounding[shapes[1]]


@kernel
def curvature_of(pair: int, bodies: Bodies, pairs: Pairs) -> float:
    """Return the curvature at which the members of a pair meet [1/m]; a plane has none."""
    curvature = bodies.curvature[pairs.first_part[pair]]
    return curvature + bodies.curvature[pairs.second_part[pair]] if pairs.second[pair] >= 0 else curvature


@kernel
def contact_radii(pair: int, bodies: Bodies, pairs: Pairs) -> float:
    """Return the sum of the contact radii of the members of a pair [m]; a plane counts for nothing."""
    radius = bodies.contact_radius[pairs.first_part[pair]]
    return radius + (bodies.contact_radius[pairs.second_part[pair]] if pairs.second[pair] >= 0 else 0.0)
