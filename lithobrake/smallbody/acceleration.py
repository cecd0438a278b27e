"""The acceleration that a flight feels in the turning frame: gravity, rotation, and the partner of a binary."""

from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.smallbody.arrays import Floats, Integers
from lithobrake.smallbody.attraction import Gravity, Workspace, attract
from lithobrake.smallbody.orbit import Orbit
from lithobrake.smallbody.polyhedron_gravity import PULL_X
from lithobrake.smallbody.simd import LANES
from lithobrake.smallbody.turning import Turning, block_into_body, pull_out_of_body


class Dynamics(NamedTuple):
    """What may differ between flights that share the shapes, each of shape [flight_count]."""

    orbit: Orbit[Floats]  # of the partner
    strength: Floats  # G density of the body [1/s2]
    spin_rate: Floats  # [rad/s]
    partner_strength: Floats  # G density of its partner [1/s2]
    parameter: Floats  # G mass of both [m3/s2]
    escape_radius: Floats  # [m]
    first_step: Floats  # [s]
    length_tolerance: Floats  # what a step may be wrong by in position [m]
    speed_tolerance: Floats  # the same in velocity [m/s]

    def of_flights(self, piece: slice) -> "Dynamics":
        """Those of some flights."""
        orbit = Orbit(*(array[piece] for array in self.orbit))
        return Dynamics(orbit, *(array[piece] for array in self[1:]))


class Forces(NamedTuple):
    """All that accelerates flights."""

    gravity: Gravity
    partner_gravity: Gravity
    dynamics: Dynamics
    turning: Turning  # of the body against the frame


@large_kernel
def accelerate(
    state: Floats,
    derivative: Floats,
    stage: int,
    count: int,
    lane: Floats,
    scratch: Workspace,
    forces: Forces,
    when: Floats,
    flight: Integers,
) -> None:
    """Write derivative [stage, 6, lane] of state [6, lane] of the flights [lane] at the times when [lane] [s].

    lane and scratch are overwritten (see attraction.attract).
    """
    dynamics = forces.dynamics
    for i in range(3):
        for j in range(count):
            lane[i * LANES + j] = state[i, j]
    turns = len(forces.turning.states) > 0
    if turns:
        block_into_body(lane, count, forces.turning, when, scratch.turn)
    attract(lane, count, scratch, forces.gravity)
    if turns:
        pull_out_of_body(lane, count, scratch.turn)
    for j in range(count):
        strength, spin = dynamics.strength[flight[j]], dynamics.spin_rate[flight[j]]
        for i in range(3):
            derivative[stage, i, j] = state[3 + i, j]
            derivative[stage, 3 + i, j] = strength * lane[(PULL_X + i) * LANES + j]
        derivative[stage, 3, j] += spin * (spin * state[0, j] + 2.0 * state[4, j])
        derivative[stage, 4, j] += spin * (spin * state[1, j] - 2.0 * state[3, j])
    # Either all flights have a partner or none has.
    if dynamics.orbit.distance[0] > 0.0:
        _add_partner(state, derivative, stage, count, lane, scratch, forces, when, flight)


@large_kernel
def _add_partner(
    state: Floats,
    derivative: Floats,
    stage: int,
    count: int,
    lane: Floats,
    scratch: Workspace,
    forces: Forces,
    when: Floats,
    flight: Integers,
) -> None:
    """Add the partner's attraction, less the one that it has on the body whose centre the frame follows."""
    orbit, turn = forces.dynamics.orbit, scratch.turn
    # Where it always shows the same face, its own turn is that of its place but for a constant.
    locked, ahead = orbit.swing[0] == orbit.rate[0], orbit.attitude[0] - orbit.angle[0]
    c, s = np.cos(ahead), np.sin(ahead)
    for j in range(count):
        f = flight[j]
        place = orbit.angle[f] + orbit.rate[f] * when[j]
        along, across = np.cos(place), np.sin(place)
        turn[0, j], turn[1, j], turn[2, j], turn[3, j] = along, across, c * along - s * across, s * along + c * across
        if not locked:
            facing = orbit.attitude[f] + orbit.swing[f] * when[j]
            turn[2, j], turn[3, j] = np.cos(facing), np.sin(facing)
        x, y = state[0, j] - orbit.distance[f] * along, state[1, j] - orbit.distance[f] * across
        lane[j], lane[LANES + j] = turn[2, j] * x + turn[3, j] * y, turn[2, j] * y - turn[3, j] * x
        lane[2 * LANES + j] = state[2, j]
    attract(lane, count, scratch, forces.partner_gravity)
    for j in range(count):
        strength, pull = forces.dynamics.partner_strength[flight[j]], orbit.pull[flight[j]]
        x, y = lane[PULL_X * LANES + j], lane[(PULL_X + 1) * LANES + j]
        derivative[stage, 3, j] += strength * (turn[2, j] * x - turn[3, j] * y) - pull * turn[0, j]
        derivative[stage, 4, j] += strength * (turn[3, j] * x + turn[2, j] * y) - pull * turn[1, j]
        derivative[stage, 5, j] += strength * lane[(PULL_X + 2) * LANES + j]


@kernel
def has_escaped(state: Floats, j: int, dynamics: Dynamics, flight: int, time: float) -> bool:
    """Beyond the escape radius, moving outwards, with positive two-body energy against the common centre of mass."""
    spin, orbit = dynamics.spin_rate[flight], dynamics.orbit
    x, y, z = state[0, j], state[1, j], state[2, j]
    u, v, w = state[3, j] - spin * y, state[4, j] + spin * x, state[5, j]
    if orbit.distance[flight] > 0.0:
        # The common centre lies between the two and goes round with the partner.
        place = orbit.angle[flight] + orbit.rate[flight] * time
        apart = orbit.mass_fraction[flight] * orbit.distance[flight]
        c, s = np.cos(place), np.sin(place)
        x, y = x - apart * c, y - apart * s
        u, v = u + orbit.drift[flight] * s, v - orbit.drift[flight] * c
    r = np.sqrt(x * x + y * y + z * z)
    outward = x * u + y * v + z * w > 0.0
    unbound = 0.5 * (u * u + v * v + w * w) > dynamics.parameter[flight] / r
    return r > dynamics.escape_radius[flight] and outward and unbound
