"""The acceleration that a flight feels in the turning frame, and how the other body of a binary moves."""

from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.smallbody.attraction import Gravity, Workspace, attract
from lithobrake.smallbody.polyhedron_gravity import PULL_X
from lithobrake.smallbody.rotation import Turning, block_into_body, into_body, pull_out_of_body
from lithobrake.smallbody.simd import LANES
from lithobrake.vocabulary.array_types import Floats, Integers

Entry = TypeVar("Entry", float, Floats)


class Orbit(NamedTuple, Generic[Entry]):
    """How a partner moves in the turning frame of the body that holds it; each entry a number, or one a flight.

    distance   of the centres [m]
    angle      longitude of the partner's centre at time 0 [rad] and rate [rad/s] of it
    attitude   longitude at which the partner's own x axis points at time 0 [rad] and swing [rad/s] of it
    pull       acceleration of the body's centre towards the partner [m/s2]
    drift      speed of the body's centre round the common centre of mass [m/s]
    mass_fraction   of the partner in both masses
    """

    distance: Entry
    angle: Entry
    rate: Entry
    attitude: Entry
    swing: Entry
    pull: Entry
    drift: Entry
    mass_fraction: Entry

    def seen_from_partner(
        self: "Orbit[Any]", position: ArrayLike, velocity: ArrayLike, time: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """States of the body's turning frame at times [s], shape [count], in the partner's own turning frame.

        position [m], velocity [m/s], both [count, 3], as are the two results.
        """
        p, v, t = (np.array(given, dtype=np.float64) for given in (position, velocity, time))
        angle = self.angle + self.rate * t
        x, y = self.distance * np.cos(angle), self.distance * np.sin(angle)
        p[..., 0], p[..., 1] = p[..., 0] - x, p[..., 1] - y
        # Velocity against the partner's ground: less the centre's, less the turning about it.
        v[..., 0] += self.rate * y + self.swing * p[..., 1]
        v[..., 1] -= self.rate * x + self.swing * p[..., 0]
        turn = self.attitude + self.swing * t
        c, s = np.cos(turn), np.sin(turn)
        for array in (p, v):
            x, y = array[..., 0].copy(), array[..., 1].copy()
            array[..., 0], array[..., 1] = c * x + s * y, c * y - s * x
        return p, v

    def seen_from_body(
        self: "Orbit[Any]", position: ArrayLike, velocity: ArrayLike, time: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The reverse of `seen_from_partner`."""
        p, v, t = (np.array(given, dtype=np.float64) for given in (position, velocity, time))
        turn, angle = self.attitude + self.swing * t, self.angle + self.rate * t
        c, s = np.cos(turn), np.sin(turn)
        for array in (p, v):
            x, y = array[..., 0].copy(), array[..., 1].copy()
            array[..., 0], array[..., 1] = c * x - s * y, s * x + c * y
        x, y = self.distance * np.cos(angle), self.distance * np.sin(angle)
        v[..., 0] -= self.rate * y + self.swing * p[..., 1]
        v[..., 1] += self.rate * x + self.swing * p[..., 0]
        p[..., 0], p[..., 1] = p[..., 0] + x, p[..., 1] + y
        return p, v


class Motion(NamedTuple):
    """How a ground moves over a step in the turning frame of the body: the partner's, or its own."""

    distance: float  # of the centres [m]; 0 for the body itself
    angle: float  # longitude of its centre at the start [rad]
    turn: float  # change of that over the step [rad]
    attitude: float  # longitude at which its own x axis points at the start [rad]
    swing: float  # change of that over the step [rad]
    turning: Turning  # of the body itself
    begin: float  # of the step [s]
    step: float  # [s]


@kernel
def own_motion(turning: Turning, time: float, step: float) -> Motion:
    """Motion of the body's own ground over a step [s] that begins at a time [s]."""
    return Motion(0.0, 0.0, 0.0, 0.0, 0.0, turning, time, step)


@kernel
def motion_over(orbit: Orbit[Floats], flight: int, turning: Turning, time: float, step: float) -> Motion:
    """Motion of a flight's partner over a step [s] that begins at a time [s]; turning: of the body, not of it."""
    rate, swing = orbit.rate[flight], orbit.swing[flight]
    return Motion(
        orbit.distance[flight],
        orbit.angle[flight] + rate * time,
        rate * step,
        orbit.attitude[flight] + swing * time,
        swing * step,
        turning,
        time,
        step,
    )


@kernel
def into_ground(point: Floats, motion: Motion, fraction: float) -> None:
    """Turn a point [3] of the body's turning frame, at a fraction of the step, into the frame of the ground."""
    distance = motion.distance
    if distance == 0.0:
        into_body(point, motion.turning, motion.begin + fraction * motion.step)
        return
    place = motion.angle + fraction * motion.turn
    x, y = point[0] - distance * np.cos(place), point[1] - distance * np.sin(place)
    facing = motion.attitude + fraction * motion.swing
    c, s = np.cos(facing), np.sin(facing)
    point[0], point[1] = c * x + s * y, c * y - s * x


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

    def of_flights(self, which: Integers) -> "Dynamics":
        orbit = Orbit(*(array[which] for array in self.orbit))
        return Dynamics(orbit, *(array[which] for array in self[1:]))


class Forces(NamedTuple):
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
    # Gravity is read in the axes of the body, while states are in axes that turn uniformly.
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
