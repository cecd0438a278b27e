"""Touchdowns by functions, which worker processes import by name."""

import math
from typing import Any


def bounce(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A rebound that friction makes steeper; the softest landers are captured."""
    if inputs["lander.restitution"] < 0.43:
        return {"outcome": "captured", "outputs": {"penetration": 0.01}}
    speed, elevation = inputs["impact.speed"] * inputs["lander.restitution"], 0.4 + inputs["lander.friction"]
    return {
        "outcome": "clear",
        "outputs": {
            "velocity_out_x": speed * math.cos(elevation),
            "velocity_out_y": 0.0,
            "velocity_out_z": speed * math.sin(elevation),
            "spin_out": 1.0 + inputs["lander.friction"],
            "azimuth_out": math.nan,
        },
    }


def contradicts_itself(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A lander that leaves into the ground."""
    return {"outputs": {"velocity_out_x": 0.1, "velocity_out_y": 0.0, "velocity_out_z": -0.1, "spin_out": 0.0}}


def lifted(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A rebound straight up, by a part of the speed that only this model knows."""
    speed = inputs["solver.inputs.lift"] * inputs["impact.speed"]
    outputs = {
        "velocity_out_x": 0.0,
        "velocity_out_y": 0.0,
        "velocity_out_z": speed,
        "spin_out": inputs["impact.speed"],
    }
    return {"outcome": "clear", "outputs": outputs}
