"""Motion of rigid bodies: half kick, drift, half kick, with the angular momentum in the world frame as state."""

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Step
from lithobrake.dem.bodies.vectors import add, cross, dot, plus, put, row, scaled, times, transposed_times
from lithobrake.vocabulary.array_types import Floats, Vector

Quaternion = tuple[float, float, float, float]
# Evaluations of the mid-step spin; the error left after three is of the sixth order in spin times step.
MIDPOINT_ITERATIONS = 3


@kernel
def turned(q: Quaternion, spin: Vector, time: float) -> Quaternion:
    """Return the unit quaternion after turning at a spin of the world frame (angle right to the seventh order)."""
    # The tangent of half the angle over the spin, by its series: it needs no trigonometric function, and is no 0 / 0
    # for a body that does not turn.
    square = dot(spin, spin) * time * time
    half = 0.5 * time * (1.0 + square * (1.0 / 12.0 + square / 120.0))
    x, y, z = half * spin[0], half * spin[1], half * spin[2]
    w0, x0, y0, z0 = q
    w1 = w0 - x * x0 - y * y0 - z * z0
    x1 = x0 + x * w0 + y * z0 - z * y0
    y1 = y0 + y * w0 + z * x0 - x * z0
    z1 = z0 + z * w0 + x * y0 - y * x0
    # The product has the right direction and the length of 1 / cos(angle / 2): the division makes it a unit quaternion,
    # and removes the drift of earlier turns.
    norm = 1.0 / (w1 * w1 + x1 * x1 + y1 * y1 + z1 * z1) ** 0.5
    return (w1 * norm, x1 * norm, y1 * norm, z1 * norm)


@kernel
def write_rotation(q: Quaternion, rotation: Floats) -> None:
    """Write the rotation matrix [3, 3], body to world, of a unit quaternion. Writes to rotation."""
    w, x, y, z = q
    rotation[0, 0], rotation[0, 1], rotation[0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    rotation[1, 0], rotation[1, 1], rotation[1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    rotation[2, 0], rotation[2, 1], rotation[2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


@kernel
def write_rotations(quaternions: Floats, rotations: Floats) -> None:
    """Write the rotation matrices [count, 3, 3] of unit quaternions [count, 4]. Writes to rotations."""
    for k in range(len(quaternions)):
        q = (quaternions[k, 0], quaternions[k, 1], quaternions[k, 2], quaternions[k, 3])
        write_rotation(q, rotations[k])


@kernel
def write_spins(rotations: Floats, momenta: Floats, inverse_inertia: Floats, spins: Floats) -> None:
    """Write spins [count, 3], world frame, from angular momenta; inverse_inertia [count, 3, 3] is in the body frame.

    Writes to spins.
    """
    for k in range(len(rotations)):
        within = times(inverse_inertia, k, transposed_times(rotations, k, row(momenta, k)))
        put(spins, k, times(rotations, k, within))


@kernel
def write_matrices(bodies: Bodies) -> None:
    """Write rotation and inverse inertia in the world frame of all bodies. Writes to bodies."""
    write_rotations(bodies.quaternion, bodies.rotation)
    for body in range(len(bodies.mass)):
        write_inverse_inertia(bodies, body)


@kernel
def write_inverse_inertia(bodies: Bodies, body: int) -> None:
    """Turn the inverse inertia of a body into the world frame. Writes to bodies."""
    r, inner, outer = bodies.rotation[body], bodies.inverse_inertia_body[body], bodies.inverse_inertia[body]
    # A multiple of the unit matrix is the same in every frame; turning it would only add round-off.
    if bodies.isotropic[body]:
        for i in range(3):
            put(outer, i, row(inner, i))
        return
    for i in range(3):
        u = r[i, 0] * inner[0, 0] + r[i, 1] * inner[1, 0] + r[i, 2] * inner[2, 0]
        v = r[i, 0] * inner[0, 1] + r[i, 1] * inner[1, 1] + r[i, 2] * inner[2, 1]
        w = r[i, 0] * inner[0, 2] + r[i, 1] * inner[1, 2] + r[i, 2] * inner[2, 2]
        for j in range(i, 3):
            outer[i, j] = u * r[j, 0] + v * r[j, 1] + w * r[j, 2]
            outer[j, i] = outer[i, j]


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
def turn_by(bodies: Bodies, body: int, spin: Vector, time: float) -> None:
    """Turn a body by a spin of the world frame [rad/s] for a time [s]. Writes to bodies."""
    q = bodies.quaternion
    after = turned((q[body, 0], q[body, 1], q[body, 2], q[body, 3]), spin, time)
    q[body, 0], q[body, 1], q[body, 2], q[body, 3] = after
    write_rotation(after, bodies.rotation[body])
    if not bodies.isotropic[body]:
        write_inverse_inertia(bodies, body)
    put(bodies.half_spin, body, spin)


@kernel
def rotate(bodies: Bodies, body: int, time_step: float) -> None:
    """Turn a body over one step by the spin at mid-step, which follows from the angular momentum held fixed.

    The implicit midpoint is symmetric in time, so the energy of free rotation does not drift. Writes to bodies.
    """
    momentum = row(bodies.angular_momentum, body)
    if bodies.isotropic[body]:
        spin = times(bodies.inverse_inertia, body, momentum)
    else:
        spin = spin_at_mid_step(bodies, body, momentum, time_step)
    turn_by(bodies, body, spin, time_step)


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
        add(bodies.position, body, step.time_step, row(bodies.velocity, body))
        rotate(bodies, body, step.time_step)
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
