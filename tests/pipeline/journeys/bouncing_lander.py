"""Touchdowns of journeys by a function, the study they are made for, and studies without an emulator of them."""

import math
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import lithobrake
from lithobrake.emulator import training_runs
from lithobrake.results import StudyResults

from ...paper_tables import with_keys

# Journeys that end otherwise than at rest, by what their touchdown of this number does.
FAILS, STUCK, LEAVES = {5: 1}, {11: 1}, {17: 0, 29: 0, 41: 0}
# Below this speed a lander stays where it is [m/s].
SLOWEST = 0.006
LEAVING_SPEED = 0.3
TABLES: dict[str, dict[str, Any]] = {
    "bed": {"grain_count": 96, "width": [0.56, 0.56], "diameter": {"distribution": "constant", "value": 0.09},
            "pour_gravity": 0.5},
    "grain": {"density": 2500.0, "young_modulus": {"distribution": "log_uniform", "lower": 5e5, "upper": 5e6},
              "poisson_ratio": 0.25, "restitution": {"distribution": "uniform", "lower": 0.3, "upper": 0.9},
              "friction": {"distribution": "uniform", "lower": 0.5, "upper": 0.9}},
    "lander": {"shape": "box", "edges": [0.1, 0.1, 0.227], "mass": 2.0},
    "delivery": {"latitude_deg": 10.0, "longitude_deg": -60.0,
                 "heading_deg": {"distribution": "uniform", "lower": 0.0, "upper": 360.0},
                 "speed": {"distribution": "uniform", "lower": 0.04, "upper": 0.08},
                 "incidence_deg": {"distribution": "uniform", "lower": 0.0, "upper": 40.0}},
    "journey": {"count": 48, "duration": 172800.0, "emulated_count": 200},
    "site": {"body": "dimorphos"},
    "sky": {"sun_latitude_deg": {"distribution": "uniform", "lower": -10.0, "upper": 10.0}, "earth_latitude_deg": 0.0,
            "mask_deg": 30.0},
    "campaign": {"retry_count": 0},
}  # fmt: skip


def journey_tables(**changes: dict[str, Any]) -> dict[str, Any]:
    """The tables of a study of a CubeSat on Dimorphos; changes: by table and key."""
    return with_keys({"title": "Journeys in small", "seed": 2, **deepcopy(TABLES)}, changes)


def bounce(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """A rebound that grows with friction and with luck; slow ones are captured, some journeys end otherwise."""
    journey, touchdown = int(inputs["journey"]), int(inputs["touchdown"])
    if FAILS.get(journey) == touchdown:
        raise ValueError("the model of this lander fails here")
    random = np.random.default_rng(seed)
    speed, incidence = inputs["impact.speed"], math.radians(inputs["impact.incidence_deg"])
    along, down = speed * math.sin(incidence), speed * math.cos(incidence)
    outputs = _contact(along) | _attitude(random)
    if STUCK.get(journey) == touchdown:
        return {"outcome": "time_limit", "outputs": outputs}
    up = 0.8 * inputs["grain.friction"] * down * random.uniform(0.5, 1.0)
    if LEAVES.get(journey) == touchdown:
        up = LEAVING_SPEED
    elif up < SLOWEST:
        return {"outcome": "captured", "outputs": outputs}
    return {"outcome": "clear", "outputs": outputs | _rebound(0.6 * along, up, 20.0 * speed * random.uniform(0.5, 1.0))}


def _contact(along: float) -> dict[str, float]:
    return {"displacement_x": 10.0 * along, "displacement_y": 0.0, "duration": 30.0, "contacts": 2.0,
        "contact_duration": 20.0, "penetration": 0.01, "peak_acceleration": 1.0, "energy_lost": 0.1}  # fmt: skip


def _attitude(random: np.random.Generator) -> dict[str, float]:
    drawn = random.standard_normal(4)
    return dict(
        zip((f"orientation_out_{axis}" for axis in "wxyz"), (drawn / np.linalg.norm(drawn)).tolist(), strict=True)
    )


def _rebound(along: float, up: float, spin: float) -> dict[str, float]:
    return {"speed_out": math.hypot(along, up), "elevation_out": math.atan2(up, along), "azimuth_out": 0.0,
        "spin_out": spin, "velocity_out_x": along, "velocity_out_y": 0.0, "velocity_out_z": up, "spin_out_x": 0.0,
        "spin_out_y": spin, "spin_out_z": 0.0}  # fmt: skip


def run_without_emulator(
    tables: dict[str, Any], folder: Path, model: Any = bounce, report: bool = False
) -> StudyResults:
    """Run a study to its summary, or its page, as if too few landers had left the ground for an emulator, which would
    take most of its time.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(training_runs, "FEWEST", 1_000_000)
        return lithobrake.run(tables, folder, workers=1, model=model, report=report)
