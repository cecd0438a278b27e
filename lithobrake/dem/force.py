"""Contact forces of all pairs, and their sums on the bodies: by contact_law.py, at the points of contact_patch.py."""

from typing import NamedTuple

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.arrays import Bodies, Cores, Laws, Pairs, Partition, Planes, Reactions, Step
from lithobrake.dem.contact_law import (
    DAMPING,
    FRICTION,
    ROLLING,
    RelativeMotion,
    end_contact,
    friction_force,
    normal_force,
    record_contact,
    relative_motion,
)
from lithobrake.dem.contact_patch import find_contact
from lithobrake.dem.effective_mass import inverse_inertia_across, inverse_inertia_along
from lithobrake.dem.patch_energy import spin_radii
from lithobrake.dem.rolling_resistance import resist_rolling, resist_twisting
from lithobrake.dem.scratch import Patch, Scratch
from lithobrake.dem.stability import patch_tilt_stiffness
from lithobrake.dem.vectors import Vector, add, cross, dot, minus, plus, put, row, scaled


@kernel
def add_wrench(bodies: Bodies, body: int, sign: float, force: Vector, torque: Vector) -> None:
    """Add what a contact does to one of its bodies. Writes to bodies."""
    add(bodies.force, body, sign, force)
    add(bodies.torque, body, sign, torque)


@kernel
def hand_over(
    pair: int, bodies: Bodies, pairs: Pairs, reactions: Reactions, force: Vector, torque: Vector, kept: bool
) -> None:
    """Add the force on the second, and its torque about the centroid of the first, to both members, or keep them.

    Writes to bodies and reactions.
    """
    first, second, second_torque = pairs.first[pair], pairs.second[pair], torque
    if second >= 0:
        second_torque = minus(torque, cross(minus(row(bodies.position, second), row(bodies.position, first)), force))
    if kept:
        put(reactions.force, pair, force)
        put(reactions.first_torque, pair, torque)
        put(reactions.second_torque, pair, second_torque)
    else:
        add_wrench(bodies, first, -1.0, force, torque)
        if second >= 0:
            add_wrench(bodies, second, 1.0, force, second_torque)


class ContactSprings(NamedTuple):
    """How the materials of a pair answer an overlap."""

    secant: float  # N/m, elastic force over overlap
    shear: float  # N/m
    dashpot: float  # N s/m, along the normal
    damping_ratio: float
    radius: float  # m, R*


@kernel
def contact_springs(laws: Laws, here: int, there: int, overlap: float, motion: RelativeMotion) -> ContactSprings:
    """Return the springs and the dashpot of two materials at an overlap."""
    radius, damping_ratio = 1.0 / motion.curvature, laws.damping_ratio[here, there]
    # The root is taken of the product: a length scaled by a power of two then scales every bit.
    root = (overlap * radius) ** 0.5
    secant = 4.0 / 3.0 * laws.young_modulus[here, there] * root
    shear = 8.0 * laws.shear_modulus[here, there] * root
    dashpot = 2.0 * damping_ratio * (1.25 * secant * (1.0 / motion.inverse_mass)) ** 0.5
    return ContactSprings(secant, shear, dashpot, damping_ratio, radius)


@kernel
def resist_turning(
    pair: int, bodies: Bodies, pairs: Pairs, laws: Laws, step: Step, patch: Patch, count: int, here: int, there: int,
    point: Vector, normal: Vector, motion: RelativeMotion, springs: ContactSprings, repulsion: float, torque: Vector,
) -> Vector:  # fmt: skip
    """Return the torque on the second body with the couples against twisting, spinning and rolling. Writes to pairs."""
    first, second = pairs.first[pair], pairs.second[pair]
    lever = laws.spinning_friction[here, there] * springs.radius
    square, mean = spin_radii(patch, count, point, normal)
    square += lever * lever
    if square > 0.0 or pairs.twist_stiffness[pair] > 0.0:
        limit = laws.friction[here, there] * repulsion * mean + repulsion * lever
        couple, slid, damped = resist_twisting(
            pair, pairs, dot(motion.spin, normal), limit, springs.shear * square, springs.damping_ratio,
            inverse_inertia_along(bodies, first, second, normal), step.time_step,
        )  # fmt: skip
        torque = plus(torque, scaled(couple, normal))
        pairs.lost[pair, FRICTION] += slid
        pairs.lost[pair, DAMPING] += damped
    lever = laws.rolling_friction[here, there] * springs.radius
    if lever > 0.0:
        rolling, lost = resist_rolling(
            pair, pairs, normal, motion.spin, motion.twist, lever, repulsion, springs.secant, springs.damping_ratio,
            inverse_inertia_across(bodies, first, second, normal), step.time_step,
        )  # fmt: skip
        torque = plus(torque, rolling)
        pairs.lost[pair, ROLLING] += lost
    return torque


@kernel
def contact_force(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, scratch: Scratch,
    reactions: Reactions, kept: bool,
) -> float:  # fmt: skip
    """Compute the contact force of one pair, and add it to its members or keep it in `reactions`.

    Returns the square [1/s2] of the rate of its spring or dashpot, 0 where nothing touches.
    Writes to bodies, pairs, scratch and reactions.
    """
    patch, first, second = scratch.patch, pairs.first[pair], pairs.second[pair]
    if pairs.feature_count[pair] == 0:
        end_contact(pair, pairs)
        return 0.0
    count, overlap, point, normal, through_centroids = find_contact(pair, bodies, cores, planes, pairs, scratch)
    if count == 0:
        end_contact(pair, pairs)
        return 0.0
    # A force through the centroid turns nothing: it meets the whole mass.
    motion = relative_motion(bodies, first, second, point, normal, through_centroids or step.paper_mass)
    here, there = bodies.material[first], bodies.material[second] if second >= 0 else planes.material[-1 - second]
    springs = contact_springs(laws, here, there, overlap, motion)
    elastic = springs.secant * overlap
    cohesion = laws.cohesion_force[here, there] + laws.cohesion_line[here, there] * springs.radius
    dashpot, time_step = springs.dashpot, step.time_step
    load = normal_force(bodies, patch, count, first, second, motion, normal, elastic, cohesion, dashpot, time_step)
    pairs.lost[pair, DAMPING] += load.damped
    limit, shear_dashpot = laws.friction[here, there] * load.repulsion, dashpot * laws.shear_damping[here, there]
    tangential = friction_force(pair, pairs, normal, motion, limit, springs.shear, shear_dashpot, time_step)
    central = plus(scaled(load.left, normal), tangential)
    torque = plus(load.torque, cross(minus(point, row(bodies.position, first)), central))
    torque = resist_turning(
        pair, bodies, pairs, laws, step, patch, count, here, there, point, normal, motion, springs, load.repulsion,
        torque,
    )  # fmt: skip
    hand_over(pair, bodies, pairs, reactions, plus(load.force, central), torque, kept)
    pairs.tilt_stiffness[pair] = patch_tilt_stiffness(patch, count, point, normal, overlap, springs.secant)
    record_contact(pair, pairs, overlap, point, normal, tangential, load.total, elastic, cohesion)
    return 1.5 * springs.secant * motion.inverse_mass * max(1.0, 2.0 * springs.damping_ratio) ** 2


@large_kernel
def contact_forces(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, scratch: Scratch,
    reactions: Reactions, kept: bool, start: int, stop: int,
) -> float:  # fmt: skip
    """Compute the contact forces of pairs from start to before stop; return the largest square of a rate [1/s2].

    Writes to bodies, pairs, scratch and reactions.
    """
    fastest = 0.0
    for pair in range(start, stop):
        fastest = max(fastest, contact_force(pair, bodies, cores, planes, pairs, laws, step, scratch, reactions, kept))
    return fastest


@large_kernel
def forces_across_partitions(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, scratch: Scratch,
    reactions: Reactions, partition: Partition,
) -> float:  # fmt: skip
    """Compute the contact forces of a partition's pairs with bodies of later partitions, and keep them.

    Returns as contact_forces. Writes to bodies, pairs, scratch and reactions.
    """
    fastest = 0.0
    for k in range(len(partition.outgoing)):
        pair = partition.outgoing[k]
        rate = contact_forces(bodies, cores, planes, pairs, laws, step, scratch, reactions, True, pair, pair + 1)
        fastest = max(fastest, rate)
    return fastest


@large_kernel
def forces_within_partition(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, step: Step, scratch: Scratch,
    reactions: Reactions, partition: Partition,
) -> float:  # fmt: skip
    """Sum up the contact forces on the bodies of a partition, once those across partitions are known.

    Sums run in the order of the pairs, in one partition as in many. Returns as contact_forces.
    Writes to bodies, pairs, scratch and reactions.
    """
    gather_reactions(bodies, pairs, reactions, partition)
    fastest, start = 0.0, partition.first_pair
    for k in range(len(partition.outgoing)):
        pair = partition.outgoing[k]
        rate = contact_forces(bodies, cores, planes, pairs, laws, step, scratch, reactions, False, start, pair)
        fastest, start = max(fastest, rate), pair + 1
        if pairs.overlap[pair] > 0.0:
            add_wrench(bodies, pairs.first[pair], -1.0, row(reactions.force, pair), row(reactions.first_torque, pair))
    rate = contact_forces(
        bodies, cores, planes, pairs, laws, step, scratch, reactions, False, start, partition.last_pair
    )
    return max(fastest, rate)


@kernel
def gather_reactions(bodies: Bodies, pairs: Pairs, reactions: Reactions, partition: Partition) -> None:
    """Begin the sums of a partition's bodies with what pairs of earlier partitions do to them. Writes to bodies."""
    bodies.force[partition.start : partition.stop] = 0.0
    bodies.torque[partition.start : partition.stop] = 0.0
    for k in range(len(partition.incoming)):
        pair = partition.incoming[k]
        if pairs.overlap[pair] > 0.0:
            add_wrench(bodies, pairs.second[pair], 1.0, row(reactions.force, pair), row(reactions.second_torque, pair))
