"""Motion of rigid bodies: half kick, drift, half kick, with the angular momentum in the world frame as state."""

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Step
from lithobrake.dem.bodies.orientation import turn_by
from lithobrake.dem.bodies.turning_frame import coasted, turn_in_frame, with_frame
from lithobrake.dem.bodies.vectors import add, cross, dot, plus, put, row, scaled, times
from lithobrake.vocabulary.array_types import Vector

# Evaluations of the mid-step spin; the error left after three is of the sixth order in spin times step.
MIDPOINT_ITERATIONS = 3


@kernel
def turned_vector(vector: Vector, half: Vector) -> Vector:
    """Return a vector turned about the axis of `half`, whose length is the tangent of half the angle (Rodrigues)."""
    once = cross(half, vector)
    return plus(vector, scaled(2.0 / (1.0 + dot(half, half)), plus(once, cross(half, once))))


@kernel
def spin_at_mid_step(bodies: Bodies, body: int, momentum: Vector, time_step: float) -> Vector:
    """Return the spin for which the body, turned half a step by it, has that spin under this angular momentum."""
    spin = times(bodies.inverse_inertia, body, momentum)
    for _ in range(MIDPOINT_ITERATIONS):
        square = dot(spin, spin) * time_step * time_step
        # The tangent of a quarter of the angle: the turn is half a step, and `turned_vector` takes that of its half.
        half = scaled(0.25 * time_step * (1.0 + square / 48.0), spin)
        within = times(bodies.inverse_inertia, body, turned_vector(momentum, scaled(-1.0, half)))
        renewed = turned_vector(within, half)
        # Once two iterates agree to the last bit all later ones do, so ending early changes no result.
        if renewed[0] == spin[0] and renewed[1] == spin[1] and renewed[2] == spin[2]:
            break
        spin = renewed
    return spin


@kernel
def turning(step: Step) -> bool:
    """Tell whether the frame turns."""
    return step.rotation[0] != 0.0 or step.rotation[1] != 0.0 or step.rotation[2] != 0.0


@kernel
def rotate(bodies: Bodies, step: Step, body: int) -> None:
    """Turn a body over one step by the spin at mid-step, which follows from the angular momentum held fixed.

    The implicit midpoint is symmetric in time, so the energy of free rotation does not drift. Writes to bodies.
    """
    turns = turning(step)
    if turns:
        with_frame(bodies, body, 1.0, step.rotation)
    momentum = row(bodies.angular_momentum, body)
    if bodies.isotropic[body]:
        spin = times(bodies.inverse_inertia, body, momentum)
    else:
        spin = spin_at_mid_step(bodies, body, momentum, step.time_step)
    if turns:
        turn_in_frame(bodies, body, spin, step.time_step, step.rotation)
        with_frame(bodies, body, -1.0, step.rotation)
    else:
        turn_by(bodies, body, spin, step.time_step)


@large_kernel
def kick(bodies: Bodies, step: Step, start: int, stop: int) -> None:
    """Advance the velocities of bodies start to stop by half a step under the forces at hand. Writes to bodies."""
    half = 0.5 * step.time_step
    for body in range(start, stop):
        add(bodies.velocity, body, half * bodies.inverse_mass[body], row(bodies.force, body))
        # Gravity is an acceleration and not a part of the force, so that free fall has the same bits for every mass.
        add(bodies.velocity, body, half, step.gravity)
        add(bodies.angular_momentum, body, half, row(bodies.torque, body))


@kernel
def surface_speed_bound(bodies: Bodies, body: int) -> float:
    """Return a bound on the speed at which a body's surface comes nearer to anything [m/s]."""
    velocity, spin = row(bodies.velocity, body), row(bodies.half_spin, body)
    return dot(velocity, velocity) ** 0.5 + bodies.turning_radius[body] * dot(spin, spin) ** 0.5


@large_kernel
def drift(bodies: Bodies, step: Step, start: int, stop: int) -> float:
    """Advance bodies start to stop by a step at the half-step velocities and predict the velocities at its end.

    Returns the farthest that the surface of a body may have moved since the neighbour list was made [m], not finite
    where one is lost. Writes to bodies.
    """
    farthest, lost = 0.0, 0.0
    half = 0.5 * step.time_step
    for body in range(start, stop):
        if turning(step):
            way, after = coasted(row(bodies.velocity, body), (0.0, 0.0, 0.0), step.time_step, step.rotation)
            add(bodies.position, body, 1.0, way)
            put(bodies.velocity, body, after)
        else:
            add(bodies.position, body, step.time_step, row(bodies.velocity, body))
        rotate(bodies, step, body)
        bodies.travel[body] += step.time_step * surface_speed_bound(bodies, body)
        # Dashpots act on the velocities at the instant of the new positions, half a step after those that made the
        # move; the last forces carry them there.
        gain = scaled(half * bodies.inverse_mass[body], row(bodies.force, body))
        predicted = plus(row(bodies.velocity, body), plus(gain, scaled(half, step.gravity)))
        put(bodies.velocity_predicted, body, predicted)
        momentum = plus(row(bodies.angular_momentum, body), scaled(half, row(bodies.torque, body)))
        put(bodies.spin_predicted, body, times(bodies.inverse_inertia, body, momentum))
        way = bodies.travel[body] - bodies.travel_listed[body]
        farthest = max(farthest, way)
        # A maximum passes over NaN; zero times what is not finite is NaN.
        lost += 0.0 * way
    return farthest + lost
