"""How bodies stand in the world: quaternions, rotation matrices and inertias, and turns of them."""

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Bodies
from lithobrake.dem.bodies.vectors import dot, put, row, times, transposed_times
from lithobrake.vocabulary.array_types import Floats, Vector

Quaternion = tuple[float, float, float, float]


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
def turn_by(bodies: Bodies, body: int, spin: Vector, time: float) -> None:
    """Turn a body by a spin of the world frame [rad/s] for a time [s]. Writes to bodies."""
    q = bodies.quaternion
    stand(bodies, body, turned((q[body, 0], q[body, 1], q[body, 2], q[body, 3]), spin, time))
    put(bodies.half_spin, body, spin)


@kernel
def stand(bodies: Bodies, body: int, quaternion: Quaternion) -> None:
    """Stand a body in an orientation. Writes to bodies."""
    q = bodies.quaternion
    q[body, 0], q[body, 1], q[body, 2], q[body, 3] = quaternion
    write_rotation(quaternion, bodies.rotation[body])
    if not bodies.isotropic[body]:
        write_inverse_inertia(bodies, body)
