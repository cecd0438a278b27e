"""Slow contacts are followed as closely as fast ones; steps that are given, and steps that are chosen."""

import math

import numpy as np
import pytest

from lithobrake.dem import Material, Sphere, World
from lithobrake.dem.stepping.time_step import Clock

ROCK = Material(young_modulus=1e7, poisson_ratio=0.25, density=2500.0, restitution=0.5, friction=0.5)
RADIUS, GRAVITY, STEPS = 0.05, 5e-5, 15.0
# Hertz: a ball on a plane sinks in until 4/3 E* sqrt(R) overlap^(3/2) bears its weight.
MODULUS = ROCK.young_modulus / (2.0 * (1.0 - ROCK.poisson_ratio**2))
WEIGHT = ROCK.density * 4.0 / 3.0 * math.pi * RADIUS**3 * GRAVITY
SUNK = (0.75 * WEIGHT / (MODULUS * math.sqrt(RADIUS))) ** (2.0 / 3.0)
# One less than the radius by its last bit.
BY_ROUNDING = math.nextafter(RADIUS, 0.0)


def balls_over_ground(*heights: float, upward: float = 0.0) -> World:
    """Balls one above the other, with their centres at heights [m] over a plane; the last goes up at a speed [m/s]."""
    world = World(gravity=(0.0, 0.0, -GRAVITY))
    world.add_plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), ROCK)
    for height in heights:
        speed = upward if height == heights[-1] else 0.0
        world.add_body(Sphere(RADIUS), ROCK, (0.0, 0.0, height), (0.0, 0.0, speed))
    return world


@pytest.mark.parametrize("overlap", [0.0, RADIUS - BY_ROUNDING, 1e-15, 1e-12])
def test_a_ball_that_begins_to_touch_at_rest_sinks_in_as_far_as_hertz_says(overlap: float) -> None:
    world = balls_over_ground(RADIUS - overlap)
    deepest = 0.0
    for _ in range(60):
        world.run_locally(0.05, STEPS)
        deepest = max(deepest, RADIUS - world.position[0, 2])
    # Without damping it would go to 2.5^(2/3) of where it rests.
    assert SUNK < deepest < 2.5 ** (2.0 / 3.0) * SUNK
    assert RADIUS - world.position[0, 2] == pytest.approx(SUNK, rel=0.02)


@pytest.mark.parametrize("gap", [1e-3, 1e-6, -1e-17, -1e-12])
def test_a_ball_that_falls_on_one_at_rest_meets_it(gap: float) -> None:
    low = balls_over_ground(RADIUS)
    low.run_locally(5.0, STEPS)
    rests = low.position[0, 2]
    world = balls_over_ground(rests, rests + 2.0 * RADIUS + gap)
    world.run_locally(40.0, STEPS)
    below, above = world.position[:, 2]
    # The one bears both; curvatures add where balls meet, so their stiffness is less by the root of two.
    assert RADIUS - below == pytest.approx(2.0 ** (2.0 / 3.0) * SUNK, rel=0.05)
    assert 2.0 * RADIUS - (above - below) == pytest.approx(2.0 ** (1.0 / 3.0) * SUNK, rel=0.05)


def test_a_ball_thrown_up_from_one_at_rest_comes_back_no_faster() -> None:
    speed = 5e-4
    low = balls_over_ground(RADIUS)
    low.run_locally(5.0, STEPS)
    rests = low.position[0, 2]
    world = balls_over_ground(rests, rests + 2.0 * RADIUS + 1e-6, upward=speed)
    fastest = 0.0
    for _ in range(60):
        world.run_locally(1.0, STEPS)
        fastest = max(fastest, float(np.abs(world.velocity[:, 2]).max()))
    assert fastest < 1.01 * speed
    assert world.position[1, 2] - world.position[0, 2] == pytest.approx(2.0 * RADIUS, abs=1e-6)


@pytest.mark.parametrize("drift", [0.0, 1.0])
def test_two_that_touch_by_rounding_feel_a_blow_however_fast_they_fly_together(drift: float) -> None:
    hard = Material(young_modulus=1e7, poisson_ratio=0.25, density=2500.0, restitution=1.0, friction=0.0)
    world = World()
    for place, speed in ((0.0, 0.0), (2.0 * BY_ROUNDING, 0.0), (0.25, -0.1)):
        world.add_body(Sphere(RADIUS), hard, (place, 0.0, 0.0), (speed, drift, 0.0))
    world.run_locally(1.0, 40.0)
    # Newton's cradle, but for what balls that touch share of a blow.
    assert world.velocity[0, 0] == pytest.approx(-0.0994, rel=0.01)
    assert world.velocity[:, 0].sum() == pytest.approx(-0.1, rel=1e-12)


def test_a_chosen_step_is_made_to_fit_the_duration_and_holds() -> None:
    clock = Clock(0.0, None, None)
    assert clock.steps_in(1.0, lambda: 0.3) == 4
    assert clock.time_step == 0.25
    assert clock.steps_in(0.5, lambda: math.nan) == 2


def test_only_a_step_that_was_given_outlasts_a_change() -> None:
    chosen, given = Clock(0.0, None, 0.25), Clock(0.0, None, 0.25)
    given.give(0.1)
    for clock in (chosen, given):
        clock.choose_anew()
    assert (chosen.time_step, given.time_step) == (None, 0.1)


def test_no_duration_takes_no_step_and_chooses_none() -> None:
    clock = Clock(0.0, None, None)
    assert clock.steps_in(0.0, lambda: 0.3) == 0
    assert clock.time_step is None


@pytest.mark.parametrize("duration", [-1.0, math.inf, math.nan])
def test_a_duration_that_is_none_is_refused(duration: float) -> None:
    with pytest.raises(ValueError, match="duration"):
        Clock(0.0, 0.1, 0.1).steps_in(duration, lambda: 0.1)
