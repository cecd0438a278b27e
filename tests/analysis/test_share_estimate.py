"""A fraction of the landings: closed forms, what gives no interval, landings without an outcome."""

import math
from typing import Any

import numpy as np
import pytest
from scipy import stats

from lithobrake.analysis import (
    LEVEL,
    expected_half_width,
    regression_terms,
    runs_for_half_width,
    share_estimate,
    unseen_limit,
)
from lithobrake.analysis.share_estimate import standard_error
from lithobrake.chaos import Uniform, sobol_sequence

INPUTS = {"friction": Uniform(0.2, 0.9), "restitution": Uniform(0.3, 0.9)}


def runs(bed_count: int, on_each: int, seed: int = 0, bed_spread: float = 0.05) -> tuple[np.ndarray, np.ndarray]:
    """Shares of runs, clear of 0 and 1, and their beds."""
    rng = np.random.default_rng(seed)
    bed = np.repeat(np.arange(bed_count), on_each)
    scatter = bed_spread * rng.standard_normal(bed_count)[bed] + 0.1 * rng.uniform(-1.0, 1.0, len(bed))
    return np.clip(0.5 + scatter, 0.0, 1.0), bed


def test_with_a_run_a_bed_it_is_the_interval_of_student() -> None:
    h, _ = runs(30, 1)
    found = share_estimate(h, np.arange(30))
    half = stats.t.ppf(0.95, 29) * h.std(ddof=1) / math.sqrt(30)
    assert (found.share.value, found.share.lower, found.share.upper) == pytest.approx(
        (h.mean(), h.mean() - half, h.mean() + half)
    )
    assert (found.share.level, found.share.why_missing, found.next_bed) == (LEVEL, None, None)
    assert found.from_ == "30 landings on 30 beds"


def test_the_error_is_that_of_clusters_in_statsmodels() -> None:
    statsmodels = pytest.importorskip("statsmodels.regression.linear_model", reason="statsmodels is not installed")
    h, bed = runs(12, 10, bed_spread=0.1)
    fit = statsmodels.OLS(h, np.ones(len(h))).fit(cov_type="cluster", cov_kwds={"groups": bed})
    # Theirs has a factor (N - 1) / (N - p) beside B / (B - 1), which is 1 for a mean.
    assert standard_error(h, bed) == pytest.approx(float(fit.bse[0]), rel=1e-12)


def test_weighted_runs_are_those_of_weighted_least_squares() -> None:
    statsmodels = pytest.importorskip("statsmodels.regression.linear_model", reason="statsmodels is not installed")
    h, bed = runs(12, 10, bed_spread=0.1)
    w = np.random.default_rng(1).uniform(0.5, 2.0, len(h))
    fit = statsmodels.WLS(h, np.ones(len(h)), weights=w).fit(cov_type="cluster", cov_kwds={"groups": bed})
    found = share_estimate(h, bed, weights=w)
    half = stats.t.ppf(0.95, 11) * float(fit.bse[0])
    assert found.share.value == pytest.approx(float(fit.params[0]))
    assert found.share.upper == pytest.approx(found.share.value + half, rel=1e-9)


def test_beds_that_differ_less_than_chance_do_not_narrow_the_interval() -> None:
    h = np.tile([0.3, 0.7], 20)
    found = share_estimate(h, np.repeat(np.arange(10), 4))
    assert found.share.upper - found.share.value == pytest.approx(stats.t.ppf(0.95, 9) * h.std(ddof=1) / math.sqrt(40))


@pytest.mark.parametrize("bed_count", [2, 3, 12])
def test_the_next_bed_is_never_better_known_than_the_mean(bed_count: int) -> None:
    for seed in range(20):
        found = share_estimate(*runs(bed_count, 10, seed, bed_spread=0.0))
        assert found.next_bed[0] <= found.share.lower < found.share.upper <= found.next_bed[1]


def test_what_the_inputs_explain_is_taken_off_without_moving_the_mean() -> None:
    x = sobol_sequence(INPUTS, 240, seed=2)
    h, bed = runs(24, 10, bed_spread=0.0)
    # Consecutive points of a sequence would be alike on every bed, and their sums over beds scatter little anyhow.
    h, bed = np.clip(h + 0.5 * (x[:, 0] - 0.55), 0.0, 1.0), np.random.default_rng(1).permutation(bed)
    plain, less = share_estimate(h, bed), share_estimate(h, bed, terms=regression_terms(INPUTS, x))
    assert less.share.value == pytest.approx(plain.share.value, abs=0.01)
    assert less.share.upper - less.share.lower < 0.8 * (plain.share.upper - plain.share.lower)


def test_an_adaptive_design_is_weighted_back_to_the_law() -> None:
    rng, shares = np.random.default_rng(3), []
    for _ in range(40):
        u = rng.beta(2.0, 1.0, 200)
        x = np.column_stack([0.2 + 0.7 * u, rng.uniform(0.3, 0.9, 200)])
        noisy = np.clip(u + 0.3 * rng.uniform(-1.0, 1.0, 200) * np.minimum(u, 1.0 - u), 0.0, 1.0)
        # Density of u: 1 by the law, 2 u as drawn.
        found = share_estimate(noisy, np.arange(200) % 10, terms=regression_terms(INPUTS, x), weights=0.5 / u)
        shares.append(found.share.value)
    # The mean of a uniform number, within three standard errors of 40 studies.
    assert np.mean(shares) == pytest.approx(0.5, abs=3.0 * np.std(shares) / math.sqrt(40))


def test_one_bed_or_a_reason_gives_no_interval_and_says_why() -> None:
    h, bed = runs(12, 10)
    one = share_estimate(h, np.zeros(len(h)))
    assert (one.share.lower, one.share.upper, one.next_bed) == (None, None, None)
    assert "bed.bed_count" in one.share.why_missing
    place = share_estimate(h, bed, why="all runs came down on one place")
    assert (place.share.lower, place.share.why_missing) == (None, "all runs came down on one place")
    assert place.share.value == pytest.approx(h.mean())


def test_where_no_run_returns_the_upper_end_is_that_of_so_many_runs_on_so_many_beds() -> None:
    bed = np.repeat(np.arange(12), 10)
    none = share_estimate(np.zeros(120), bed)
    assert (none.share.value, none.share.lower) == (0.0, 0.0)
    assert none.share.upper == unseen_limit(bed)
    every = share_estimate(np.ones(120), bed).share
    assert (every.value, every.lower, every.upper) == pytest.approx((1.0, 1.0 - none.share.upper, 1.0))


@pytest.mark.parametrize("rare", [0.02, 0.98])
def test_near_0_and_1_the_interval_stays_inside(rare: float) -> None:
    h = np.full(120, round(1.0 - rare))
    h[::50] = round(rare)
    found = share_estimate(h, np.repeat(np.arange(12), 10))
    assert 0.0 < found.share.lower < found.share.value < found.share.upper < 1.0


def test_the_interval_is_that_of_all_the_landings_without_an_outcome_may_be() -> None:
    h, bed = runs(12, 10)
    h[::20] = np.nan
    found, known = share_estimate(h, bed), h[np.isfinite(h)]
    assert (found.missing, found.from_) == (0.05, "114 of 120 landings on 12 beds")
    assert found.share.value == pytest.approx(known.mean())
    assert found.if_missing == pytest.approx((known.sum() / 120, (known.sum() + 6) / 120))
    errors = [standard_error(np.where(np.isfinite(h), h, end), bed) for end in (0.0, 1.0)]
    # Imbens and Manski: the number of errors with which each fraction between both ends is held at the level.
    factor = (found.if_missing[0] - found.share.lower) / errors[0]
    assert found.share.upper == pytest.approx(found.if_missing[1] + factor * errors[1])
    assert stats.t.cdf(factor + 0.05 / max(errors), 11) - stats.t.cdf(-factor, 11) == pytest.approx(LEVEL)
    assert stats.t.ppf(0.9, 11) < factor < stats.t.ppf(0.95, 11)
    assert found.next_bed[0] < found.share.lower < found.share.upper < found.next_bed[1]
    whole = share_estimate(known, bed[np.isfinite(h)])
    assert whole.if_missing == (whole.share.value, whole.share.value)
    assert (whole.missing, whole.from_) == (0.0, "114 landings on 12 beds")
    assert found.share.lower < whole.share.lower < whole.share.upper < found.share.upper


def test_one_landing_without_an_outcome_hardly_widens_the_interval() -> None:
    h, bed = runs(24, 30, bed_spread=0.0)
    whole = share_estimate(h, bed)
    found = share_estimate(np.where(np.arange(720) == 7, np.nan, h), bed)
    assert found.from_ == "719 of 720 landings on 24 beds"
    assert (found.share.lower, found.share.upper) == pytest.approx(
        (whole.share.lower, whole.share.upper), abs=1.5 / 720
    )
    assert 0.0 < (found.share.upper - found.share.lower) - (whole.share.upper - whole.share.lower) < 1.0 / 720


def test_the_interval_holds_where_the_fast_ones_are_lost_and_none_of_them_returns() -> None:
    held = {"all": 0, "answered": 0}
    for seed in range(120):
        rng = np.random.default_rng(seed)
        speed, bed = rng.random(240), np.arange(240) % 24
        returns = np.where(speed > 0.9, np.nan, (rng.random(240) < 0.8).astype(float))
        known = np.isfinite(returns)
        for name, found in (
            ("all", share_estimate(returns, bed)),
            ("answered", share_estimate(returns[known], bed[known])),
        ):
            held[name] += found.share.lower <= 0.9 * 0.8 <= found.share.upper
    # The truth is the lower end of what may be, so the interval misses at one side alone: at the level, within three
    # standard deviations of 120 studies.
    assert held["all"] / 120 == pytest.approx(LEVEL, abs=3.0 * math.sqrt(0.09 / 120.0))
    assert held["answered"] / 120 < 0.2


def test_landings_without_an_outcome_take_the_mean_of_those_like_them_in_the_estimate() -> None:
    h, bed = runs(12, 10)
    h[:12], h[12:18] = np.nan, 0.0
    like = np.arange(120) < 18
    plain, found = share_estimate(h, bed), share_estimate(h, bed, like_missing=like)
    assert plain.share.value == pytest.approx(np.nanmean(h))
    assert found.share.value == pytest.approx(np.nansum(h) / 120)
    assert (found.share.lower, found.share.upper) == (plain.share.lower, plain.share.upper)
    # Four like them say less than all.
    assert share_estimate(h, bed, like_missing=np.arange(120) < 16).share.value == plain.share.value


@pytest.mark.parametrize("end", [0.0, 1.0])
def test_the_estimate_lies_within_its_interval_where_all_with_an_outcome_end_alike(end: float) -> None:
    h, bed = np.full(120, end), np.repeat(np.arange(12), 10)
    h[::40] = np.nan
    found = share_estimate(h, bed)
    assert found.share.lower <= found.if_missing[0] <= found.share.value <= found.if_missing[1] <= found.share.upper
    assert found.share.value == end
    # Three of 120 may be otherwise, and so may so many landings on so many beds.
    assert found.share.upper - found.share.lower >= unseen_limit(bed)


def test_a_new_bed_may_lie_beyond_the_interval_of_the_share() -> None:
    h, bed = runs(12, 10)
    found = share_estimate(h, bed)
    assert found.next_bed[0] < found.share.lower < found.share.value < found.share.upper < found.next_bed[1]


def test_what_cannot_be_is_refused() -> None:
    h, bed = runs(12, 10)
    with pytest.raises(ValueError, match="no outcome"):
        share_estimate(np.full(3, np.nan), [0, 0, 1])
    with pytest.raises(ValueError, match=r"reaches from .* to 1\.2"):
        share_estimate(np.append(h, 1.2), np.append(bed, 0))
    with pytest.raises(ValueError, match="one label for each run"):
        share_estimate(h, bed[1:])
    with pytest.raises(ValueError, match="above 0"):
        share_estimate(h, bed, weights=np.zeros(120))


def test_half_widths_are_foreseen() -> None:
    # STUDENT(23) at 0.95 is 1.7139; 240 runs on 24 beds without an effect of beds.
    assert expected_half_width(240, 24, correlation=0.0) == pytest.approx(1.7139 * 0.21 / math.sqrt(240), rel=1e-4)
    assert expected_half_width(240, 1) is None
    count = runs_for_half_width(0.02, 10)
    assert expected_half_width(count, count // 10) <= 0.02 < expected_half_width(count - 10, count // 10 - 1)
    widths = [share_estimate(*runs(24, 10, seed, bed_spread=0.03)) for seed in range(30)]
    spread = math.hypot(0.03, 0.1 / math.sqrt(3.0))
    expected = expected_half_width(240, 24, spread=spread, correlation=(0.03 / spread) ** 2)
    assert np.mean([0.5 * (one.share.upper - one.share.lower) for one in widths]) == pytest.approx(expected, rel=0.05)
    with pytest.raises(ValueError, match="a whole number from 1 to 5"):
        expected_half_width(5, 6)
    with pytest.raises(ValueError, match="half_width is 0"):
        runs_for_half_width(0.0)


def test_the_next_bed_of_a_share_near_one_is_a_share_and_is_held() -> None:
    random, held, lowest = np.random.default_rng(5), 0, 1.0
    for _ in range(200):
        # Beds of a beta law with mean 0.95 and deviation 0.05, ten landings on each of fifteen, all or nothing.
        of_beds = random.beta(17.1, 0.9, 16)
        returns = random.random(150) < np.repeat(of_beds[:15], 10)
        found = share_estimate(returns.astype(float), np.repeat(np.arange(15), 10))
        if found.next_bed is None:
            continue
        lowest = min(lowest, found.next_bed[0])
        held += found.next_bed[0] <= of_beds[15] <= found.next_bed[1]
    assert held >= 170
    assert lowest > 0.3


@pytest.mark.parametrize(("given", "words"), [
    ({"terms": (np.zeros((3, 1)), np.zeros((1, 1), dtype=np.int64))}, "terms are of 3 runs and shares of 4"),
    ({"like_missing": [True]}, r"like_missing has shape \(1,\); give true or false for each of 4 runs"),
    ({"like_missing": [np.nan] * 4}, "give true or false for each of 4 runs"),
    ({"like_missing": ["False"] * 4}, "like_missing must be an array of real numbers"),
])  # fmt: skip
def test_what_is_not_of_the_runs_is_refused(given: dict[str, Any], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        share_estimate([0.0, 1.0, 0.5, 0.2], [0, 0, 1, 1], **given)
