"""How the members of a pair move against each other where they touch, and what mass forces and couples meet there."""

from typing import NamedTuple

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Bodies, Pairs, curvature_of
from lithobrake.dem.bodies.vectors import arm_to, cross, dot, minus, plus, row, scaled, times
from lithobrake.vocabulary.array_types import Floats, Vector


@kernel
def inverse_mass_at(bodies: Bodies, body: int, arm: Vector, normal: Vector, whole: bool) -> float:
    """Return one over the mass that a force along the normal meets at the contact point, or the whole mass."""
    if whole:
        return bodies.inverse_mass[body]
    turn = cross(arm, normal)
    return bodies.inverse_mass[body] + dot(turn, times(bodies.inverse_inertia, body, turn))


@kernel
def inverse_inertia_along(bodies: Bodies, first: int, second: int, normal: Vector) -> float:
    """Return what a couple along the normal meets of a pair, 1/(kg m2)."""
    inverse = dot(normal, times(bodies.inverse_inertia, first, normal))
    return inverse + dot(normal, times(bodies.inverse_inertia, second, normal)) if second >= 0 else inverse


@kernel
def inverse_inertia_across(bodies: Bodies, first: int, second: int, normal: Vector) -> float:
    """Return what a couple across the normal meets of a pair in the mean of all directions, 1/(kg m2)."""
    inverse = bodies.inverse_inertia
    trace = inverse[first, 0, 0] + inverse[first, 1, 1] + inverse[first, 2, 2]
    if second >= 0:
        trace += inverse[second, 0, 0] + inverse[second, 1, 1] + inverse[second, 2, 2]
    return 0.5 * (trace - inverse_inertia_along(bodies, first, second, normal))


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
    return plus(row(linear, body), cross(row(spin, body), arm))


@kernel
def relative_motion(
    pair: int, bodies: Bodies, pairs: Pairs, point: Vector, normal: Vector, whole_mass: bool
) -> RelativeMotion:
    first, second = pairs.first[pair], pairs.second[pair]
    arm = minus(point, row(bodies.position, first))
    inverse_mass = inverse_mass_at(bodies, first, arm, normal, whole_mass)
    # Dashpots act by the velocity at the instant of the positions; springs stretch by the way of the last step, of
    # which the half-step velocity is the exact mean.
    now = scaled(-1.0, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, first, arm))
    moved = scaled(-1.0, point_velocity(bodies.velocity, bodies.half_spin, first, arm))
    spin = scaled(-1.0, row(bodies.half_spin, first))
    # The frame of the contact turns with the mean of both spins, whichever body is first.
    twist = 0.5 * dot(row(bodies.half_spin, first), normal)
    if second >= 0:
        arm = arm_to(bodies, second, point)
        inverse_mass += inverse_mass_at(bodies, second, arm, normal, whole_mass)
        now = plus(now, point_velocity(bodies.velocity_predicted, bodies.spin_predicted, second, arm))
        moved = plus(moved, point_velocity(bodies.velocity, bodies.half_spin, second, arm))
        spin = plus(spin, row(bodies.half_spin, second))
        twist += 0.5 * dot(row(bodies.half_spin, second), normal)
    return RelativeMotion(inverse_mass, curvature_of(pair, bodies, pairs), now, moved, spin, twist)
