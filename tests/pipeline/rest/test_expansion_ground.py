"""The expansion asked about later impacts, and what its landers slide on; landers too slow to leave."""

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lithobrake.analysis import OutcomeModel
from lithobrake.chaos import Uniform, fit, smolyak
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.expansion.expansion_journeys import SoilBounce
from lithobrake.pipeline.expansion.expansion_samples import Scatter
from lithobrake.pipeline.expansion.expansions import points
from lithobrake.pipeline.first_touchdown.bounce_laws import (
    FRICTIONS,
    INTERCEPT,
    SLOPE,
    effective_friction,
    why_no_soil,
)
from lithobrake.pipeline.first_touchdown.samples import rolling_spin
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.ground_touchdowns import SlowArrivals, sliding, soil_friction
from lithobrake.pipeline.journeys.hard_ground import hard_ground_dependencies
from lithobrake.smallbody import Impacts
from lithobrake.smallbody.ground_touchdowns import Bounces
from lithobrake.smallbody.touchdown import Answers, ImpactStates
from lithobrake.study import Study, check_tables
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import OUTPUTS, UNKNOWN_END

from ...paper_tables import paper_tables, with_keys

ROOT = Path(__file__).parents[3]
# Grains so small that nothing is known of how they hold a lander.
FINE = {"distribution": "constant", "value": 0.02}
INPUTS = {
    "grain.friction": Uniform(0.2, 0.8),
    "impact.speed": Uniform(0.0, 0.4),
    "impact.incidence_deg": Uniform(0.0, 80.0),
}
RANGES = {"grain.friction": (0.2, 0.8), "impact.speed": (0.0, 0.4), "impact.incidence_deg": (0.0, 80.0)}


def rebound(x: np.ndarray) -> np.ndarray:
    """Outputs [count, 6] that are polynomials of the inputs: half the speed, higher up the less the friction, to the
    right of the incoming direction."""
    friction, speed, incidence = x.T
    return np.column_stack([0.5 * speed, 1.2 - friction, 2.0 * speed, np.zeros_like(speed), -speed, incidence])


def bounce(friction: list[float], scatter: Scatter | None = None, outcome: str = "clear") -> SoilBounce:
    x = smolyak(INPUTS, level=2)
    surrogate = fit(INPUTS, x, rebound(x), degree=2, method="ols", output_names=OUTPUTS)
    outcomes = OutcomeModel(INPUTS, x, [outcome] * len(x), tuple(TouchdownOutcome))
    values = np.array(friction)
    inputs = {name: values if name == "grain.friction" else np.full(len(values), 0.3) for name in INPUTS}
    return SoilBounce(surrogate, outcomes, inputs, RANGES, scatter)


def impacts(speed: list[float], incidence_deg: list[float], lander: list[int]) -> Impacts:
    count = len(speed)
    degrees = np.radians(incidence_deg)
    return Impacts(np.array(speed), degrees, np.zeros((count, 3)), np.full(count, -1e-5), np.array(lander))


def test_the_expansion_answers_with_the_soil_of_the_lander_and_the_impact_that_came() -> None:
    found = bounce([0.2, 0.5, 0.7])(impacts([0.1, 0.3], [40.0, 20.0], [2, 0]), np.random.default_rng(0))
    along, up = np.cos([0.5, 1.0]), np.sin([0.5, 1.0])
    expected = np.array([0.05, 0.15])[:, None] * np.column_stack([np.zeros(2), -along, up])
    assert found.velocity == pytest.approx(expected, abs=1e-12)
    assert np.linalg.norm(found.spin, axis=1) == pytest.approx([0.2, 0.6])
    # The lowest point of a rolling ball is at rest: spin cross (0, 0, -1) runs against the horizontal velocity.
    backwards = np.cross(found.spin, [0.0, 0.0, -1.0])[:, :2]
    assert np.einsum("ni,ni->n", backwards, found.velocity[:, :2]) == pytest.approx(
        -np.linalg.norm(found.spin, axis=1) * np.linalg.norm(found.velocity[:, :2], axis=1)
    )
    assert not found.captured.any()
    assert not found.outside.any()


def test_what_the_runs_do_not_reach_is_not_answered() -> None:
    soil = bounce([0.5])
    found = soil(impacts([0.3, 0.41, 0.3, 0.3], [79.9, 10.0, 80.1, 10.0], [0] * 4), np.random.default_rng(0))
    assert found.outside.tolist() == [False, True, True, False]
    limited = replace(soil, ranges=RANGES | {"impact.speed": (0.1, 0.2)})
    found = limited(impacts([0.05, 0.15], [10.0, 10.0], [0, 0]), np.random.default_rng(0))
    assert found.outside.tolist() == [True, False]


def test_scatter_is_drawn_anew_in_proportion_to_the_speed_and_the_outcome_with_its_chance() -> None:
    rows = np.zeros((2, 6))
    rows[:, OUTPUTS.index("speed_out")] = [0.02, -0.02]
    rows[:, OUTPUTS.index("elevation_out")] = 0.3
    scatter = Scatter(rows, 0.2, np.array([name != "elevation_out" for name in OUTPUTS]))
    angles = scatter.draw(np.array([0.1, 0.4]), np.random.default_rng(1))[:, OUTPUTS.index("elevation_out")]
    assert angles.tolist() == [0.3, 0.3]
    soil = bounce([0.5], scatter)
    fast, slow = (
        np.linalg.norm(soil(impacts([speed] * 200, [0.0] * 200, [0] * 200), np.random.default_rng(1)).velocity, axis=1)
        for speed in (0.4, 0.1)
    )
    assert sorted(set(np.round(fast, 9))) == [0.16, 0.24]
    assert slow == pytest.approx(fast / 4.0)
    assert 60 < (fast > 0.2).sum() < 140
    captured = bounce([0.5], scatter, "captured")(impacts([0.4], [0.0], [0]), np.random.default_rng(1))
    assert (captured.captured.all(), captured.outside.any()) == (True, False)


def test_what_has_no_answer_is_neither_captured_nor_sent_on() -> None:
    """Over the rim, in contact at the time limit, or drawn with an elevation that there is not."""
    one = impacts([0.4], [0.0], [0])
    for outcome in ("left_sideways", "time_limit"):
        found = bounce([0.5], outcome=outcome)(one, np.random.default_rng(1))
        assert (found.captured.tolist(), found.outside.tolist()) == ([False], [True])
    rows = np.zeros((2, 6))
    rows[:, OUTPUTS.index("elevation_out")] = [-0.8, 0.1]
    steep = Scatter(rows, 0.2, np.zeros(6, dtype=bool))
    many = bounce([0.5], steep)(impacts([0.4] * 100, [0.0] * 100, [0] * 100), np.random.default_rng(1))
    assert 20 < many.outside.sum() < 80
    assert not many.captured.any()
    assert (many.velocity[~many.outside, 2] > 0.0).all()


def test_a_spin_straight_up_has_a_level_axis() -> None:
    assert rolling_spin(np.array([[0.0, 0.0, 1.0]]), np.array([2.0])).tolist() == [[0.0, 2.0, 0.0]]


def changed(**sections: dict[str, Any]) -> Study:
    return check_tables(with_keys(paper_tables(), sections), Path())


def test_the_soil_is_asked_where_speed_and_incidence_are_uncertain() -> None:
    speed = {"distribution": "uniform", "lower": 0.05, "upper": 0.4}
    assert "impact.speed and impact.incidence_deg are no uncertain input" in str(why_no_soil(changed()))
    assert "impact.incidence_deg is no uncertain" in str(why_no_soil(changed(impact={"speed": speed})))
    both = changed(impact={"speed": speed, "incidence_deg": {"distribution": "uniform", "lower": 0.0, "upper": 70.0}})
    assert why_no_soil(both) is None
    design = DrawnDesign(both)
    speeds = points(design, "screening", ())[:, list(design.inputs).index("impact.speed")]
    assert (speeds.min(), speeds.max()) == pytest.approx((0.05, 0.4))


def arrivals(friction: list[float], hull: float = 0.4) -> Arrivals:
    """Landers whose grains have these frictions."""
    rows, count = [{"grain.friction": one, "lander.friction": hull} for one in friction], len(friction)
    nothing = np.zeros(count)
    return Arrivals(
        np.arange(count), rows, {}, np.zeros((count, 3)), np.zeros((count, 3, 3)), nothing, nothing, nothing
    )


NOBODY: Any = None


def test_the_friction_of_a_slide_is_that_of_hull_and_grain_or_of_rolling() -> None:
    begin = arrivals([0.9, 0.05, 0.9])
    drawn = DrawnDesign(changed(lander={"friction": 0.4}, bed={"diameter": FINE}))
    assert soil_friction(drawn, begin).tolist() == [0.4, 0.05, 0.4]
    assert sliding(drawn, begin, NOBODY).friction.tolist() == [0.4, 0.05, 0.4]
    assert sliding(drawn, begin, NOBODY, np.full(3, 0.6)).friction.tolist() == [0.6] * 3
    rolls = DrawnDesign(changed(hard_ground={"rolling_friction": 0.1}))
    for one in (sliding(rolls, begin, NOBODY), sliding(rolls, begin, NOBODY, np.full(3, 0.6))):
        assert (one.friction.tolist(), one.rolls) == ([0.1] * 3, True)


def test_stones_as_large_as_the_lander_hold_it_more_than_its_contacts_do() -> None:
    begin, drawn = arrivals([0.9, 0.05, 0.9]), changed(lander={"friction": 0.4})
    assert soil_friction(DrawnDesign(drawn), begin) == pytest.approx(INTERCEPT + SLOPE * np.array([0.4, 0.2, 0.4]))
    assert hard_ground_dependencies(drawn)["sliding_law"] == (INTERCEPT, SLOPE)
    ball = {"shape": "sphere", "diameter": 0.1, "edges": None, "friction": 0.4}
    assert soil_friction(DrawnDesign(changed(lander=ball)), begin).tolist() == [0.4, 0.05, 0.4]


def test_the_law_of_sliding_is_that_of_its_measurement() -> None:
    found = json.loads((ROOT / "validation" / "sliding_law.json").read_text(encoding="utf-8"))["law"]
    assert pytest.approx((found["intercept"], found["slope"]), abs=0.005) == (INTERCEPT, SLOPE)
    low, high = FRICTIONS
    assert found["scatter"] < found["scatter_about_coulomb"]
    assert (effective_friction(np.array([0.0, 2.0])) == effective_friction(np.array([low, high]))).all()


def states(speed: list[float], outward: float = -1e-5, spin: float = 0.0) -> ImpactStates:
    """Impacts at 60 degrees from the normal under an acceleration along it, of a lander that turns about y."""
    count = len(speed)
    nothing, number = np.zeros(count), np.zeros(count, dtype=np.int64)
    angle, axes = np.full(count, 60.0), np.tile(np.eye(3), (count, 1, 1))
    spins, pull = np.tile([0.0, spin, 0.0], (count, 1)), np.tile([0.0, 0.0, outward], (count, 1))
    return ImpactStates(
        number, number, number, np.zeros((count, 3)), axes, np.array(speed), angle, angle, spins,
        [None] * count, pull, np.zeros((count, 3)), nothing, nothing, nothing, nothing, nothing,
    )  # fmt: skip


def test_what_comes_too_slowly_to_leave_is_captured_where_the_soil_has_no_answer() -> None:
    """Below the square root of g times the smallest edge, which half of that edge's lift is the energy of."""
    limit = math.sqrt(1e-5 * 0.1)

    class Silent:
        def answers(self, impacts: ImpactStates) -> Answers:
            found = Answers.unknown(len(impacts))
            found.outcome[impacts.speed >= 0.5] = TouchdownOutcome.CLEAR
            return found

    ground = SlowArrivals(Silent(), np.array([0.1]), np.array([0.002]))
    speeds = [0.99 * limit, 1.01 * limit, 0.6]
    found = ground.answers(states(speeds))
    assert found.outcome.tolist() == ["captured", UNKNOWN_END, "clear"]
    assert found.velocity[0] == pytest.approx([0.99 * limit * math.sin(math.radians(60.0)), 0.0, 0.0])
    assert "captured" not in ground.answers(states(speeds, spin=limit / 0.05)).outcome
    assert "captured" not in ground.answers(states(speeds, outward=1e-5)).outcome


def test_a_bounce_answers_a_touchdown_by_the_words_of_touchdowns() -> None:
    """Of an expansion: what it sends on is clear, what it captures is captured, and of the rest nothing is known."""
    found = Bounces(bounce([0.5]), 1, "ground").answers(states([0.3, 0.41]))
    assert found.outcome.tolist() == ["clear", UNKNOWN_END]
    assert np.linalg.norm(found.velocity[0]) == pytest.approx(0.15)
    again = Bounces(bounce([0.5]), 1, "ground").answers(states([0.3, 0.41]))
    assert np.array_equal(found.velocity, again.velocity)
    captured = Bounces(bounce([0.5], outcome="captured"), 1, "ground").answers(states([0.3]))
    assert captured.outcome.tolist() == ["captured"]
