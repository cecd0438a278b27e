"""Hard ground of a restitution that nobody knows: what every published odds of a landing stand on."""

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))
from hard_ground import HardGround

TANGENTIAL = 0.9  # of the speed along the ground, as in validation/ballistic_descent
# The restitution of each lander; study files do not let it be 0.
RESTITUTION = {"distribution": "uniform", "lower": 1e-6, "upper": 1.0}


def hard_touchdown(values: dict[str, float], seed: int) -> dict[str, Any]:
    """Bounce off hard ground with the restitution that the lander drew."""
    return HardGround(values["lander.restitution"], TANGENTIAL)(values, seed)
