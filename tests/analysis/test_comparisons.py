"""Comparisons against draws whose truth is known: the best of several choices, and differences of paired studies."""

import math

import numpy as np
import pytest
from scipy.special import ndtri

from lithobrake.analysis import best_choice, quantile_difference, quantile_within, ratio_difference, share_difference
from lithobrake.analysis.paired_difference import pair_correlation

BEDS = 24


def drawn(chances: list[float], spread: float, random: np.random.Generator, draws: int = 20) -> np.ndarray:
    """Whether draws met an event [choice, refit, draw]: the fit is wrong by a normal error, refits scatter about it."""
    fitted = np.array(chances) + spread * random.standard_normal(len(chances))
    # Drawing beds of beds scatters by a little less than beds do.
    refits = fitted[:, None] + spread * math.sqrt(1 - 1 / BEDS) * random.standard_normal((len(chances), 50))
    return random.random((len(chances), 50, draws)) < np.clip(refits, 0.0, 1.0)[:, :, None]


def test_the_difference_to_the_next_holds_the_truth_as_often_as_it_says() -> None:
    random, held = np.random.default_rng(1), 0
    for _ in range(300):
        found = best_choice(drawn([0.3, 0.7], 0.05, random), BEDS, [True, True])
        assert (found.best, found.runner_up) == (1, 0)
        held += found.difference.lower <= 0.4 <= found.difference.upper
    # Here 50 refits know the scatter, and Student's quantile of 23 degrees of freedom (1.714) is that of a normal error
    # at 0.9135; two standard deviations of luck.
    assert abs(held / 300 - 0.9135) < 2 * math.sqrt(0.9135 * 0.0865 / 300)


def test_choices_that_are_alike_share_the_refits_and_a_clear_one_has_them_all() -> None:
    random = np.random.default_rng(2)
    alike = np.mean([best_choice(drawn([0.5] * 4, 0.05, random), BEDS, [True] * 4).shares for _ in range(60)], axis=0)
    assert alike == pytest.approx([0.25] * 4, abs=0.06)
    found = best_choice(drawn([0.2, 0.8, 0.5], 0.03, random), BEDS, [True] * 3)
    assert found.shares.tolist() == [0.0, 1.0, 0.0]
    assert found.difference.lower > 0.0


def test_few_draws_of_a_refit_leave_the_best_less_sure_but_far_surer_than_their_own_luck_does() -> None:
    random, shares = np.random.default_rng(3), {}
    for draws in (6, 60):
        all_met = [drawn([0.5, 0.6], 0.04, random, draws) for _ in range(200)]
        shares[draws] = np.mean([best_choice(met, BEDS, [True] * 2).shares[1] for met in all_met])
        shares[-draws] = np.mean([met.mean(axis=2)[1] > met.mean(axis=2)[0] for met in all_met])
    assert shares[-6] + 0.1 < shares[6] < shares[60]
    # The truth, of two errors of 0.04 each: the chance of 1.77 standard deviations.
    assert shares[60] == pytest.approx(0.9, abs=0.05)


def test_the_own_share_of_the_best_of_many_is_freed_of_what_its_selection_adds() -> None:
    random, own, plain, held, within = np.random.default_rng(5), [], [], 0, 0
    chances = np.append(np.full(20, 0.3), np.full(5, 0.55))
    for _ in range(60):
        met = drawn(chances.tolist(), 0.05, random)
        found = best_choice(met, BEDS, [True] * 25)
        own.append(found.own.value - 0.55)
        plain.append(met[found.best].mean() - 0.55)
        held += found.own.lower <= 0.55 <= found.own.upper
        within += found.best in found.not_worse and any(one >= 20 for one in found.not_worse)
    assert np.mean(plain) > 0.04
    # Three standard errors of sixty studies about what larger ones found, 0.01 left of 0.056.
    assert abs(np.mean(own) - 0.01) < 3.0 * np.std(own) / math.sqrt(60)
    assert held / 60 > 0.9 - 0.116
    assert within / 60 > 0.9 - 0.116


def test_what_cannot_be_told_from_the_best_is_named_and_what_can_is_not() -> None:
    met = drawn([0.9, 0.5, 0.5, 0.2], 0.02, np.random.default_rng(7), draws=60)
    assert best_choice(met, BEDS, [False, True, True, True]).not_worse == (1, 2)
    assert best_choice(met, BEDS, [True] * 4).not_worse == (0,)
    alone = best_choice(met, BEDS, [False, False, True, False])
    assert alone.not_worse == (2,)
    assert alone.own.value == pytest.approx(met[2].mean())


def test_what_is_not_allowed_is_never_the_best() -> None:
    met = drawn([0.9, 0.5, 0.3], 0.02, np.random.default_rng(4))
    found = best_choice(met, BEDS, [False, True, True])
    assert (found.best, found.runner_up, found.shares[0]) == (1, 2, 0.0)
    alone = best_choice(met, BEDS, [False, False, True])
    assert (alone.best, alone.runner_up, alone.difference, alone.shares[2]) == (2, None, None, 1.0)


@pytest.mark.parametrize("allowed", [[False, False], [True, True]])
def test_what_says_nothing_is_refused(allowed: list[bool]) -> None:
    met = drawn([0.5, 0.5], 0.1, np.random.default_rng(5), draws=2 if not any(allowed) else 1)
    with pytest.raises(ValueError, match="at least two refits, two draws of each"):
        best_choice(met, BEDS, allowed)


def test_a_quantile_has_the_bounds_at_the_levels_of_its_share() -> None:
    values = np.arange(1, 101)
    middle, lower, upper = quantile_within(values, 0.95, (0.9, 0.98))
    assert (middle, lower, upper) == pytest.approx((95.5, 90.5, 98.5))
    assert quantile_within(values, 0.95, (0.001, 0.999))[1:] == (-math.inf, math.inf)


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
    """Sixty studies: 0.9 within sampling error, or more; 2.9 standard errors below it is least."""
    count = 60
    random, shares, medians = np.random.default_rng(3), 0, 0
    for _ in range(count):
        one, two = latent(random, correlation)
        share = share_difference(one < ndtri(0.5), two < ndtri(0.6), BED_OF_RUN)
        median = quantile_difference(np.exp(one), np.exp(two + 0.3), BED_OF_RUN, 0.5)
        for found in (share, median):
            assert found.difference.lower is not None
            assert found.difference.upper is not None
        shares += share.difference.lower <= 0.1 <= share.difference.upper
        medians += median.difference.lower <= math.expm1(0.3) <= median.difference.upper
    assert min(shares, medians) >= (0.9 - 2.9 * math.sqrt(0.09 / count)) * count


@pytest.mark.parametrize("correlation", [0.0, 0.5, 0.9])
def test_the_interval_of_a_typical_ratio_holds_it(correlation: float) -> None:
    """300 studies of lognormal numbers: 0.9 within three standard errors."""
    random, held, saved = np.random.default_rng(8), 0, []
    for _ in range(300):
        one, two = latent(random, correlation)
        found = ratio_difference(np.exp(one), 1.3 * np.exp(two), BED_OF_RUN)
        assert found.difference.lower is not None
        assert found.difference.upper is not None
        held += found.difference.lower <= 0.3 <= found.difference.upper
        saved.append(found.landings_saved)
    assert abs(held / 300 - 0.9) < 3 * math.sqrt(0.09 / 300)
    # What is left of the variance of a difference of logarithms.
    assert np.median(saved) == pytest.approx(1.0 / (1.0 - correlation), rel=0.15)


def test_a_typical_ratio_is_of_the_pairs_that_have_both_numbers() -> None:
    one, two = np.array([1.0, 2.0, np.nan, 0.0, 8.0]), np.array([2.0, 4.0, 1.0, 5.0, 16.0])
    found = ratio_difference(one, two, [0, 1, 1, 2, 2])
    assert (found.pairs, found.is_ratio) == (3, True)
    assert (found.first.value, found.second.value) == pytest.approx((16.0 ** (1 / 3), 2.0 * 16.0 ** (1 / 3)))
    assert found.difference.value == pytest.approx(1.0)
    for bed, why in (([0] * 5, None), ([0, 1, 1, 2, 2], "one impact point")):
        without = ratio_difference(one, two, bed, why=why)
        assert (without.difference.lower, without.unpaired, without.landings_saved) == (None, None, None)
        assert without.difference.value == pytest.approx(1.0)
    # Nothing limits the ratio of a run of which it is not known what became of it.
    unknown = ratio_difference(one, two, [0, 1, 1, 2, 2], missing=(np.isnan(one), np.zeros(5, dtype=bool)))
    assert (unknown.missing, unknown.difference.bounds, unknown.landings_saved) == ((0.2, 0.0), None, None)
    assert unknown.difference.value == pytest.approx(1.0)
    none = ratio_difference(one, np.full(5, np.nan), [0, 1, 1, 2, 2])
    assert (none.pairs, none.difference.is_known) == (0, False)


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
