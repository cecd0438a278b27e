"""The other body of a binary: on a circular orbit in the equatorial plane, attracting and in the way.

All kernels take its motion as (distance [m], angle, turn, attitude, swing [rad], pull [m/s2]): the longitude of its
centre at the start of a step and its change over the step, the same for its own prime meridian, and the acceleration
that it gives to the body whose frame flights use. A distance of zero stands for no partner.
"""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.compiled import kernel

if TYPE_CHECKING:
    from lithobrake.smallbody.body import Body


@dataclass(frozen=True)
class Partner:
    """The other body of a binary, seen from the one that holds this: it goes round in the sense of that one's spin.

    body            its shape, mass and spin, about the same direction
    period          of the mutual orbit [s]; the distance follows from it and both masses (Kepler's third law)
    longitude_deg   east longitude of its centre at time 0, in the frame of the body that holds this
    facing_deg      the longitude on the partner that faces that body at time 0, and always where it turns once an orbit
    """

    body: "Body"
    period: float
    longitude_deg: float = 0.0
    facing_deg: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.period) and self.period > 0.0):
            raise ValueError(f"{self.body.name}: the orbit's period is {self.period} s; it must be finite and above 0.")
        if not (math.isfinite(self.longitude_deg) and math.isfinite(self.facing_deg)):
            raise ValueError(
                f"{self.body.name}: longitude_deg is {self.longitude_deg}, facing_deg {self.facing_deg}; both must be "
                "finite."
            )
        if self.body.partner is not None:
            raise ValueError(f"{self.body.name}: a partner has no partner of its own; give it partner=None.")


@dataclass(frozen=True)
class Orbit:
    """How a partner moves in the turning frame of the body that holds it; each entry a number, or one a flight.

    distance   of the centres [m]
    angle      longitude of the partner's centre at time 0 [rad] and rate [rad/s] of it
    attitude   longitude at which the partner's own x axis points at time 0 [rad] and swing [rad/s] of it
    pull       acceleration of the body's centre towards the partner [m/s2]
    drift      speed of the body's centre round the common centre of mass [m/s]
    share      of the partner in both masses
    """

    distance: Any = 0.0
    angle: Any = 0.0
    rate: Any = 0.0
    attitude: Any = 0.0
    swing: Any = 0.0
    pull: Any = 0.0
    drift: Any = 0.0
    share: Any = 0.0

    @classmethod
    def of(cls, body: "Body", parameter: Any = None, spin_rate: Any = None) -> "Orbit":
        """The motion of a body's partner; all zero without one.

        parameter [m3/s2] and spin_rate [rad/s] stand in place of the body's G mass and spin.
        """
        partner = body.partner
        if partner is None:
            return cls()
        parameter = body.gravitational_parameter if parameter is None else parameter
        spin_rate = body.spin_rate if spin_rate is None else spin_rate
        total = parameter + partner.body.gravitational_parameter
        mean_motion = 2.0 * math.pi / partner.period
        distance = (total / mean_motion**2) ** (1.0 / 3.0)
        angle, share = math.radians(partner.longitude_deg), partner.body.gravitational_parameter / total
        return cls(
            distance=distance,
            angle=angle,
            rate=mean_motion - spin_rate,
            attitude=angle + math.pi - math.radians(partner.facing_deg),
            swing=partner.body.spin_rate - spin_rate,
            pull=partner.body.gravitational_parameter / distance**2,
            drift=share * mean_motion * distance,
            share=share,
        )

    @property
    def numbers(self) -> tuple[Any, ...]:
        """The numbers in the order in which kernels take them."""
        return (*(self.distance, self.angle, self.rate, self.attitude, self.swing, self.pull, self.drift, self.share),)

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
