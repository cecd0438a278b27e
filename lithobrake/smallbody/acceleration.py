"""The acceleration that a flight feels in the turning frame: gravity, rotation, and the partner of a binary.

forces, as all kernels here take it: (gravity arrays, gravity arrays of the partner, worlds). Flights share the shapes;
a row of worlds has what may differ between them, in the columns named here.
"""

from typing import Any

import numpy as np

from lithobrake.compiled import kernel, large_kernel
from lithobrake.smallbody.attraction import attract
from lithobrake.smallbody.polyhedron import PULL_X
from lithobrake.smallbody.simd import LANES

# G density and spin rate of the body, G density of its partner, the partner's orbit (orbit.Orbit.numbers); then what
# a step may be wrong by in position [m] and velocity [m/s], the first step [s], the radius of escape [m] and G mass of
# both [m3/s2].
STRENGTH, SPIN, PARTNER_STRENGTH, ORBIT, LENGTH, SPEED, FIRST_STEP, FAR, PARAMETER = 0, 1, 2, 3, 11, 12, 13, 14, 15
COLUMNS = 16
DISTANCE, ANGLE, RATE, ATTITUDE, SWING, PULL, DRIFT, MASS_FRACTION = 0, 1, 2, 3, 4, 5, 6, 7


@large_kernel
def accelerate(
    state: Any, derivative: Any, stage: int, count: int, lane: Any, scratch: Any, forces: Any, when: Any, flight: Any
) -> None:
    """Write derivative [stage, 6, lane] of state [6, lane] of the flights [lane] at the times when [lane] [s].

    lane and scratch are overwritten (see attraction.attract).
    """
    worlds = forces[2]
    for i in range(3):
        for j in range(count):
            lane[i * LANES + j] = state[i, j]
    attract(lane, count, scratch, forces[0])
    for j in range(count):
        strength, spin = worlds[flight[j], STRENGTH], worlds[flight[j], SPIN]
        for i in range(3):
            derivative[stage, i, j] = state[3 + i, j]
            derivative[stage, 3 + i, j] = strength * lane[(PULL_X + i) * LANES + j]
        derivative[stage, 3, j] += spin * (spin * state[0, j] + 2.0 * state[4, j])
        derivative[stage, 4, j] += spin * (spin * state[1, j] - 2.0 * state[3, j])
    # Either all flights have a partner or none has.
    if worlds[0, ORBIT + DISTANCE] > 0.0:
        _add_partner(state, derivative, stage, count, lane, scratch, forces, when, flight)


@large_kernel
def _add_partner(
    state: Any, derivative: Any, stage: int, count: int, lane: Any, scratch: Any, forces: Any, when: Any, flight: Any
) -> None:
    """Add the partner's attraction, less the one that it has on the body whose centre the frame follows."""
    worlds, turn = forces[2], scratch[7]
    # Where it always shows the same face, its own turn is that of its place but for a constant.
    first = worlds[0, ORBIT:]
    locked = first[SWING] == first[RATE]
    c, s = np.cos(first[ATTITUDE] - first[ANGLE]), np.sin(first[ATTITUDE] - first[ANGLE])
    for j in range(count):
        orbit = worlds[flight[j], ORBIT:]
        place = orbit[ANGLE] + orbit[RATE] * when[j]
        along, across = np.cos(place), np.sin(place)
        turn[0, j], turn[1, j], turn[2, j], turn[3, j] = along, across, c * along - s * across, s * along + c * across
        if not locked:
            facing = orbit[ATTITUDE] + orbit[SWING] * when[j]
            turn[2, j], turn[3, j] = np.cos(facing), np.sin(facing)
        x, y = state[0, j] - orbit[DISTANCE] * along, state[1, j] - orbit[DISTANCE] * across
        lane[j], lane[LANES + j] = turn[2, j] * x + turn[3, j] * y, turn[2, j] * y - turn[3, j] * x
        lane[2 * LANES + j] = state[2, j]
    attract(lane, count, scratch, forces[1])
    for j in range(count):
        strength, pull = worlds[flight[j], PARTNER_STRENGTH], worlds[flight[j], ORBIT + PULL]
        x, y = lane[PULL_X * LANES + j], lane[(PULL_X + 1) * LANES + j]
        derivative[stage, 3, j] += strength * (turn[2, j] * x - turn[3, j] * y) - pull * turn[0, j]
        derivative[stage, 4, j] += strength * (turn[3, j] * x + turn[2, j] * y) - pull * turn[1, j]
        derivative[stage, 5, j] += strength * lane[(PULL_X + 2) * LANES + j]


@kernel
def has_escaped(state: Any, j: int, world: Any, time: float) -> bool:
    """Farther out than FAR, moving outwards, with positive two-body energy against the common centre of mass."""
    spin, orbit = world[SPIN], world[ORBIT:]
    x, y, z = state[0, j], state[1, j], state[2, j]
    u, v, w = state[3, j] - spin * y, state[4, j] + spin * x, state[5, j]
    if orbit[DISTANCE] > 0.0:
        # The common centre lies between the two and goes round with the partner.
        place, apart = orbit[ANGLE] + orbit[RATE] * time, orbit[MASS_FRACTION] * orbit[DISTANCE]
        c, s = np.cos(place), np.sin(place)
        x, y = x - apart * c, y - apart * s
        u, v = u + orbit[DRIFT] * s, v - orbit[DRIFT] * c
    r = np.sqrt(x * x + y * y + z * z)
    outward = x * u + y * v + z * w > 0.0
    return r > world[FAR] and outward and 0.5 * (u * u + v * v + w * w) > world[PARAMETER] / r
