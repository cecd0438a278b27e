"""Synthetic landings as a model of a study: laws that are known, within milliseconds, and no bed is poured."""

import math
import tomllib
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lithobrake.study.template import template

from ..synthetic_landings import OUTPUT_NAMES, SPEED_LIMIT, WEAK, Truth

# The five soils of the synthetic landings, in their order, by their keys in a study file.
SOIL: dict[str, Any] = {
    "grain.friction": {"distribution": "uniform", "lower": 0.3, "upper": 0.9},
    "grain.restitution": {"distribution": "uniform", "lower": 0.3, "upper": 0.9},
    "grain.young_modulus": {"distribution": "log_uniform", "lower": 1e6, "upper": 1e8},
    "grain.rolling_friction": {"distribution": "uniform", "lower": 0.0, "upper": 0.3},
    "grain.density": {"distribution": "uniform", "lower": 1500.0, "upper": 3000.0},
}


@dataclass(frozen=True)
class SyntheticLander:
    """A model for `lithobrake.run`.

    beds: seed of the effects of the beds. follows_speed: whether landers leave, and turn, in proportion to their speed
    of arrival.
    """

    truth: Truth = field(default=WEAK)
    beds: int = 1
    follows_speed: bool = False

    def __call__(self, values: dict[str, float], seed: int) -> dict[str, Any]:
        """Land once, with the soil, the bed and the seed of the run."""
        x = np.array([[values[name] for name in SOIL]])
        bed = np.random.default_rng([self.beds, int(values["bed"])]).standard_normal(1)
        landing = self.truth.draw(x, bed, np.random.default_rng(seed))
        if landing.outcome[0] != "clear":
            return {"outcome": str(landing.outcome[0])}
        part = values["impact.speed"] / SPEED_LIMIT if self.follows_speed else 1.0
        return {"outcome": "clear", "outputs": outputs_of(landing.y[0] * [part, 1.0, 1.0, part])}


def outputs_of(y: np.ndarray) -> dict[str, float]:
    """Outputs of a study [SI] from a row of synthetic ones."""
    speed, elevation, azimuth, spin = (float(y[OUTPUT_NAMES.index(name)]) for name in OUTPUT_NAMES)
    level = speed * np.cos(elevation)
    return {"velocity_out_x": level * np.cos(azimuth), "velocity_out_y": level * np.sin(azimuth),
        "velocity_out_z": speed * np.sin(elevation), "spin_out_x": 0.6 * spin, "spin_out_y": -0.8 * spin,
        "spin_out_z": 0.0, "contact_duration": 0.1 / speed}  # fmt: skip


def synthetic_tables(**changes: dict[str, Any]) -> dict[str, Any]:
    """The tables of a study of these first touchdowns, a few hundred samples, and other keys in its tables."""
    tables: dict[str, Any] = tomllib.loads(template())
    for name, law in SOIL.items():
        section, key = name.split(".")
        tables[section][key] = law
    tables["grain"]["poisson_ratio"] = 0.25
    tables["lander"] = {"shape": "sphere", "diameter": 0.1, "mass": 1.0}
    tables["impact"] = {"speed": SPEED_LIMIT, "incidence_deg": 20.0, "region": {"x": [-0.1, 0.1], "y": [-0.1, 0.1]}}
    tables["journey"] = {"touchdowns": 1}
    tables["design"] = {"run_count": 144}
    tables["monte_carlo"] = {"sample_count": 4000}
    tables["site"] = {"heading_deg": {"distribution": "uniform", "lower": 0.0, "upper": 360.0}}
    tables["flight"], tables["hard_ground"] = {"flight_count": 1000}, {"count": 100}
    changed = tables | {name: tables.get(name, {}) | keys for name, keys in changes.items()}
    # A key that is None is left out.
    return {
        name: {key: entry for key, entry in table.items() if entry is not None} if isinstance(table, dict) else table
        for name, table in changed.items()
    }


def land(inputs: dict[str, float], seed: int) -> dict[str, Any]:
    """Capture a quarter of the landers; let one in fifty leave over the rim, and the others rebound."""
    if inputs["lander.restitution"] < 0.5:
        return {"outcome": "captured", "outputs": {"penetration": 0.01}}
    if inputs["lander.friction"] < 0.06:
        return {"outcome": "left_sideways", "outputs": {}}
    speed, elevation = inputs["impact.speed"] * inputs["lander.restitution"], 0.4 + 0.1 * inputs["bed"] % 0.3
    leaving = {"velocity_out_x": speed * math.cos(elevation), "velocity_out_y": 0.0}
    return {"outcome": "clear", "outputs": leaving | {"velocity_out_z": speed * math.sin(elevation), "spin_out": 1.0}}
