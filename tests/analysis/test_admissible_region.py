"""Edges of what is admissible: exact where the probability is, open where there is none, and true as often as told."""

import math
from collections.abc import Sequence

import numpy as np
import pytest

from lithobrake.analysis import refit_interval
from lithobrake.analysis.admissible_region import FEW, GAP, RISES_AND_FALLS, admissible_edge, verdict, with_grounds
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.requirement import Verdict

X = [1.0, 2.0, 3.0, 4.0]


def told(values: Sequence[float], half: float = 0.1) -> list[Estimate | None]:
    return [Estimate(value, value - half, value + half) for value in values]


def test_an_edge_lies_where_straight_lines_cross() -> None:
    """0.95, 0.9, 0.8, 0.6 crosses 0.7 in the middle of 3 and 4, and its ends a quarter before and behind."""
    edge = admissible_edge(X, told([0.95, 0.9, 0.8, 0.6], 0.05), 0.7)
    assert edge.falls
    assert (edge.value, edge.sure, edge.possible) == pytest.approx((3.5, 3.25, 3.75))
    rising = admissible_edge(X, told([0.6, 0.8, 0.9, 0.95], 0.05), 0.7)
    assert not rising.falls
    assert (rising.value, rising.sure, rising.possible) == pytest.approx((1.5, 1.75, 1.25))


def test_an_edge_beyond_the_values_is_infinite_on_the_side_that_says_so() -> None:
    every = admissible_edge(X, told([0.99, 0.98, 0.97, 0.96], 0.005), 0.9)
    assert (every.falls, every.value, every.sure) == (True, math.inf, math.inf)
    none = admissible_edge(X, told([0.6, 0.5, 0.4, 0.3]), 0.9)
    assert (none.value, none.sure, none.possible) == (-math.inf,) * 3
    rising = admissible_edge(X, told([0.91, 0.92, 0.93, 0.99], 0.001), 0.9)
    assert (rising.falls, rising.value) == (False, -math.inf)


def test_an_edge_is_one_of_the_values_with_a_result_and_one_alone_has_none() -> None:
    edge = admissible_edge(X, [*told([0.9, 0.8]), None, None], 0.85)
    assert (edge.value, edge.known) == (pytest.approx(1.5), (1.0, 2.0))
    above = admissible_edge(X, [None, None, *told([0.6, 0.5])], 0.9)
    assert (above.falls, above.value, above.known) == (True, -math.inf, (3.0, 4.0))
    assert admissible_edge(X, told([0.9, 0.8, 0.7, 0.6]), 0.85).known == (1.0, 4.0)
    alone = admissible_edge(X, [None, None, None, *told([0.9])], 0.85)
    assert (alone.why, alone.known) == (FEW, None)


@pytest.mark.parametrize("last", [0.5, 0.95])
def test_there_is_no_edge_across_values_without_a_result(last: float) -> None:
    """Whether the probability crosses what is required in the gap or seems to stay above it, nothing is known there."""
    edge = admissible_edge(X, [*told([0.99], 0.005), None, None, *told([last], 0.005)], 0.9)
    assert (edge.why, edge.known) == (GAP, (1.0, 4.0))
    assert math.isnan(edge.value)


def test_chance_is_smoothed_and_what_it_cannot_be_is_no_edge() -> None:
    assert admissible_edge(X, told([0.9, 0.80, 0.82, 0.7]), 0.75).why is None
    assert admissible_edge(X, told([0.5, 0.9, 0.9, 0.5]), 0.75).why == RISES_AND_FALLS


def test_a_verdict_is_that_of_the_interval() -> None:
    found = [verdict(Estimate(0.9, lower, upper), 0.9) for lower, upper in ((0.9, 1.0), (0.89, 0.95), (0.8, 0.899))]
    assert found == [Verdict.MET, Verdict.OPEN, Verdict.NOT_MET]


def test_the_interval_of_an_edge_holds_the_truth_as_often_as_it_says() -> None:
    """Rests by a Rayleigh law whose scale each study knows with an error of 8 %, as its refits to beds show.

    P(distance < R) = 1 - exp(-R2 / 2 s2) is 0.9 at s = R / sqrt(2 ln 10). Refits to B resampled beds scatter by
    sqrt((B - 1) / B) of that error, which refit_interval takes back; at 50 refits of 20 landers noise is added, so the
    interval may hold the truth more often than nine times in ten.
    """
    random, beds, refits, each, error = np.random.default_rng(5), 24, 50, 20, 0.08
    factors, radius = np.linspace(0.5, 1.6, 12), math.sqrt(2.0 * math.log(10.0))
    held, values = [], []
    for _ in range(200):
        study = random.normal(0.0, error)
        own = study + random.normal(0.0, error * math.sqrt((beds - 1) / beds), refits)
        # All factors have the same landers.
        way = random.rayleigh(1.0, (refits, each)) * np.exp(own)[:, None]
        found = []
        for factor in factors:
            counts = (factor * way < radius).sum(axis=1)
            found.append(refit_interval(counts, np.full(refits, each), beds))
        edge = admissible_edge(factors.tolist(), found, 0.9)
        values.append(edge.value)
        held.append(edge.sure <= 1.0 <= edge.possible)
    assert np.median(values) == pytest.approx(1.0, abs=0.03)
    assert 0.88 <= np.mean(held) <= 0.99


def test_one_ground_adds_what_grounds_differ_by() -> None:
    """Shares of 0.9 on half of the grounds and 0.5 on the others: one ground may have either."""
    bed = np.repeat(np.arange(24), 100)
    met = np.concatenate([np.arange(100) < (90 if one % 2 else 50) for one in range(24)]).astype(float)
    mean = Estimate(0.7, 0.65, 0.75)
    alone = with_grounds(mean, met, bed)
    assert alone.lower < 0.5
    assert alone.upper > 0.9
    alike = with_grounds(mean, np.tile(np.arange(100) < 70, 24).astype(float), bed)
    assert (alike.lower, alike.upper) == pytest.approx((0.65, 0.75), abs=0.02)
