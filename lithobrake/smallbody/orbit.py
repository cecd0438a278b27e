"""How the other body of a binary moves: on a circle in the equatorial plane.

A distance of zero stands for no partner.
"""

from typing import Any, Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.compilation.compiled import kernel
from lithobrake.smallbody.arrays import Floats
from lithobrake.smallbody.turning import Turning, into_body

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
