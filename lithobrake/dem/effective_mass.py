"""What forces and couples meet of bodies at a contact: one over a mass or a moment of inertia."""

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.arrays import Bodies
from lithobrake.dem.vectors import Vector, cross, dot, times


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
