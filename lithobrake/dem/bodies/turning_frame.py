"""Free motion in a frame that turns at a constant rate, such as that of the ground of a small body.

The field is uniform: gravity at the place, the centrifugal acceleration included, as what rests there feels it. Over a
bed both change by some 1e-4 of themselves. Positions, velocities and spins are those against the frame.
"""

import numpy as np

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Bodies
from lithobrake.dem.bodies.orientation import stand, turned
from lithobrake.dem.bodies.vectors import add, cross, dot, minus, plus, put, row, scaled, times
from lithobrake.vocabulary.array_types import Vector

# Angle [rad] below which the closed form takes series, whose next terms are below rounding.
SMALL_ANGLE = 0.25
# Below this angle [rad] terms of its third power, and of its second in what an acceleration adds, are below rounding.
TINY_ANGLE = 1e-6
# Angle [rad] by which the frame turns before the spin of a body is told: of many short ways none alone is.
TOLD_ANGLE = 1e-6


@kernel
def arc_factors(angle: float) -> tuple[float, float, float, float]:
    """Return sin x / x, (1 - cos x) / x^2, (x - sin x) / x^3 and (x^2 / 2 - 1 + cos x) / x^4 of an angle x [rad]."""
    square = angle * angle
    if angle < SMALL_ANGLE:
        third = (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0 * (1.0 - square / 110.0)))) / 6.0
        fourth = (1.0 - square / 30.0 * (1.0 - square / 56.0 * (1.0 - square / 90.0 * (1.0 - square / 132.0)))) / 24.0
        return 1.0 - square * third, 0.5 - square * fourth, third, fourth
    first, second = np.sin(angle) / angle, (1.0 - np.cos(angle)) / square
    return first, second, (1.0 - first) / square, (0.5 - second) / square


@kernel
def coasted(velocity: Vector, along: Vector, time: float, rotation: Vector) -> tuple[Vector, Vector]:
    """Return the way [m] and the velocity [m/s] after a time [s] under a steady acceleration [m/s2], exactly.

    rotation: of the frame [rad/s]. dv/dt = a - 2 w x v: about w the velocity turns as that of
    a charge in crossed fields.
    """
    twice = scaled(2.0, rotation)
    once, bent = cross(twice, velocity), cross(twice, along)
    again, square = cross(twice, once), time * time
    angle_squared = square * dot(twice, twice)
    if angle_squared < TINY_ANGLE * TINY_ANGLE:
        turning = plus(scaled(-time, once), scaled(0.5 * square, minus(again, bent)))
        half = plus(scaled(-0.5 * time, once), scaled(square / 6.0, minus(again, bent)))
        way = plus(scaled(time, plus(velocity, half)), scaled(0.5 * square, along))
        return way, plus(plus(velocity, scaled(time, along)), turning)
    first, second, third, fourth = arc_factors(angle_squared**0.5)
    bent_again = cross(twice, bent)
    after = plus(plus(velocity, scaled(time, along)), scaled(-time * first, once))
    after = plus(after, scaled(square * second, minus(again, bent)))
    after = plus(after, scaled(square * time * third, bent_again))
    way = plus(velocity, plus(scaled(-time * second, once), scaled(square * third, again)))
    fall = plus(scaled(0.5, along), plus(scaled(-time * third, bent), scaled(square * fourth, bent_again)))
    return plus(scaled(time, way), scaled(square, fall)), after


@kernel
def bulge(before: Vector, after: Vector, along: Vector, time: float, rate: float) -> float:
    """Return a bound on how much faster [m/s] a body is on its way than at both ends of it.

    rate: of the frame [rad/s]. The velocity follows an arc, which leaves its chord by less than a quarter of the angle
    times that; speed itself grows by no more than the acceleration.
    """
    change, angle = minus(after, before), 2.0 * rate * time
    limit = time * dot(along, along) ** 0.5
    return min(limit, 0.25 * angle * dot(change, change) ** 0.5) if angle < 1.0 else limit


@kernel
def inertia_times(bodies: Bodies, body: int, spin: Vector) -> Vector:
    """Return the angular momentum [kg m2/s] of a body at a spin [rad/s]."""
    m = bodies.inverse_inertia[body]
    # From the inverse inertia, which is symmetric, by its cofactors.
    rows = (m[0, 0], m[0, 1], m[0, 2]), (m[0, 1], m[1, 1], m[1, 2]), (m[0, 2], m[1, 2], m[2, 2])
    first, second, third = cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])
    across = plus(plus(scaled(spin[0], first), scaled(spin[1], second)), scaled(spin[2], third))
    return scaled(1.0 / dot(rows[0], first), across)


@kernel
def with_frame(bodies: Bodies, body: int, sign: float, rotation: Vector) -> None:
    """Add the angular momentum that a body has by turning with the frame, as often as `sign` says. Writes to bodies."""
    add(bodies.angular_momentum, body, sign, inertia_times(bodies, body, rotation))


@kernel
def precess(bodies: Bodies, body: int, time: float, rotation: Vector) -> None:
    """Tell the spin of a body that the frame has turned for a short time [s], to the first order. Writes to bodies.

    From Euler's equations of L = I (s + w) in the frame, dL/dt = -w x L, with I turning along with the body.
    """
    momentum = row(bodies.angular_momentum, body)
    spin, by_frame = times(bodies.inverse_inertia, body, momentum), inertia_times(bodies, body, rotation)
    change = plus(cross(plus(momentum, by_frame), rotation), cross(by_frame, spin))
    change = plus(change, inertia_times(bodies, body, cross(spin, rotation)))
    add(bodies.angular_momentum, body, time, change)


@kernel
def turn_in_frame(bodies: Bodies, body: int, spin: Vector, time: float, rotation: Vector) -> None:
    """Turn a body by a spin against the stars [rad/s] for a time [s], and the frame under it. Writes to bodies."""
    q, back = bodies.quaternion, scaled(-1.0, rotation)
    among_stars = turned((q[body, 0], q[body, 1], q[body, 2], q[body, 3]), spin, time)
    stand(bodies, body, turned(among_stars, back, time))
    put(bodies.angular_momentum, body, turned_about(row(bodies.angular_momentum, body), back, time))
    put(bodies.half_spin, body, plus(spin, back))


@kernel
def turned_about(vector: Vector, spin: Vector, time: float) -> Vector:
    """Return a vector after turning at a spin [rad/s] for a time [s], exactly."""
    first, second, _, _ = arc_factors(time * dot(spin, spin) ** 0.5)
    once = cross(spin, vector)
    return plus(vector, plus(scaled(time * first, once), scaled(time * time * second, cross(spin, once))))


@kernel
def precession(slenderness: float, spin: float, rate: float) -> float:
    """Return a bound on how fast a free body changes its spin against a frame of that rate [rad/s2].

    slenderness: its largest over its smallest moment of inertia; spin: of its own [rad/s].
    """
    # From Euler's equations in the frame: I ds/dt = I (s x w) - s x I w - w x I w and what turns I s without changing
    # its size.
    return slenderness * rate * (2.0 * spin + rate)
