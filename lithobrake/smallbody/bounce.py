"""What happens at an impact: the interface, and the hard surface that the field uses.

A bounce is any callable that takes the impacts of many landers and says how they leave. It works in the frame of each
impact: x along the incoming horizontal velocity, z along the outward normal of the ground, y = z cross x.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Impacts:
    """Landers that touch the ground, in the frame of each impact.

    speed       [m/s], [count]
    incidence   angle of the velocity from the inward normal [rad], [count]
    spin        angular velocity [rad/s], [count, 3]
    effective_acceleration   gravity and centrifugal acceleration along the outward normal [m/s2], [count]; below 0 it
                holds a lander
    lander      which of the landers each is, counted as they were given to `hop`, [count]
    """

    speed: NDArray[np.float64]
    incidence: NDArray[np.float64]
    spin: NDArray[np.float64]
    effective_acceleration: NDArray[np.float64]
    lander: NDArray[np.int64]


@dataclass(frozen=True)
class Rebounds:
    """How the landers leave, in the frame of each impact.

    velocity    [m/s], [count, 3]; of a captured lander what it slides on with, of which only x and y are read
    spin        [rad/s], [count, 3]
    captured    the lander stays on the ground, [count]
    outside     the model does not cover this impact, [count]; neither velocity nor captured is then read
    """

    velocity: NDArray[np.float64]
    spin: NDArray[np.float64]
    captured: NDArray[np.bool_]
    outside: NDArray[np.bool_]


Bounce = Callable[[Impacts, np.random.Generator], Rebounds]


@dataclass(frozen=True)
class HardSurface:
    """A point on hard ground: constant restitution along and across the normal, the latter limited by friction.

    The normal velocity v becomes -normal_restitution v. The horizontal one becomes tangential_restitution times itself,
    unless that takes more than friction times the normal impulse. A lander whose rebound rises less than rest_height
    [m] under the effective acceleration is captured; where that points outwards none is. Keep that height above a
    millimetre: flights are not told from rest below a millionth of the body's radius. It slides on with its horizontal
    velocity. Spin is kept: a point has none to change.

    Source: [Tardivel-2014]: an impact as normal restitution and Coulomb friction.
    """

    normal_restitution: float
    tangential_restitution: float = 1.0
    friction: float = np.inf
    rest_height: float = 0.01

    def __post_init__(self) -> None:
        for name in ("normal_restitution", "tangential_restitution"):
            if not 0.0 <= getattr(self, name) <= 1.0:
                raise ValueError(f"{name} is {getattr(self, name)}; it must lie in 0 to 1.")
        for name in ("friction", "rest_height"):
            if not getattr(self, name) >= 0.0:
                raise ValueError(f"{name} is {getattr(self, name)}; it must not be below 0.")

    def __call__(self, impacts: Impacts, random: np.random.Generator) -> Rebounds:
        """Bounce without scatter; `random` is not read."""
        down, along = impacts.speed * np.cos(impacts.incidence), impacts.speed * np.sin(impacts.incidence)
        up, outward = self.normal_restitution * down, impacts.effective_acceleration
        # Without horizontal motion there is nothing to lose, whatever the friction.
        with np.errstate(invalid="ignore", divide="ignore"):
            kept = 1.0 - self.friction * (down + up) / along
            apex = np.where(outward < 0.0, up**2 / (-2.0 * outward), np.inf)
        kept = np.where(along > 0.0, np.maximum(kept, self.tangential_restitution), 0.0)
        velocity = np.stack([kept * along, np.zeros_like(up), up], axis=1)
        captured = apex < self.rest_height
        return Rebounds(velocity, impacts.spin, captured, np.zeros(len(up), dtype=bool))
