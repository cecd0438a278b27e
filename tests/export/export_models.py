"""A touchdown by a function, which worker processes import by name, and a study whose flights are passed on."""

import math
import tomllib
from pathlib import Path
from typing import Any

EXAMPLES = Path(__file__).parents[2] / "examples"


def bounce(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A rebound that friction makes steeper."""
    speed, elevation = inputs["impact.speed"] * inputs["lander.restitution"], 0.4 + inputs["lander.friction"]
    outputs = {"velocity_out_x": speed * math.cos(elevation), "velocity_out_y": 0.0,
        "velocity_out_z": speed * math.sin(elevation), "spin_out": 1.0 + inputs["lander.friction"]}  # fmt: skip
    return {"outcome": "clear", "outputs": outputs}


def study_with_flights() -> dict[str, Any]:
    """The ball on a plate on Dimorphos with Didymos beside it, where place, heading, mass and spin are uncertain."""
    tables = tomllib.loads((EXAMPLES / "ball_on_plate.toml").read_text())
    del tables["solver"]
    tables["expansion"] |= {"screening_level": 1, "screening_degree": 1, "refined_level": 1, "refined_degree": 1}
    tables["expansion"] |= {"test_count": 2}
    tables["monte_carlo"] = {"sample_count": 100}
    tables["flight"] = {"flight_count": 16, "duration": 7200.0, "gravity": "exact"}
    tables["hard_ground"] = {"count": 10}
    tables["site"] = {
        "body": "dimorphos", "latitude_deg": 20.0, "longitude_deg": 60.0,
        "heading_deg": {"distribution": "uniform", "lower": 0.0, "upper": 360.0},
        "north_error": {"distribution": "normal", "mean": 0.0, "std": 5.0},
        "mass": {"distribution": "uniform", "lower": 4.2e9, "upper": 4.4e9},
    }  # fmt: skip
    tables["impact"] |= {"speed": 0.06}
    return tables
