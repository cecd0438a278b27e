"""Landings that go on to rest: low hops are part of them, and the lander ends where it lies, or above its hops."""

import math
from typing import Any

import numpy as np
import pytest

from lithobrake.dem import BodyMotion, Box, Material
from lithobrake.touchdown import Bed, BedRecipe, ContactModel, Lander, Landing, land, pour_bed
from lithobrake.touchdown.rest_watch import REST_WAY, RestWatch, rest_time
from lithobrake.vocabulary.quantities import ORIENTATION_OUT, TO_REST

ROCK = Material(young_modulus=1e6, poisson_ratio=0.25, restitution=0.5, friction=0.5, density=2500.0)
LANDER = Lander(shape=Box((0.08, 0.06, 0.05)), mass=0.6, material=ROCK)
GRAVITY = 5e-4


@pytest.fixture(scope="module")
def ground(recipe: Any) -> Bed:
    recipe_of_ground: BedRecipe = recipe(sides="periodic", width=(0.52, 0.56), grain_count=48)
    return pour_bed(recipe_of_ground)


def landing(**changes: Any) -> Landing:
    values: dict[str, Any] = {
        "grain": ROCK, "speed": 0.02, "incidence": 0.5, "azimuth": 0.3, "place": (0.0, 0.0),
        "orientation": (0.9, 0.3, 0.2, 0.1), "spin": (0.0, 0.0, 0.0), "gravity": (0.0, 0.0, -GRAVITY),
        "time_limit": 1000.0, "hop_height": 0.3, "contact": ContactModel(held_speed=0.03),
    }  # fmt: skip
    return Landing(**{**values, **changes})


def test_a_slow_lander_comes_to_rest_on_a_side(ground: Bed) -> None:
    outcome = land(ground, LANDER, landing(), frame_count=20)
    outputs = outcome.outputs
    assert outcome.status == "captured"
    assert {*TO_REST, *ORIENTATION_OUT} <= outputs.keys()
    assert outputs["duration"] == outcome.simulated_time < 1000.0
    assert outputs["duration"] > rest_time(LANDER, GRAVITY)
    assert outputs["contacts"] >= 1.0
    assert math.hypot(*(outputs[name] for name in ORIENTATION_OUT)) == pytest.approx(1.0)
    # The frame is that of the incoming velocity: the lander came 0.3 rad from x, and went on that way.
    way = outcome.frames["position"][-1, -1] - outcome.frames["position"][0, -1]
    turned = complex(*way[:2]) * complex(math.cos(0.3), -math.sin(0.3))
    assert outputs["displacement_x"] == pytest.approx(turned.real, abs=2e-3)
    assert outputs["displacement_y"] == pytest.approx(turned.imag, abs=2e-3)
    # Nothing is left that could lift it by a thousandth of its size.
    assert outputs["energy_lost"] == pytest.approx(0.5 * 0.6 * 0.02**2, rel=0.05)


def test_it_leaves_for_a_hop_that_rises_higher_than_asked_and_no_other(ground: Bed) -> None:
    fast = land(ground, LANDER, landing(speed=0.1, incidence=0.2, hop_height=0.05))
    assert fast.status == "clear"
    up = fast.outputs["velocity_out_z"]
    assert 0.5 * up**2 / GRAVITY + ground.grain_diameter + 0.1 > 0.05
    low = land(ground, LANDER, landing(speed=0.1, incidence=0.2, hop_height=100.0))
    assert low.status == "captured"
    assert low.outputs["contacts"] > 1.0


def test_where_gravity_points_outward_nothing_rests(ground: Bed) -> None:
    assert rest_time(LANDER, -1e-5) == math.inf
    outcome = land(ground, LANDER, landing(gravity=(0.0, 0.0, 1e-5), speed=0.05))
    assert outcome.status == "clear"


def motion(position: tuple[float, float, float], angle: float = 0.0) -> BodyMotion:
    turn = np.array([math.cos(0.5 * angle), math.sin(0.5 * angle), 0.0, 0.0])
    zero = np.zeros(3)
    return BodyMotion(np.array(position), zero, turn, angular_momentum=zero, spin=zero, mass=1.0)


def test_rest_asks_for_no_motion_of_any_point_for_as_long_as_toppling_takes() -> None:
    edge, patience = LANDER.smallest_edge, rest_time(LANDER, GRAVITY)
    assert patience == pytest.approx(math.sqrt(edge / GRAVITY))
    still, sways, turns = (RestWatch(LANDER, GRAVITY) for _ in range(3))
    times = np.linspace(0.0, 1.01 * patience, 40)
    way = 1.5 * REST_WAY * edge
    for time in times:
        ends = [
            still.is_over(time, motion((0.0, 0.0, 0.1))),
            sways.is_over(time, motion((way * (time > 0.5 * patience), 0.0, 0.1))),
            turns.is_over(time, motion((0.0, 0.0, 0.1), way / LANDER.shape.bounding_radius * (time > 0.5 * patience))),
        ]
    assert ends == [True, False, False]


@pytest.mark.parametrize("height", [0.0, -1.0, math.inf, math.nan])
def test_a_hop_height_that_is_none_is_refused(height: float) -> None:
    with pytest.raises(ValueError, match=r"Landing\.hop_height"):
        landing(hop_height=height)
