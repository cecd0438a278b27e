"""Beds of spheres for the comparison of grain sizes: poured as hulls are, landed on as spheres."""

import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.dem import Box, Sphere
from lithobrake.touchdown import Bed, ContactModel, GrainSizes, Lander, Landing, land, settling

VALIDATION = Path(__file__).parents[2] / "validation"


def test_spheres_rest_on_ground_that_repeats_and_are_landed_on(
    recipe: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "path", [str(VALIDATION), *sys.path])
    from sphere_beds import SphereBed, pour_spheres

    asked = recipe(
        sides="periodic", width=(0.52, 0.56), grain_count=48,
        sizes=GrainSizes(distribution="constant", lower=0.1, upper=0.1),
    )  # fmt: skip
    rock = replace(asked.material, rolling_friction=0.1)
    poured = pour_spheres(replace(asked, material=rock))
    assert poured.history["unbalanced_force"][-1] < settling.UNBALANCED_FORCE
    poured.save(tmp_path / "bed.h5")
    bed = SphereBed.of(Bed.load(tmp_path / "bed.h5"))
    world = bed.world(rock, asked.gravity, ContactModel())
    assert {type(body.shape) for body in world.bodies} == {Sphere}
    np.testing.assert_allclose([body.shape.bounding_radius for body in world.bodies], 0.05)
    lander = Lander(shape=Box((0.08, 0.06, 0.05)), mass=0.6, material=rock)
    landing = Landing(
        grain=rock, speed=0.3, incidence=0.2, azimuth=0.3, place=(0.0, 0.0), orientation=(0.9, 0.3, 0.2, 0.1),
        spin=(0.0, 0.0, 0.0), gravity=(0.0, 0.0, -5e-4), time_limit=5.0, contact=ContactModel(steps_per_contact=25.0),
    )  # fmt: skip
    assert land(bed, lander, landing).outputs["peak_acceleration"] > 0.0
