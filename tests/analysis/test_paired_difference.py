"""Differences of paired studies: their intervals hold the truth, and are narrower the more pairs go together."""

import math

import numpy as np
import pytest
from scipy.special import ndtri

from lithobrake.analysis import quantile_difference, share_difference
from lithobrake.analysis.comparisons import pair_correlation

BEDS = 24
BED_OF_RUN = np.arange(96) % BEDS


def latent(random: np.random.Generator, correlation: float) -> tuple[np.ndarray, np.ndarray]:
    """Two normal numbers a pair, a tenth of whose variance is of the bed."""
    own = math.sqrt(1.0 - correlation**2)
    beds, pairs = random.standard_normal((2, BEDS)), random.standard_normal((2, len(BED_OF_RUN)))
    bed = [beds[0], correlation * beds[0] + own * beds[1]]
    pair = [pairs[0], correlation * pairs[0] + own * pairs[1]]
    first, second = (math.sqrt(0.1) * b[BED_OF_RUN] + math.sqrt(0.9) * p for b, p in zip(bed, pair, strict=True))
    return first, second


@pytest.mark.parametrize("correlation", [0.0, 0.5, 0.9])
def test_intervals_hold_the_truth(correlation: float) -> None:
    """150 studies: 0.9 within sampling error, or more; 0.83 is 2.9 standard errors below."""
    random, shares, medians = np.random.default_rng(3), 0, 0
    for _ in range(150):
        one, two = latent(random, correlation)
        share = share_difference(one < ndtri(0.5), two < ndtri(0.6), BED_OF_RUN)
        median = quantile_difference(np.exp(one), np.exp(two + 0.3), BED_OF_RUN, 0.5)
        for found in (share, median):
            assert found.difference.lower is not None
            assert found.difference.upper is not None
        shares += share.difference.lower <= 0.1 <= share.difference.upper
        medians += median.difference.lower <= math.expm1(0.3) <= median.difference.upper
    assert min(shares, medians) >= 0.83 * 150


def test_pairs_that_go_together_save_landings() -> None:
    random = np.random.default_rng(4)
    saved = []
    for correlation in (0.0, 0.9):
        found = [
            share_difference(one < 0.0, two < ndtri(0.6), BED_OF_RUN).landings_saved
            for one, two in (latent(random, correlation) for _ in range(20))
        ]
        saved.append(np.mean([one for one in found if one is not None]))
    assert saved[0] < 1.3
    assert saved[1] > 2.0


def test_a_study_against_itself_differs_by_nothing() -> None:
    one, _ = latent(np.random.default_rng(5), 0.0)
    found = quantile_difference(one, one, BED_OF_RUN, 0.5)
    assert (found.difference.value, found.correlation) == (0.0, pytest.approx(1.0))
    assert found.difference.upper == pytest.approx(-found.difference.lower)
    share = share_difference(one < 0.0, one < 0.0, BED_OF_RUN).difference
    assert (share.value, share.lower, share.upper) == pytest.approx((0.0, 0.0, 0.0), abs=1e-7)


def test_without_variation_there_is_no_correlation_and_the_interval_is_that_of_both() -> None:
    alike, mixed = np.ones(96), (np.arange(96) % 8 > 0).astype(float)
    found = share_difference(alike, mixed, BED_OF_RUN)
    assert (found.correlation, found.difference.value) == (None, pytest.approx(-0.125))
    assert found.unpaired == (found.difference.lower, found.difference.upper)
    assert pair_correlation(alike, mixed, BED_OF_RUN) is None


def test_runs_without_an_answer_widen_it_and_count_as_no_pair() -> None:
    one, two = latent(np.random.default_rng(6), 0.5)
    first, second = (one < 0.0).astype(float), (two < 0.0).astype(float)
    whole = share_difference(first, second, BED_OF_RUN)
    first[:10] = np.nan
    lacking = share_difference(first, second, BED_OF_RUN)
    assert (whole.pairs, lacking.pairs) == (96, 86)
    assert lacking.difference.upper - lacking.difference.lower > whole.difference.upper - whole.difference.lower


def test_a_reason_why_there_is_no_interval_is_kept_and_other_lengths_are_refused() -> None:
    one, two = latent(np.random.default_rng(7), 0.5)
    found = share_difference(one < 0.0, two < 0.0, BED_OF_RUN, why="one impact point")
    assert (found.difference.lower, found.difference.upper, found.landings_saved) == (None, None, None)
    with pytest.raises(ValueError, match="first has 96 runs and second 95"):
        share_difference(one < 0.0, (two < 0.0)[:95], BED_OF_RUN)
