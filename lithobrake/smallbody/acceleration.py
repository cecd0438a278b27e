"""The acceleration that a flight feels in the turning frame: gravity, rotation, and the partner of a binary.

forces, as all kernels here take it: (gravity arrays, G density [1/s2], spin rate [rad/s], gravity arrays of the
partner, its G density [1/s2], its orbit (see partner.Orbit.numbers)).
"""

from typing import Any

import numpy as np

from lithobrake.compiled import kernel, large_kernel
from lithobrake.smallbody.attraction import attract
from lithobrake.smallbody.lanes import LANES
from lithobrake.smallbody.polyhedron import PULL_X


@large_kernel
def accelerate(state: Any, slope: Any, stage: int, count: int, lane: Any, scratch: Any, forces: Any, when: Any) -> None:
    """Write slope [stage, 6, lane] of state [6, lane] at the times when [lane] [s].

    lane and scratch are overwritten (see attraction.attract).
    """
    strength, spin = forces[1], forces[2]
    for i in range(3):
        for j in range(count):
            lane[i * LANES + j] = state[i, j]
    attract(lane, count, scratch, forces[0])
    for j in range(count):
        for i in range(3):
            slope[stage, i, j] = state[3 + i, j]
            slope[stage, 3 + i, j] = strength * lane[(PULL_X + i) * LANES + j]
        slope[stage, 3, j] += spin * (spin * state[0, j] + 2.0 * state[4, j])
        slope[stage, 4, j] += spin * (spin * state[1, j] - 2.0 * state[3, j])
    if forces[5][0] > 0.0:
        _add_partner(state, slope, stage, count, lane, scratch, forces, when)


@large_kernel
def _add_partner(
    state: Any, slope: Any, stage: int, count: int, lane: Any, scratch: Any, forces: Any, when: Any
) -> None:
    """Add the partner's attraction, less the one that it has on the body whose centre the frame follows."""
    gravity, strength = forces[3], forces[4]
    distance, angle, rate, attitude, swing, pull = forces[5][:6]
    turn = scratch[7]
    # Where it always shows the same face, its own turn is that of its place but for a constant.
    c, s = np.cos(attitude - angle), np.sin(attitude - angle)
    for j in range(count):
        place = angle + rate * when[j]
        along, across = np.cos(place), np.sin(place)
        turn[0, j], turn[1, j], turn[2, j], turn[3, j] = along, across, c * along - s * across, s * along + c * across
    if swing != rate:
        for j in range(count):
            facing = attitude + swing * when[j]
            turn[2, j], turn[3, j] = np.cos(facing), np.sin(facing)
    for j in range(count):
        x, y = state[0, j] - distance * turn[0, j], state[1, j] - distance * turn[1, j]
        lane[j], lane[LANES + j] = turn[2, j] * x + turn[3, j] * y, turn[2, j] * y - turn[3, j] * x
        lane[2 * LANES + j] = state[2, j]
    attract(lane, count, scratch, gravity)
    for j in range(count):
        x, y = lane[PULL_X * LANES + j], lane[(PULL_X + 1) * LANES + j]
        slope[stage, 3, j] += strength * (turn[2, j] * x - turn[3, j] * y) - pull * turn[0, j]
        slope[stage, 4, j] += strength * (turn[3, j] * x + turn[2, j] * y) - pull * turn[1, j]
        slope[stage, 5, j] += strength * lane[(PULL_X + 2) * LANES + j]


@kernel
def has_escaped(state: Any, j: int, parameter: float, spin: float, orbit: Any, time: float, radius: float) -> bool:
    """Farther out than radius [m], moving outwards, with positive two-body energy against the common centre of mass.

    parameter: G times the mass of the body and its partner [m3/s2].
    """
    distance, angle, rate, _, _, _, drift, share = orbit
    x, y, z = state[0, j], state[1, j], state[2, j]
    u, v, w = state[3, j] - spin * y, state[4, j] + spin * x, state[5, j]
    if distance > 0.0:
        # The common centre lies between the two and goes round with the partner.
        place = angle + rate * time
        c, s = np.cos(place), np.sin(place)
        x, y = x - share * distance * c, y - share * distance * s
        u, v = u + drift * s, v - drift * c
    r = np.sqrt(x * x + y * y + z * z)
    outward = x * u + y * v + z * w > 0.0
    return r > radius and outward and 0.5 * (u * u + v * v + w * w) > parameter / r
