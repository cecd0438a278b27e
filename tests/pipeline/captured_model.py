"""A touchdown by a function, which worker processes import by name: the softest of the landers are captured."""

import math
from typing import Any


def land(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """Capture a quarter of the landers; let one in fifty leave over the rim, and the others rebound."""
    if inputs["lander.restitution"] < 0.5:
        return {"outcome": "captured", "outputs": {"penetration": 0.01}}
    if inputs["lander.friction"] < 0.06:
        return {"outcome": "left_sideways", "outputs": {}}
    speed, elevation = inputs["impact.speed"] * inputs["lander.restitution"], 0.4 + 0.1 * inputs["bed"] % 0.3
    leaving = {"velocity_out_x": speed * math.cos(elevation), "velocity_out_y": 0.0}
    return {"outcome": "clear", "outputs": leaving | {"velocity_out_z": speed * math.sin(elevation), "spin_out": 1.0}}
