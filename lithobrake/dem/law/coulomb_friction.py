"""Coulomb friction: a tangential spring and its dashpot across the normal, each within friction times repulsion.

The same holds of the couple about the normal, of a patch that has a width, and of spinning friction. The springs are
clipped in tangential_spring.py.

Source: [Mindlin-1949], for the stiffness across the normal.
"""

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import DAMPING, FRICTION, Bodies, Pairs
from lithobrake.dem.bodies.vectors import dot, plus, put, row, scaled, tangential_part
from lithobrake.dem.law.contact_motion import RelativeMotion, inverse_inertia_along
from lithobrake.dem.law.hertz_spring import ContactSprings
from lithobrake.dem.law.restitution import PairLaw
from lithobrake.dem.law.tangential_spring import spring_force, stored, turned_spring, unloaded
from lithobrake.dem.narrow_phase.contact_patch import Contact
from lithobrake.dem.narrow_phase.patch_energy import spin_radii
from lithobrake.dem.narrow_phase.scratch import Patch
from lithobrake.vocabulary.array_types import Vector


@kernel
def friction_force(
    pair: int, pairs: Pairs, normal: Vector, law: PairLaw, motion: RelativeMotion, springs: ContactSprings,
    repulsion: float, time_step: float,
) -> Vector:  # fmt: skip
    """Return the tangential force on the second body, within the Coulomb limit. Writes to pairs."""
    limit = law.friction * repulsion
    before = turned_spring(row(pairs.spring, pair), row(pairs.normal, pair), normal, motion.twist * time_step)
    slip, rate = scaled(time_step, tangential_part(motion.moved, normal)), tangential_part(motion.now, normal)
    held = spring_force(
        before, pairs.tangential_stiffness[pair], springs.shear, slip, rate, springs.shear_dashpot, limit
    )
    put(pairs.spring, pair, held.spring)
    pairs.tangential_stiffness[pair] = springs.shear
    pairs.lost[pair, FRICTION] += held.slid
    pairs.lost[pair, DAMPING] += held.damped * time_step
    return held.total


@kernel
def resist_twisting(
    pair: int, bodies: Bodies, pairs: Pairs, patch: Patch, contact: Contact, law: PairLaw, motion: RelativeMotion,
    springs: ContactSprings, repulsion: float, torque: Vector, time_step: float,
) -> Vector:  # fmt: skip
    """Return the torque on the second body with the couple about the normal. Writes to pairs.

    A patch of more than one point resists twisting as its points would, each with its part of the tangential spring;
    spinning friction is the same with a lever of that coefficient times the contact radius.
    """
    lever = law.spinning_friction * springs.radius
    square, mean = spin_radii(patch, contact.points, contact.point, contact.normal)
    square += lever * lever
    # A patch that was wide in the last step may hold a couple that has to be let go now that it is a point.
    if not (square > 0.0 or pairs.twist_stiffness[pair] > 0.0):
        return torque
    limit = law.friction * repulsion * mean + repulsion * lever
    before, stiffness_before, stiffness = pairs.twist[pair], pairs.twist_stiffness[pair], springs.shear * square
    spin = dot(motion.spin, contact.normal)
    angle = spin * time_step
    couple = min(max(unloaded(stiffness_before, stiffness) * before - stiffness * angle, -limit), limit)
    # Energy that the spring had, and the work of its mean couple over the turn: what is not stored afterwards was lost
    # by sliding or by a change of stiffness.
    given = stored(before * before, stiffness_before) - 0.5 * (before + couple) * angle
    pairs.twist[pair], pairs.twist_stiffness[pair] = couple, stiffness
    inverse_inertia = inverse_inertia_along(bodies, pairs.first[pair], pairs.second[pair], contact.normal)
    dashpot = 2.0 * law.damping_ratio * (stiffness / inverse_inertia) ** 0.5
    # The dashpot counts within the limit too: no part of friction passes Coulomb's.
    total = min(max(couple - dashpot * spin, -limit), limit)
    pairs.lost[pair, FRICTION] += given - stored(couple * couple, stiffness)
    pairs.lost[pair, DAMPING] += (couple - total) * angle
    return plus(torque, scaled(total, contact.normal))
