"""Runs of which it is not known what became of them: every estimate holds what it would be, whatever they did."""

import math
from itertools import product

import numpy as np
import pytest

from lithobrake.analysis import (
    best_choice,
    direction_estimate,
    mean_estimate,
    quantile_difference,
    quantile_estimate,
    quantile_estimates,
    share_difference,
    variance_shares,
)
from lithobrake.analysis.bayesian_inference import open_quantiles
from lithobrake.analysis.ground_spread import median_over_grounds
from lithobrake.analysis.mean_over_grounds import mean_over_grounds
from lithobrake.analysis.missing_runs import filled, lost_runs
from lithobrake.analysis.output_estimates import mean_ends, quantile_ends
from lithobrake.analysis.smooth_curve import median_curve, share_curve
from lithobrake.chaos import Uniform, sobol_sequence

RUNS, BEDS = 240, 24
BED = np.arange(RUNS) % BEDS
RANDOM = np.random.default_rng(5)
WHOLE = np.exp(RANDOM.standard_normal(RUNS)) + 0.1 * RANDOM.standard_normal(BEDS)[BED] ** 2
# The largest are the ones that are lost.
LOST = np.quantile(WHOLE, 0.9) < WHOLE
KNOWN = np.where(LOST, np.nan, WHOLE)
LIMITS = (0.0, 2.0 * float(WHOLE.max()))


def test_missing_runs_are_asked_for_run_by_run() -> None:
    assert not lost_runs(None, KNOWN).any()
    assert (lost_runs(LOST, KNOWN) == LOST).all()
    for wrong in (LOST[:-1], LOST + 1.0, np.ones(RUNS)):
        with pytest.raises(ValueError, match="true only for a run without a value"):
            lost_runs(wrong, KNOWN)
    least, most = filled(KNOWN, LOST, LIMITS)
    assert (least[LOST] == 0.0).all()
    assert (most[LOST] == LIMITS[1]).all()
    assert (least[~LOST] == WHOLE[~LOST]).all()


@pytest.mark.parametrize("level", [0.05, 0.3, 0.5, 0.8, 0.95])
def test_a_quantile_reaches_from_all_missing_runs_below_to_all_above(level: float) -> None:
    found, plain = quantile_estimate(KNOWN, BED, level, missing=LOST), quantile_estimate(KNOWN, BED, level)
    # By hand: the quantiles of all runs with the missing ones below, and above, everything that is known.
    ends = [float(np.quantile(np.where(LOST, end, WHOLE), level, method="hazen")) for end in (-1e9, 1e9)]
    expected = tuple(end if abs(end) < 1e8 else None for end in ends)
    assert quantile_ends(KNOWN, level, LOST) == pytest.approx(expected)
    assert found.value == plain.value
    for end, bound, sign in zip(expected, (found.lower, found.upper), (-1.0, 1.0), strict=True):
        assert bound is None or (end is not None and sign * (bound - end) > 0.0)
    if None in (found.lower, found.upper):
        assert "24 runs of 240 (10.0 %) have no outcome" in (found.why_missing or "")
    assert [quantile_estimates(KNOWN, BED, [level], missing=LOST)[0]] == [found]
    within = quantile_estimate(KNOWN, BED, level, missing=LOST, limits=LIMITS)
    assert within.lower == (LIMITS[0] if found.lower is None else found.lower)
    assert within.upper == (LIMITS[1] if found.upper is None else found.upper)
    half = quantile_estimate(KNOWN, BED, level, missing=LOST, limits=(0.0, math.inf))
    assert half.upper == found.upper


def test_a_quantile_of_runs_that_are_all_known_is_what_it_was() -> None:
    nothing = np.zeros(RUNS, dtype=bool)
    assert quantile_estimate(WHOLE, BED, 0.5, missing=nothing) == quantile_estimate(WHOLE, BED, 0.5)
    assert quantile_ends(WHOLE, 0.5, nothing)[0] == quantile_ends(WHOLE, 0.5, None)[1] == np.median(WHOLE)


def test_a_quantile_of_counts_has_bounds_that_occur() -> None:
    counts = np.round(KNOWN * 3.0)
    found = quantile_estimate(counts, BED, 0.5, counts=True, missing=LOST)
    assert all(end == round(end) for end in (found.lower, found.value, found.upper) if end is not None)


def test_a_mean_is_bounded_by_the_limits_of_the_output_and_by_nothing_without() -> None:
    found, plain = mean_estimate(KNOWN, BED, missing=LOST, limits=LIMITS), mean_estimate(KNOWN, BED)
    ends = mean_ends(KNOWN, LOST, LIMITS)
    assert ends == pytest.approx([np.where(LOST, end, WHOLE).mean() for end in LIMITS])
    assert found.value == plain.value
    assert found.lower < min(ends[0], plain.lower)
    assert found.upper > max(ends[1], plain.upper)
    # The truth that the runs with an outcome miss.
    assert plain.upper < WHOLE.mean() < found.upper
    half = mean_estimate(KNOWN, BED, missing=LOST, limits=(0.0, math.inf))
    assert (half.lower, half.upper) == (pytest.approx(found.lower, rel=0.02), None)
    assert "nothing limits what they would add to the mean" in (half.why_missing or "")
    assert mean_estimate(KNOWN, BED, missing=LOST).bounds is None


def test_a_limit_may_be_each_runs_own() -> None:
    own = np.where(LOST, WHOLE, 99.0)
    assert mean_ends(KNOWN, LOST, (own, own)) == pytest.approx((WHOLE.mean(), WHOLE.mean()))


def test_one_ground_is_no_better_known_than_all() -> None:
    whole, one = quantile_estimate(KNOWN, BED, 0.5, missing=LOST), median_over_grounds(KNOWN, BED, missing=LOST)
    assert one.lower < whole.lower < whole.upper < one.upper
    mean = mean_estimate(KNOWN, BED, missing=LOST, limits=LIMITS)
    of_one = mean_over_grounds(KNOWN, BED, missing=LOST, limits=LIMITS)
    assert of_one.lower < mean.lower
    assert of_one.upper > mean.upper


def test_a_direction_turns_as_far_as_missing_runs_can_turn_it() -> None:
    angle = 0.3 * RANDOM.standard_normal(RUNS)
    known = np.where(LOST, np.nan, angle)
    found = direction_estimate(known, BED, missing=LOST)
    for turned in np.linspace(-math.pi, math.pi, 13):
        mean = np.exp(1j * np.where(LOST, turned, angle)).mean()
        assert found.mean_direction.lower < np.angle(mean) < found.mean_direction.upper
        assert found.resultant_length.lower < abs(mean) < found.resultant_length.upper


def test_curves_hold_missing_runs_at_either_end() -> None:
    size, met = np.geomspace(0.01, 0.1, BEDS)[BED], (WHOLE < 1.5).astype(float)
    known = np.where(LOST, np.nan, met)
    found = share_curve(known, size, BED, 1, LOST)
    for end in (0.0, 1.0):
        filled_in = share_curve(np.where(LOST, end, met), size, BED, 1)
        assert all(one.lower <= two.value <= one.upper for one, two in zip(found, filled_in, strict=True))
    median = median_curve(KNOWN, size, BED, 1, LOST)
    whole = median_curve(WHOLE, size, BED, 1)
    assert all(one.lower <= two.value <= one.upper for one, two in zip(median, whole, strict=True))


INPUTS = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}
X = sobol_sequence(INPUTS, RUNS, seed=3)


def test_parts_of_the_variance_hold_what_missing_runs_would_show() -> None:
    y = (X[:, 0] + 0.3 * np.random.default_rng(1).standard_normal(RUNS) > 0.6).astype(float)
    # All that failed had a large first input, so that without them it seems to matter less.
    lost = (X[:, 0] > 0.75) & (y == 1.0) & (np.arange(RUNS) % 3 > 0)
    known = np.where(lost, np.nan, y)
    whole = variance_shares(INPUTS, X, y, BED, soil=INPUTS)
    found = variance_shares(INPUTS, X, known, BED, soil=INPUTS, missing=lost, limits=(0.0, 1.0))
    alone = variance_shares(INPUTS, X, known, BED, soil=INPUTS)
    assert found.soil.value == alone.soil.value
    for name in ("soil", "bed", "place"):
        one, plain, true = (getattr(each, name) for each in (found, alone, whole))
        assert one.lower <= min(plain.lower, true.value)
        assert one.upper >= max(plain.upper, true.value)
    assert alone.soil_by_input["a"].upper < found.soil_by_input["a"].upper
    nothing = variance_shares(INPUTS, X, known, BED, soil=INPUTS, missing=lost)
    assert nothing.soil.bounds is None
    assert "nothing limits what they would add to the variance" in (nothing.soil.why_missing or "")


def test_a_difference_is_bounded_by_missing_runs_of_either_study() -> None:
    """All ways in which two lost runs of each study may end give a difference within the bounds."""
    random = np.random.default_rng(2)
    first, second = ((random.random(RUNS) < share).astype(float) for share in (0.5, 0.6))
    one, two = first.copy(), second.copy()
    one[:12], two[6:18] = np.nan, np.nan
    found = share_difference(one, two, BED)
    assert found.missing == (0.05, 0.05)
    for a, b in product((0.0, 1.0), repeat=2):
        ends = np.where(np.isnan(two), b, two).mean() - np.where(np.isnan(one), a, one).mean()
        assert found.difference.lower < ends < found.difference.upper
    # What missing runs leave open is no error that pairs could share: 0.05 of each study on either side.
    assert found.if_missing == pytest.approx((found.first.value * 0, 0.0), abs=0.3)
    assert found.if_missing[1] - found.if_missing[0] == pytest.approx(0.1)
    assert found.difference.upper - found.difference.lower > 0.1
    assert found.landings_saved is not None


def test_a_difference_of_quantiles_is_bounded_where_both_are() -> None:
    other = WHOLE * 1.3
    found = quantile_difference(KNOWN, other, BED, 0.5, missing=(LOST, np.zeros(RUNS, dtype=bool)))
    true = np.median(other) - np.median(WHOLE)
    assert found.difference.lower < true < found.difference.upper
    assert found.missing == (pytest.approx(0.1), 0.0)
    tail = quantile_difference(KNOWN, other, BED, 0.95, missing=(LOST, np.zeros(RUNS, dtype=bool)))
    assert (tail.difference.bounds, tail.if_missing) == (None, None)


def test_of_options_those_with_unknown_ends_may_be_the_best() -> None:
    random = np.random.default_rng(4)
    met = (random.random((3, 50, 40)) < np.array([0.8, 0.7, 0.2])[:, None, None]).astype(float)
    sure = best_choice(met, BEDS, [True] * 3)
    assert (sure.best, sure.not_worse) == (0, (0,))
    met[1, :, :8] = np.nan
    met[0, :, :2] = np.nan
    found = best_choice(met, BEDS, [True] * 3)
    assert (found.best, found.not_worse) == (0, (0, 1))
    assert found.own.value == pytest.approx(np.nanmean(met[0]), abs=0.01)
    least, most = (np.where(np.isnan(met[0]), end, met[0]).mean() for end in (0.0, 1.0))
    assert found.own.lower < least < most < found.own.upper
    assert (
        found.difference.lower
        < np.where(np.isnan(met[0]), 0.0, met[0]).mean() - np.where(np.isnan(met[1]), 1.0, met[1]).mean()
    )
    assert found.difference.upper > most - np.where(np.isnan(met[1]), 0.0, met[1]).mean()


def test_quantiles_of_open_weights_hold_those_of_every_law_between() -> None:
    random = np.random.default_rng(6)
    values, weights, factors = random.standard_normal(400), random.random(400), 1.0 + random.random(400)
    lower, upper = open_quantiles(values, weights, factors, (0.05, 0.95))
    for seed in range(50):
        own = weights * (1.0 + (factors - 1.0) * np.random.default_rng(seed).integers(0, 2, 400))
        order = np.argsort(values)
        steps = (np.cumsum(own[order]) - 0.5 * own[order]) / own.sum()
        low, high = np.interp([0.05, 0.95], steps, values[order])
        assert lower <= low + 0.01
        assert upper >= high - 0.01
    plain = open_quantiles(values, weights, np.ones(400), (0.05, 0.95))
    order = np.argsort(values)
    steps = (np.cumsum(weights[order]) - 0.5 * weights[order]) / weights.sum()
    assert plain == pytest.approx(np.interp([0.05, 0.95], steps, values[order]))
