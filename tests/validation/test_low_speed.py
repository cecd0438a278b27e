"""Closed forms and readings of the low-speed cases, and that every claim of a source has an answer."""

import math
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "validation" / "low_speed"


@pytest.fixture
def script(monkeypatch: pytest.MonkeyPatch) -> Any:
    """What a script of validation/low_speed defines, by its name."""
    monkeypatch.syspath_prepend(str(FOLDER))
    return lambda name: runpy.run_path(str(FOLDER / f"{name}.py"))


def test_bearing_capacity_has_the_factors_of_the_tables(script: Any) -> None:
    """At 30 degrees [Vesic-1973] tabulates 18.40 for depth and 22.40 for width; a circle takes 0.3 of its diameter."""
    bears = script("plate_sinkage")["bearing_capacity"]
    assert bears(math.radians(30.0), 1.0, 1.0, 0.0) == pytest.approx(18.40, abs=0.005)
    assert bears(math.radians(30.0), 1.0, 0.0, 1.0) == pytest.approx(0.3 * 22.40, abs=0.005)


def test_loose_ground_has_two_thirds_of_the_friction(script: Any) -> None:
    assert math.tan(script("plate_sinkage")["loosened"](math.atan(0.6))) == pytest.approx(0.4)


def test_exponent_of_a_power_law_is_its_power(script: Any) -> None:
    sinkage = np.arange(0.0, 0.062, 5e-5)
    curve = np.column_stack([sinkage, 3e5 * sinkage**0.9])
    assert script("plate_sinkage")["exponent"](curve) == pytest.approx(0.9, abs=0.01)


def test_a_box_under_a_constant_force_makes_the_dent_of_the_source_in_its_time(script: Any) -> None:
    """From 1/6 m/s to rest within 0.25 m and 3 s; a hundredth deeper than where it stops, no dent is found."""
    philae = script("philae_into_ice")
    moments = np.arange(0.0, 3.01, 0.05)
    speed = philae["SPEED"] * (1.0 - moments / 3.0)
    way = np.column_stack([moments, philae["SPEED"] * (moments - moments**2 / 6.0), speed])
    found = philae["read_off"](way)
    assert found["deepest"] == pytest.approx(0.25)
    assert found["time_of_deepest"] == pytest.approx(3.0)
    assert math.isnan(philae["read_off"](way * [1.0, 0.99, 1.0])["time_of_dent"])


@pytest.mark.parametrize(
    ("depths", "wanted"), [((0.4, 0.3, 0.2), 15.0), ((0.2, 0.1, 0.05), 0.0), ((0.5, 0.4, 0.3), math.inf)]
)
def test_the_cohesion_of_a_dent_lies_between_the_runs(script: Any, depths: Any, wanted: float) -> None:
    rows = [{"cohesion": c, "deepest": d} for c, d in zip((0.0, 10.0, 20.0), depths, strict=True)]
    assert script("answers")["cohesion_of_dent"](rows[::-1], 0.25) == pytest.approx(wanted)


@pytest.mark.parametrize("pad", ["hemisphere", "cone", "disk"])
def test_pads_are_of_one_diameter_and_stand_on_their_lowest_point(script: Any, pad: str) -> None:
    footpad = script("footpad_on_ice")
    corners = footpad["pad_of"](pad).vertices
    assert np.hypot(corners[:, 0], corners[:, 1]).max() == pytest.approx(0.5 * footpad["PAD"])
    assert corners[:, 2].min() == pytest.approx(0.0, abs=1e-12)


def test_a_run_of_a_pad_ends_where_it_flies_stands_or_meets_the_floor(script: Any) -> None:
    ended = script("footpad_on_ice")["ended"]
    falls = np.tile([0.1, 0.0, 0.0, -0.05, 0.0, 0.0, -0.5], (8, 1))
    assert not ended(falls)
    assert ended(falls * [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0])
    assert ended(falls * [1.0, 1.0, 1.0, 10.0, 1.0, 1.0, 1.0])
    assert ended(falls * [1.0, 1.0, 1.0, -1.0, 1.0, 1.0, -1.0])


def test_a_pad_lands_only_where_it_is_borne_and_stands_near(script: Any) -> None:
    lands = script("answers")["lands"]
    good = {"deepest": 0.1, "slip": 0.1, "last_speed": 0.0}
    assert lands(good)
    assert not any(lands(good | change) for change in ({"deepest": 0.2}, {"slip": 0.2}, {"last_speed": 0.1}))


def test_a_ball_rolls_only_where_it_does_not_bounce(script: Any) -> None:
    rolls = script("answers")["rolls"]
    assert rolls({"rise": 0.0, "way_along": 0.006})
    assert not rolls({"rise": 0.001, "way_along": 0.006})
    assert not rolls({"rise": 0.0, "way_along": 0.004})


def test_every_claim_has_a_number_and_a_range(script: Any) -> None:
    """A range that is empty, or takes in every number, would be no claim."""
    answers = script("answers")
    for case in answers["CASES"]:
        for one in answers["answers_of"](case):
            assert math.isfinite(one.found.value) or one.found.value == math.inf, one.claim
            assert one.claim.low <= one.claim.high
            assert math.isfinite(one.claim.low) or math.isfinite(one.claim.high)
            assert bool(one.cause) != one.agrees


def test_a_shell_with_thin_walls_has_the_inertia_of_a_hollow_cube(script: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """A cube without walls of its own has 5/18 m a^2 about its centre."""
    shell = script("filled_shell")
    inertia = shell["inertia_of_shell"]
    monkeypatch.setitem(inertia.__globals__, "INSIDE", shell["SIDE"] * (1.0 - 1e-6))
    np.testing.assert_allclose(inertia(), 5.0 / 18.0 * shell["SHELL_MASS"] * shell["SIDE"] ** 2 * np.eye(3), rtol=1e-5)
