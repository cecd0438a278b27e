"""Touchdowns by functions, which worker processes import by name, and a study that they are made for."""

import math
import tomllib
from pathlib import Path
from typing import Any

EXAMPLES = Path(__file__).parents[2] / "examples"


def bounce(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A rebound that friction makes steeper; the softest landers are captured."""
    if inputs["lander.restitution"] < 0.43:
        return {"outcome": "captured", "outputs": {"penetration": 0.01}}
    speed, elevation = inputs["impact.speed"] * inputs["lander.restitution"], 0.4 + inputs["lander.friction"]
    return {
        "outcome": "clear",
        "outputs": {
            "velocity_out_x": speed * math.cos(elevation), "velocity_out_y": 0.0,
            "velocity_out_z": speed * math.sin(elevation), "spin_out": 1.0 + inputs["lander.friction"],
            "azimuth_out": math.nan,
        },
    }  # fmt: skip


def contradicts_itself(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A lander that leaves into the ground."""
    return {"outputs": {"velocity_out_x": 0.1, "velocity_out_y": 0.0, "velocity_out_z": -0.1, "spin_out": 0.0}}


def lifted(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A rebound straight up, by a part of the speed that only this model knows."""
    speed = inputs["solver.inputs.lift"] * inputs["impact.speed"]
    outputs = {
        "velocity_out_x": 0.0, "velocity_out_y": 0.0, "velocity_out_z": speed, "spin_out": inputs["impact.speed"],
    }  # fmt: skip
    return {"outcome": "clear", "outputs": outputs}


def small_study() -> dict[str, Any]:
    """The ball on a plate without its program, with few runs."""
    tables = tomllib.loads((EXAMPLES / "ball_on_plate.toml").read_text())
    del tables["solver"]
    tables["expansion"] |= {"screening_level": 1, "screening_degree": 1, "refined_level": 2, "refined_degree": 1}
    tables["expansion"] |= {"test_count": 4}
    tables["monte_carlo"] = {"sample_count": 400}
    tables["flight"] = {"flight_count": 6, "duration": 600.0, "gravity": "exact"}
    tables["hard_ground"] = {"count": 0}
    return tables
