"""The force of one contact: where it touches, how it moves, its Hertz spring, its friction, its resistance to turning.

The parts are, in the order of `contact_force`: narrow_phase/contact_patch.py, contact_motion.py, hertz_spring.py,
coulomb_friction.py, rolling_resistance.py.

Source: [Landings-PCE], Eqs 1 to 9, with the shear modulus of [Mindlin-1949].
"""

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import DAMPING, FRICTION, ROLLING, Bodies, Pairs, Reactions, Step
from lithobrake.dem.bodies.vectors import add, cross, dot, minus, plus, put, row, scaled, way_between
from lithobrake.dem.law.contact_motion import relative_motion
from lithobrake.dem.law.coulomb_friction import friction_force, resist_twisting
from lithobrake.dem.law.hertz_spring import ContactSprings, contact_springs, normal_force
from lithobrake.dem.law.restitution import law_between
from lithobrake.dem.law.rolling_resistance import resist_rolling
from lithobrake.dem.law.tangential_spring import stored
from lithobrake.dem.law.yielding import ElasticPart, yield_to
from lithobrake.dem.narrow_phase.contact_patch import Contact, find_contact
from lithobrake.dem.narrow_phase.patch_energy import patch_tilt_stiffness
from lithobrake.dem.narrow_phase.scratch import System
from lithobrake.vocabulary.array_types import Vector


@kernel
def contact_force(pair: int, system: System, step: Step, kept: bool) -> float:
    """Compute the contact force of one pair, and add it to its members or keep it in the reactions.

    Returns the square [1/s2] of the rate of its spring or dashpot, 0 where nothing touches.
    Writes to system.
    """
    bodies, cores, planes, pairs, laws, scratch, reactions = system
    patch, first = scratch.patch, pairs.first[pair]
    if pairs.feature_count[pair] == 0:
        end_contact(pair, pairs)
        return 0.0
    contact = find_contact(pair, bodies, cores, planes, pairs, scratch)
    if contact.points == 0:
        end_contact(pair, pairs)
        return 0.0
    point, normal, time_step = contact.point, contact.normal, step.time_step
    # A force through the centroid turns nothing: it meets the whole mass.
    whole_mass = contact.through_centroids or step.paper_mass
    motion = relative_motion(pair, bodies, pairs, point, normal, whole_mass)
    law = law_between(pair, bodies, planes, pairs, laws)
    elastic = ElasticPart(contact.overlap, 1.0 / motion.curvature)
    if law.yield_pressure > 0.0:
        elastic = yield_to(pair, pairs, contact.overlap, elastic.radius, law)
        if elastic.overlap <= 0.0:
            release_springs(pair, pairs)
            return 0.0
        contact = Contact(contact.points, elastic.overlap, contact.point, contact.normal, contact.through_centroids)
    springs = contact_springs(law, elastic.overlap, elastic.radius, motion)
    load = normal_force(pair, bodies, pairs, patch, contact, motion, springs, time_step)
    pairs.lost[pair, DAMPING] += load.damped
    tangential = friction_force(pair, pairs, normal, law, motion, springs, load.repulsion, time_step)
    central = plus(scaled(load.left, normal), tangential)
    # All forces are summed up about the centroid of the first; `hand_over` takes them to the second.
    torque = plus(load.torque, cross(minus(point, row(bodies.position, first)), central))
    torque = resist_twisting(
        pair, bodies, pairs, patch, contact, law, motion, springs, load.repulsion, torque, time_step
    )
    torque = resist_rolling(pair, bodies, pairs, normal, law, motion, springs, load.repulsion, torque, time_step)
    hand_over(pair, bodies, pairs, reactions, plus(load.force, central), torque, kept)
    pairs.tilt_stiffness[pair] = patch_tilt_stiffness(
        patch, contact.points, point, normal, contact.overlap, springs.secant
    )
    # Last, as friction and rolling turn their springs from the normal that is kept of the step before.
    record_contact(pair, pairs, contact, springs, tangential, load.total)
    # The slope of D^(3/2) is 1.5 times its secant; above half of critical damping the dashpot is the faster of the two.
    damping = springs.dashpot * (motion.inverse_mass / (1.25 * springs.secant)) ** 0.5
    return 1.5 * springs.secant * motion.inverse_mass * max(1.0, damping) ** 2


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
        # Both torques are those of one force at one point, which keeps angular momentum, also through an image.
        second_torque = minus(torque, cross(way_between(bodies, first, second), force))
    if kept:
        put(reactions.force, pair, force)
        put(reactions.first_torque, pair, torque)
        put(reactions.second_torque, pair, second_torque)
    else:
        add_wrench(bodies, first, -1.0, force, torque)
        if second >= 0:
            add_wrench(bodies, second, 1.0, force, second_torque)


@kernel
def record_contact(
    pair: int, pairs: Pairs, contact: Contact, springs: ContactSprings, tangential: Vector, total: float
) -> None:
    """Keep where a pair touches and what its forces are [N]. Writes to pairs."""
    pairs.overlap[pair], pairs.normal_force[pair] = contact.overlap, total
    pairs.elastic_force[pair], pairs.cohesion[pair] = springs.elastic, springs.cohesion
    put(pairs.normal, pair, contact.normal)
    put(pairs.point, pair, contact.point)
    put(pairs.tangential_force, pair, tangential)


@kernel
def end_contact(pair: int, pairs: Pairs) -> None:
    """End a contact, if there was one, of two that are apart: the springs let go, and no dent is left to fill.

    Writes to pairs.
    """
    if pairs.deepest[pair] > 0.0:
        pairs.deepest[pair] = 0.0
    release_springs(pair, pairs)


@kernel
def release_springs(pair: int, pairs: Pairs) -> None:
    """Let go the springs of a contact, if there was one. Writes to pairs."""
    # Most neighbours are apart and stay so: nothing is written for them, and their cache lines stay clean.
    if pairs.overlap[pair] == 0.0:
        return
    spring, roll = row(pairs.spring, pair), row(pairs.roll, pair)
    twisted = stored(pairs.twist[pair] ** 2, pairs.twist_stiffness[pair])
    pairs.lost[pair, FRICTION] += stored(dot(spring, spring), pairs.tangential_stiffness[pair]) + twisted
    pairs.lost[pair, ROLLING] += stored(dot(roll, roll), pairs.roll_stiffness[pair])
    put(pairs.spring, pair, (0.0, 0.0, 0.0))
    put(pairs.tangential_force, pair, (0.0, 0.0, 0.0))
    put(pairs.roll, pair, (0.0, 0.0, 0.0))
    pairs.tangential_stiffness[pair], pairs.roll_stiffness[pair] = 0.0, 0.0
    pairs.twist[pair], pairs.twist_stiffness[pair] = 0.0, 0.0
    pairs.overlap[pair] = 0.0
    pairs.normal_force[pair], pairs.elastic_force[pair], pairs.cohesion[pair] = 0.0, 0.0, 0.0
