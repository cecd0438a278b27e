"""The Hertz spring along the normal: its stiffness at an overlap, the dashpot beside it, and the force they make.

A dashpot never makes a point pull: restitution.py counts on that.

Source: [Hertz-1882].
"""

from typing import NamedTuple

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Bodies, Pairs
from lithobrake.dem.bodies.vectors import arm_to, cross, dot, minus, plus, row, scaled
from lithobrake.dem.law.contact_motion import RelativeMotion, point_velocity
from lithobrake.dem.law.restitution import PairLaw
from lithobrake.dem.narrow_phase.contact_patch import Contact
from lithobrake.dem.narrow_phase.patch_energy import DEEP_EDGES
from lithobrake.dem.narrow_phase.scratch import Patch
from lithobrake.vocabulary.array_types import Vector


class ContactSprings(NamedTuple):
    secant: float  # N/m, elastic force over overlap
    elastic: float  # N
    shear: float  # N/m, stiffness across the normal
    dashpot: float  # N s/m, along the normal
    shear_dashpot: float  # N s/m, across it
    cohesion: float  # N
    radius: float  # m, R*


@kernel
def dashpot_along(law: PairLaw, secant: float, inverse_mass: float, radius: float) -> float:
    """Return the dashpot along the normal [N s/m] of a contact of a secant [N/m], a mass [kg] and a radius R* [m]."""
    if law.viscosity > 0.0:
        # Proportional to D^(1/2): the loss grows with the fifth root of the speed.
        return law.viscosity * secant * (inverse_mass * radius**0.5) ** -0.4
    # With 5/4 of the secant, and so proportional to D^(1/4), the collision is a linear oscillator in a time of its own,
    # and the restitution the same at all speeds (restitution.py).
    return 2.0 * law.damping_ratio * (1.25 * secant * (1.0 / inverse_mass)) ** 0.5


@kernel
def contact_springs(law: PairLaw, overlap: float, flattened: float, motion: RelativeMotion) -> ContactSprings:
    """Return the springs and dashpots of two materials at an elastic overlap [m] on a contact of a radius R* [m]."""
    radius = 1.0 / motion.curvature
    # The root is taken of the product: a length scaled by a power of two then scales every bit.
    root = (overlap * flattened) ** 0.5
    secant = 4.0 / 3.0 * law.young_modulus * root
    dashpot = dashpot_along(law, secant, motion.inverse_mass, radius)
    return ContactSprings(
        secant, secant * overlap, 8.0 * law.shear_modulus * root, dashpot, dashpot * law.shear_damping,
        law.cohesion_force + law.cohesion_line * radius, radius,
    )  # fmt: skip


class NormalLoad(NamedTuple):
    """What the points of a patch do together along their normals."""

    repulsion: float  # N, along the normal of the patch
    total: float  # N, less cohesion
    left: float  # N, to be applied along the normal at the centre: all of it, where the patch is one point
    force: Vector  # N, the rest, on the second
    torque: Vector  # N m, of the rest, on the second about the centroid of the first
    damped: float  # J


@kernel
def repel(weight: float, springs: ContactSprings, speed: float) -> float:
    """Return the repulsion at a point of a patch, which never pulls."""
    return weight * max(0.0, springs.elastic - springs.dashpot * speed)


@kernel
def normal_force(
    pair: int, bodies: Bodies, pairs: Pairs, patch: Patch, contact: Contact, motion: RelativeMotion,
    springs: ContactSprings, time_step: float,
) -> NormalLoad:  # fmt: skip
    first, second, normal = pairs.first[pair], pairs.second[pair], contact.normal
    if contact.points == 1 and patch.family[0] != DEEP_EDGES:
        speed, weight = dot(motion.now, normal), patch.weight[0]
        repulsion = repel(weight, springs, speed)
        # Cohesion is taken off outside the cut-off of `repel`, shared as the repulsion is: it stays the gradient of a
        # potential, and friction is limited by the repulsion that carries it.
        total = repulsion - weight * springs.cohesion
        damped = (weight * springs.elastic - repulsion) * speed * time_step
        return NormalLoad(repulsion, total, total, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), damped)
    repulsion, total, damped, force, torque = 0.0, 0.0, 0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for k in range(contact.points):
        place, outward = row(patch.point, k), row(patch.normal, k)
        arm = minus(place, row(bodies.position, first))
        now = scaled(-1.0, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, first, arm))
        if second >= 0:
            other_arm = arm_to(bodies, second, place)
            now = plus(now, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, second, other_arm))
        speed = dot(now, outward)
        lever = cross(arm, outward)
        # The place where deep edges meet slides along them as the bodies turn, so turning alone changes their overlap.
        if patch.family[k] == DEEP_EDGES:
            turning = minus(row(bodies.spin_predicted, second), row(bodies.spin_predicted, first))
            speed += dot(turning, row(patch.couple, k))
            lever = plus(lever, row(patch.couple, k))
        pushes = repel(patch.weight[k], springs, speed)
        damped += (patch.weight[k] * springs.elastic - pushes) * speed * time_step
        along = dot(outward, normal)
        repulsion += pushes * along
        pushes -= patch.weight[k] * springs.cohesion
        force, torque = plus(force, scaled(pushes, outward)), plus(torque, scaled(pushes, lever))
        total += pushes * along
    return NormalLoad(repulsion, total, 0.0, force, torque, damped)
