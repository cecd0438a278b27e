"""What a landing follows from."""

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from lithobrake.dem import Material
from lithobrake.touchdown.bed import ContactModel

Floats = NDArray[np.float64]
Vector = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class Landing:
    """What a landing follows from, beside the bed and the lander. The frame is the bed's, z out of the mean surface.

    Raises ValueError for values outside their ranges.
    """

    grain: Material
    speed: float  # m/s
    incidence: float  # rad, of the velocity from the inward normal
    azimuth: float  # rad, of the horizontal velocity, from +x toward +y
    place: tuple[float, float]  # m, where the lander's centre of mass starts, along x and y
    orientation: tuple[float, float, float, float]  # w, x, y, z
    spin: Vector  # rad/s, along the world's axes
    gravity: Vector  # m/s2
    time_limit: float  # s, simulated, after the lander was released
    # m: the lander is followed until it rests, or leaves for a hop that rises higher over the ground. None: it is
    # followed until it leaves the ground or is captured.
    hop_height: float | None = None
    contact: ContactModel = field(default_factory=ContactModel)

    def __post_init__(self) -> None:
        for name, fine, allowed in (
            ("speed", 0.0 < self.speed < math.inf, "a finite value above 0 m/s"),
            ("incidence", 0.0 <= self.incidence < 0.5 * math.pi, "0 <= value < pi/2 rad"),
            ("azimuth", math.isfinite(self.azimuth), "a finite angle"),
            ("gravity", all(math.isfinite(g) for g in self.gravity), "three finite numbers"),
            ("spin", all(math.isfinite(w) for w in self.spin), "three finite numbers"),
            ("orientation", 0.0 < math.hypot(*self.orientation) < math.inf, "four finite numbers, not all zero"),
            ("time_limit", 0.0 < self.time_limit < math.inf, "a finite value above 0 s"),
            ("hop_height", self.hop_height is None or 0.0 < self.hop_height < math.inf, "a finite height above 0 m"),
        ):
            if not fine:
                raise ValueError(f"Landing.{name} is {getattr(self, name)!r}; allowed is {allowed}: change it")

    @property
    def velocity(self) -> Floats:
        """Velocity of the lander at the start [m/s]."""
        horizontal = self.speed * math.sin(self.incidence)
        return np.array(
            [
                horizontal * math.cos(self.azimuth),
                horizontal * math.sin(self.azimuth),
                -self.speed * math.cos(self.incidence),
            ]
        )
