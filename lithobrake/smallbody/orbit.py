"""How the other body of a binary moves: on a circle in the equatorial plane.

All kernels take its motion as (distance [m], angle, turn, attitude, swing [rad], pull [m/s2]): the longitude of its
centre at the start of a step and its change over the step, the same for its own prime meridian, and the acceleration
that it gives to the body whose frame flights use. A distance of zero stands for no partner.
"""

from dataclasses import astuple, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.compiled import kernel


@dataclass(frozen=True)
class Orbit:
    """How a partner moves in the turning frame of the body that holds it; each entry a number, or one a flight.

    distance   of the centres [m]
    angle      longitude of the partner's centre at time 0 [rad] and rate [rad/s] of it
    attitude   longitude at which the partner's own x axis points at time 0 [rad] and swing [rad/s] of it
    pull       acceleration of the body's centre towards the partner [m/s2]
    drift      speed of the body's centre round the common centre of mass [m/s]
    mass_fraction   of the partner in both masses
    """

    distance: Any = 0.0
    angle: Any = 0.0
    rate: Any = 0.0
    attitude: Any = 0.0
    swing: Any = 0.0
    pull: Any = 0.0
    drift: Any = 0.0
    mass_fraction: Any = 0.0

    @property
    def numbers(self) -> tuple[Any, ...]:
        """The numbers in the order in which kernels take them."""
        return astuple(self)

    def seen_from_partner(
        self, position: ArrayLike, velocity: ArrayLike, time: ArrayLike
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


@kernel
def motion_over(orbit: Any, time: float, step: float) -> Any:
    """Motion of the partner over a step that begins at a time [s]; orbit: Orbit.numbers."""
    return orbit[0], orbit[1] + orbit[2] * time, orbit[2] * step, orbit[3] + orbit[4] * time, orbit[4] * step


@kernel
def into_partner(point: Any, motion: Any, fraction: float) -> None:
    """Turn a point [3] of the body's frame, at a fraction of the step, into the partner's frame."""
    distance, angle, turn, attitude, swing = motion
    if distance == 0.0:
        return
    place = angle + fraction * turn
    x, y = point[0] - distance * np.cos(place), point[1] - distance * np.sin(place)
    facing = attitude + fraction * swing
    c, s = np.cos(facing), np.sin(facing)
    point[0], point[1] = c * x + s * y, c * y - s * x
