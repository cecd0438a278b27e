"""Contact law of a pair: Hertz with damping that gives the entered restitution, cohesion, friction and rolling.

Source: [Landings-PCE], Eqs 1 to 9, with the shear modulus of [Mindlin-1949]; the no-tension end of contact and
the damping that makes up for it, see material.restitution_of.
"""

from typing import NamedTuple

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.arrays import Bodies, Floats, Pairs
from lithobrake.dem.effective_mass import inverse_mass_at
from lithobrake.dem.patch_energy import DEEP_EDGES
from lithobrake.dem.rolling_resistance import end_couples
from lithobrake.dem.scratch import Patch
from lithobrake.dem.tangential_spring import spring_force, stored, tangential_part, turned_spring
from lithobrake.dem.vectors import Vector, cross, dot, minus, plus, put, row, scaled

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
    bodies: Bodies, patch: Patch, count: int, first: int, second: int, motion: RelativeMotion, normal: Vector,
    elastic: float, cohesion: float, dashpot: float, time_step: float,
) -> NormalLoad:  # fmt: skip
    """Return the normal forces at the points of a patch: repulsion less cohesion."""
    if count == 1 and patch.family[0] != DEEP_EDGES:
        speed, weight = dot(motion.now, normal), patch.weight[0]
        repulsion = repel(weight, elastic, dashpot, speed)
        total = repulsion - weight * cohesion
        damped = (weight * elastic - repulsion) * speed * time_step
        return NormalLoad(repulsion, total, total, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), damped)
    repulsion, total, damped, force, torque = 0.0, 0.0, 0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for k in range(count):
        place, outward = row(patch.point, k), row(patch.normal, k)
        arm = minus(place, row(bodies.position, first))
        now = scaled(-1.0, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, first, arm))
        if second >= 0:
            other_arm = minus(place, row(bodies.position, second))
            now = plus(now, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, second, other_arm))
        speed = dot(now, outward)
        lever = cross(arm, outward)
        if patch.family[k] == DEEP_EDGES:
            turning = minus(row(bodies.spin_predicted, second), row(bodies.spin_predicted, first))
            speed += dot(turning, row(patch.couple, k))
            lever = plus(lever, row(patch.couple, k))
        pushes = repel(patch.weight[k], elastic, dashpot, speed)
        damped += (patch.weight[k] * elastic - pushes) * speed * time_step
        along = dot(outward, normal)
        repulsion += pushes * along
        pushes -= patch.weight[k] * cohesion
        force, torque = plus(force, scaled(pushes, outward)), plus(torque, scaled(pushes, lever))
        total += pushes * along
    return NormalLoad(repulsion, total, 0.0, force, torque, damped)


@kernel
def friction_force(
    pair: int, pairs: Pairs, normal: Vector, motion: RelativeMotion, limit: float, stiffness: float, dashpot: float,
    time_step: float,
) -> Vector:  # fmt: skip
    """Return the tangential force on the second body, within the Coulomb limit. Writes to pairs."""
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
def record_contact(
    pair: int, pairs: Pairs, overlap: float, point: Vector, normal: Vector, tangential: Vector, total: float,
    elastic: float, cohesion: float,
) -> None:  # fmt: skip
    """Keep where a pair touches and what its forces are [N]. Writes to pairs."""
    pairs.overlap[pair], pairs.normal_force[pair], pairs.elastic_force[pair] = overlap, total, elastic
    pairs.cohesion[pair] = cohesion
    put(pairs.normal, pair, normal)
    put(pairs.point, pair, point)
    put(pairs.tangential_force, pair, tangential)


@kernel
def end_contact(pair: int, pairs: Pairs) -> None:
    """End a contact, if there was one: the springs let go. Writes to pairs."""
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
