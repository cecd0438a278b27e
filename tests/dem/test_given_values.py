"""What a world, a body and a shape are given: a value of another type, or beyond all use, is one sentence."""

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from lithobrake import dem
from lithobrake.export import Push
from lithobrake.smallbody import HeliocentricOrbit, circle_places
from lithobrake.vocabulary.clock import Epoch

ROCK = {"young_modulus": 1e6, "poisson_ratio": 0.25, "restitution": 0.5, "friction": 0.5, "density": 2500.0}


def world(**given: Any) -> dem.World:
    made = dem.World((0.0, 0.0, -1.0), **given)
    made.add_body(dem.Sphere(0.1), dem.Material(**ROCK), (0.0, 0.0, 0.2))
    return made


@pytest.mark.parametrize(("make", "said"), [
    (lambda: dem.Sphere("0.1"), "Sphere.radius is '0.1' m; allowed is a finite value above 0"),
    (lambda: dem.Sphere(True), "Sphere.radius is True m"),
    (lambda: dem.Sphere(10**400), "Sphere.radius is 1000"),
    (lambda: dem.Sphere(0.1, "abc"), "Sphere.centre is 'abc' m; allowed are three finite numbers"),
    (lambda: dem.Material(**ROCK | {"friction": "0.5"}), "Material.friction is '0.5'"),
    (lambda: dem.World(period="xy"), "World.period is 'xy' m"),
    (lambda: dem.World(time_step="1"), "World.time_step is '1' s"),
    (lambda: world().run("1"), "World.run duration is '1' s"),
    (lambda: world().run(1e300), "World.run duration is 1e+300 s; allowed is a value from 0 to 1e+09"),
    (lambda: world().run(steps=10**20), "World.run steps is 100000000000000000000"),
    (lambda: world().run_locally(1e300, 25.0), "World.run_locally duration is 1e+300 s; allowed is at most 1e+09"),
    (lambda: world().run_locally(np.nan, 25.0), "World.run_locally duration is nan s"),
    (lambda: setattr(world(), "thread_count", 10**6), "World.thread_count is 1000000; allowed is a whole number"),
    (lambda: setattr(world(), "thread_count", "2"), "World.thread_count is '2'"),
    (lambda: world().add_body(None, dem.Material(**ROCK), (0, 0, 0)), "add_body shape is None"),
    (lambda: world().add_body(dem.Sphere(0.1), None, (0, 0, 0)), "add_body material is None; allowed is a Material"),
    (lambda: world().add_body(dem.Sphere(0.1), dem.Material(**ROCK), ("a", 0, 0)), "add_body position is ('a', 0, 0)"),
    (lambda: circle_places(-5.0, 90.0), "radius is -5.0, but must be a finite number above 0"),
    (lambda: HeliocentricOrbit(1.0, 1.0, 0, 0, 0, 0, Epoch.of("2027-01-01")), "eccentricity is 1.0, but must be"),
    (lambda: HeliocentricOrbit(1.0, 0.5, 0, 0, 0, 0, 0), "epoch is 0, but must be an Epoch"),
    (lambda: Push(0.04, 45.0, speed_std=1e308), "speed_std is 1e+308, but must be a finite number of at least 0 and "
     "of at most 1e+100 in size"),
])  # fmt: skip
def test_a_value_that_no_engine_can_use_is_one_sentence(make: Callable[[], Any], said: str) -> None:
    with pytest.raises(ValueError, match=re.escape(said)) as refused:
        make()
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("size", [1e-200, 1.0, 1e200])
def test_an_attitude_of_any_length_turns_alike(size: float) -> None:
    made = dem.World()
    made.add_body(dem.Sphere(0.1), dem.Material(**ROCK), (0, 0, 0), orientation=(0.6 * size, 0.8 * size, 0.0, 0.0))
    assert made.orientation[0] == pytest.approx([0.6, 0.8, 0.0, 0.0], abs=1e-15)
