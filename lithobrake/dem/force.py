"""Contact force of a pair: Hertz with damping that gives the entered restitution, cohesion, friction and rolling.

Source: the paper, Eqs (1) to (9), with Mindlin's (1949) shear modulus; the no-tension end of contact and the damping
that makes up for it, see material.restitution_of.
"""

from typing import NamedTuple

from lithobrake.compiled import kernel, large_kernel
from lithobrake.dem.arrays import Bodies, Cores, Floats, Laws, Pairs, Partition, Planes, Reactions, Step
from lithobrake.dem.contact_patch import find_contact
from lithobrake.dem.effective_mass import inverse_inertia_across, inverse_inertia_along, inverse_mass_at
from lithobrake.dem.gjk import Search
from lithobrake.dem.patch_energy import DEEP_EDGES, spin_radii
from lithobrake.dem.rolling_resistance import end_couples, resist_rolling, resist_twisting
from lithobrake.dem.spring import spring_force, stored, tangential_part, turned_spring
from lithobrake.dem.stability import patch_tilt_stiffness
from lithobrake.dem.vectors import Vector, add, cross, dot, minus, plus, put, row, scaled

DAMPING, FRICTION, ROLLING = 0, 1, 2  # columns of Pairs.lost
LOSSES = 3


class NormalLoad(NamedTuple):
    """What the points of a patch do together along their normals."""

    repulsion: float  # N, along the normal of the patch
    total: float  # N, less cohesion
    left: float  # N, to be applied along the normal at the centre: all of it, where the patch is one point
    force: Vector  # N, the rest, on the second
    torque: Vector  # N m, of the rest, on the second about the centroid of the first
    damped: float  # J


class RelativeMotion(NamedTuple):
    """How the members of a pair move against each other, second against first, at their centre of pressure."""

    inverse_mass: float  # 1/kg, of the pair for a force along the normal
    curvature: float  # 1/m
    now: Vector  # m/s, predicted for the instant of the positions
    moved: Vector  # m/s, that made the last step
    spin: Vector  # rad/s, relative, that made the last step
    twist: float  # rad/s, mean spin about the normal


@kernel
def point_velocity(linear: Floats, spin: Floats, body: int, arm: Vector) -> Vector:
    """Return the velocity of the body's material at an arm from its centroid."""
    return plus(row(linear, body), cross(row(spin, body), arm))


@kernel
def relative_motion(
    bodies: Bodies, first: int, second: int, point: Vector, normal: Vector, whole_mass: bool
) -> RelativeMotion:
    """Return how a body meets another, or a plane (second < 0)."""
    arm = minus(point, row(bodies.position, first))
    inverse_mass = inverse_mass_at(bodies, first, arm, normal, whole_mass)
    curvature = bodies.curvature[first]
    now = scaled(-1.0, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, first, arm))
    moved = scaled(-1.0, point_velocity(bodies.velocity, bodies.half_spin, first, arm))
    spin = scaled(-1.0, row(bodies.half_spin, first))
    twist = 0.5 * dot(row(bodies.half_spin, first), normal)
    if second >= 0:
        arm = minus(point, row(bodies.position, second))
        inverse_mass += inverse_mass_at(bodies, second, arm, normal, whole_mass)
        curvature += bodies.curvature[second]
        now = plus(now, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, second, arm))
        moved = plus(moved, point_velocity(bodies.velocity, bodies.half_spin, second, arm))
        spin = plus(spin, row(bodies.half_spin, second))
        twist += 0.5 * dot(row(bodies.half_spin, second), normal)
    return RelativeMotion(inverse_mass, curvature, now, moved, spin, twist)


@kernel
def repel(weight: float, elastic: float, dashpot: float, speed: float) -> float:
    """Return the repulsion at a point of a patch, which never pulls."""
    return weight * max(0.0, elastic - dashpot * speed)


@kernel
def normal_force(
    search: Search, count: int, bodies: Bodies, first: int, second: int, motion: RelativeMotion, normal: Vector,
    elastic: float, cohesion: float, dashpot: float, time_step: float,
) -> NormalLoad:  # fmt: skip
    """Return the normal forces at the points of a patch: repulsion less cohesion."""
    if count == 1 and search.family[0] != DEEP_EDGES:
        speed, weight = dot(motion.now, normal), search.point_weight[0]
        repulsion = repel(weight, elastic, dashpot, speed)
        total = repulsion - weight * cohesion
        damped = (weight * elastic - repulsion) * speed * time_step
        return NormalLoad(repulsion, total, total, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), damped)
    repulsion, total, damped, force, torque = 0.0, 0.0, 0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for k in range(count):
        place, outward = row(search.point, k), row(search.normal, k)
        arm = minus(place, row(bodies.position, first))
        now = scaled(-1.0, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, first, arm))
        if second >= 0:
            other_arm = minus(place, row(bodies.position, second))
            now = plus(now, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, second, other_arm))
        speed = dot(now, outward)
        lever = cross(arm, outward)
        if search.family[k] == DEEP_EDGES:
            turning = minus(row(bodies.spin_predicted, second), row(bodies.spin_predicted, first))
            speed += dot(turning, row(search.couple, k))
            lever = plus(lever, row(search.couple, k))
        pushes = repel(search.point_weight[k], elastic, dashpot, speed)
        damped += (search.point_weight[k] * elastic - pushes) * speed * time_step
        along = dot(outward, normal)
        repulsion += pushes * along
        pushes -= search.point_weight[k] * cohesion
        force, torque = plus(force, scaled(pushes, outward)), plus(torque, scaled(pushes, lever))
        total += pushes * along
    return NormalLoad(repulsion, total, 0.0, force, torque, damped)


@kernel
def friction_force(
    pair: int, pairs: Pairs, normal: Vector, motion: RelativeMotion, limit: float, stiffness: float, dashpot: float,
    time_step: float,
) -> Vector:  # fmt: skip
    """Return the tangential force on the second body, within the Coulomb limit."""
    before = turned_spring(row(pairs.spring, pair), row(pairs.normal, pair), normal, motion.twist * time_step)
    slip = scaled(time_step, tangential_part(motion.moved, normal))
    held = spring_force(
        before, pairs.tangential_stiffness[pair], stiffness, slip, tangential_part(motion.now, normal), dashpot, limit
    )  # fmt: skip
    put(pairs.spring, pair, held.spring)
    pairs.tangential_stiffness[pair] = stiffness
    pairs.lost[pair, FRICTION] += held.slid
    pairs.lost[pair, DAMPING] += held.damped * time_step
    return held.total


@kernel
def end_contact(pairs: Pairs, pair: int) -> None:
    """End a contact, if there was one: the springs let go."""
    if pairs.overlap[pair] == 0.0:
        return
    spring = row(pairs.spring, pair)
    twisted, rolled = end_couples(pair, pairs)
    pairs.lost[pair, FRICTION] += stored(dot(spring, spring), pairs.tangential_stiffness[pair]) + twisted
    pairs.lost[pair, ROLLING] += rolled
    put(pairs.spring, pair, (0.0, 0.0, 0.0))
    put(pairs.tangential_force, pair, (0.0, 0.0, 0.0))
    pairs.tangential_stiffness[pair] = 0.0
    pairs.overlap[pair] = 0.0
    pairs.normal_force[pair], pairs.elastic_force[pair], pairs.cohesion[pair] = 0.0, 0.0, 0.0


@kernel
def add_wrench(bodies: Bodies, body: int, sign: float, force: Vector, torque: Vector) -> None:
    """Add what a contact does to one of its bodies."""
    add(bodies.force, body, sign, force)
    add(bodies.torque, body, sign, torque)


@kernel
def contact_force(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, search: Search,
    reactions: Reactions, kept: bool,
) -> float:  # fmt: skip
    """Compute the contact force of one pair, and add it to its members or keep it in `reactions`.

    Returns the square [1/s2] of the rate of its spring or dashpot, 0 where nothing touches.
    """
    first, second = pairs.first[pair], pairs.second[pair]
    is_body = second >= 0
    if pairs.feature_count[pair] == 0:
        end_contact(pairs, pair)
        return 0.0
    count, overlap, point, normal, through_centroids = find_contact(pair, bodies, cores, planes, pairs, search)
    if count == 0:
        end_contact(pairs, pair)
        return 0.0
    # A force through the centroid turns nothing: it meets the whole mass.
    motion = relative_motion(bodies, first, second, point, normal, through_centroids or step.paper_mass)
    here, there = bodies.material[first], bodies.material[second] if is_body else planes.material[-1 - second]
    damping_ratio = laws.damping_ratio[here, there]
    radius = 1.0 / motion.curvature
    # The root is taken of the product: a length scaled by a power of two then scales every bit.
    root = (overlap * radius) ** 0.5
    stiffness = 4.0 / 3.0 * laws.young_modulus[here, there] * root
    shear_stiffness = 8.0 * laws.shear_modulus[here, there] * root
    dashpot = 2.0 * damping_ratio * (1.25 * stiffness * (1.0 / motion.inverse_mass)) ** 0.5
    elastic = stiffness * overlap
    cohesion = laws.cohesion_force[here, there] + laws.cohesion_line[here, there] * radius
    load = normal_force(
        search, count, bodies, first, second, motion, normal, elastic, cohesion, dashpot, step.time_step
    )  # fmt: skip
    pairs.lost[pair, DAMPING] += load.damped
    shear_dashpot = dashpot * laws.shear_damping[here, there]
    limit = laws.friction[here, there] * load.repulsion
    tangential = friction_force(pair, pairs, normal, motion, limit, shear_stiffness, shear_dashpot, step.time_step)
    central = plus(scaled(load.left, normal), tangential)
    force = plus(load.force, central)
    torque = plus(load.torque, cross(minus(point, row(bodies.position, first)), central))

    lever = laws.spinning_friction[here, there] * radius
    square, mean = spin_radii(search, count, point, normal)
    square += lever * lever
    if square > 0.0 or pairs.twist_stiffness[pair] > 0.0:
        couple, slid, damped = resist_twisting(
            pair, pairs, dot(motion.spin, normal), limit * mean + load.repulsion * lever, shear_stiffness * square,
            damping_ratio, inverse_inertia_along(bodies, first, second, normal), step.time_step,
        )  # fmt: skip
        torque = plus(torque, scaled(couple, normal))
        pairs.lost[pair, FRICTION] += slid
        pairs.lost[pair, DAMPING] += damped
    pairs.tilt_stiffness[pair] = patch_tilt_stiffness(search, count, point, normal, overlap, stiffness)
    lever = laws.rolling_friction[here, there] * radius
    if lever > 0.0:
        rolling, lost = resist_rolling(
            pair, pairs, normal, motion.spin, motion.twist, lever, load.repulsion, stiffness, damping_ratio,
            inverse_inertia_across(bodies, first, second, normal), step.time_step,
        )  # fmt: skip
        torque = plus(torque, rolling)
        pairs.lost[pair, ROLLING] += lost
    second_torque = torque
    if is_body:
        second_torque = minus(torque, cross(minus(row(bodies.position, second), row(bodies.position, first)), force))
    if kept:
        put(reactions.force, pair, force)
        put(reactions.first_torque, pair, torque)
        put(reactions.second_torque, pair, second_torque)
    else:
        add_wrench(bodies, first, -1.0, force, torque)
        if is_body:
            add_wrench(bodies, second, 1.0, force, second_torque)
    pairs.overlap[pair], pairs.normal_force[pair], pairs.elastic_force[pair] = overlap, load.total, elastic
    pairs.cohesion[pair] = cohesion
    put(pairs.normal, pair, normal)
    put(pairs.point, pair, point)
    put(pairs.tangential_force, pair, tangential)
    return 1.5 * stiffness * motion.inverse_mass * max(1.0, 2.0 * damping_ratio) ** 2


@large_kernel
def contact_forces(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, search: Search,
    reactions: Reactions, kept: bool, start: int, stop: int,
) -> float:  # fmt: skip
    """Compute the contact forces of pairs from start to before stop; return the largest square of a rate [1/s2]."""
    fastest = 0.0
    for pair in range(start, stop):
        fastest = max(fastest, contact_force(pair, bodies, cores, planes, pairs, laws, step, search, reactions, kept))
    return fastest


@large_kernel
def forces_across_partitions(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, search: Search,
    reactions: Reactions, partition: Partition,
) -> float:  # fmt: skip
    """Compute the contact forces of a partition's pairs with bodies of later partitions, and keep them; return as
    contact_forces."""
    fastest = 0.0
    for k in range(len(partition.outgoing)):
        pair = partition.outgoing[k]
        rate = contact_forces(bodies, cores, planes, pairs, laws, step, search, reactions, True, pair, pair + 1)
        fastest = max(fastest, rate)
    return fastest


@large_kernel
def forces_within_partition(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, search: Search,
    reactions: Reactions, partition: Partition,
) -> float:  # fmt: skip
    """Sum up the contact forces on the bodies of a partition, once those across partitions are known.

    Sums run in the order of the pairs, in one partition as in many. Returns as contact_forces.
    """
    gather_reactions(bodies, pairs, reactions, partition)
    fastest, start = 0.0, partition.first_pair
    for k in range(len(partition.outgoing)):
        pair = partition.outgoing[k]
        rate = contact_forces(bodies, cores, planes, pairs, laws, step, search, reactions, False, start, pair)
        fastest, start = max(fastest, rate), pair + 1
        if pairs.overlap[pair] > 0.0:
            add_wrench(bodies, pairs.first[pair], -1.0, row(reactions.force, pair), row(reactions.first_torque, pair))
    rate = contact_forces(
        bodies, cores, planes, pairs, laws, step, search, reactions, False, start, partition.last_pair
    )
    return max(fastest, rate)


@kernel
def gather_reactions(bodies: Bodies, pairs: Pairs, reactions: Reactions, partition: Partition) -> None:
    """Begin the sums of a partition's bodies with what pairs of earlier partitions do to them."""
    bodies.force[partition.start : partition.stop] = 0.0
    bodies.torque[partition.start : partition.stop] = 0.0
    for k in range(len(partition.incoming)):
        pair = partition.incoming[k]
        if pairs.overlap[pair] > 0.0:
            add_wrench(bodies, pairs.second[pair], 1.0, row(reactions.force, pair), row(reactions.second_torque, pair))
