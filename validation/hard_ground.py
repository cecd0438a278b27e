"""Landings on hard ground, as a model of a study: restitution along the normal and along the ground, no friction."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from lithobrake.smallbody import HardSurface, Impacts

# The lander stays where its rebound would rise less than this [m].
REST_HEIGHT = 0.01


@dataclass(frozen=True)
class HardGround:
    """A touchdown by coefficients of restitution; attitude and spin stay as they come."""

    normal: float
    tangential: float

    def __call__(self, values: dict[str, float], seed: int) -> dict[str, Any]:
        """Bounce once off ground with the local acceleration and slope of the touchdown."""
        outward = -values["surface.gravity"] * math.cos(math.radians(values["surface.slope_deg"]))
        ground = HardSurface(self.normal, self.tangential, math.inf, REST_HEIGHT)
        impact = Impacts(
            np.array([values["impact.speed"]]), np.radians([values["impact.incidence_deg"]]), np.zeros((1, 3)),
            np.array([outward]), np.zeros(1, dtype=np.int64),
        )  # fmt: skip
        left = ground(impact, np.random.default_rng(0))
        if left.captured[0]:
            return {"outcome": "captured", "outputs": {"contacts": 1.0}}
        x, y, z = left.velocity[0].tolist()
        speed = math.hypot(x, y, z)
        spin = math.hypot(*(values[f"impact.spin_{axis}"] for axis in "xyz"))
        names = ("speed_out", "elevation_out", "spin_out", "velocity_out_x", "velocity_out_y", "velocity_out_z")
        found = (speed, math.asin(z / speed), spin, x, y, z)
        return {"outcome": "clear", "outputs": dict(zip(names, found, strict=True))}
