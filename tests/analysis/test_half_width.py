"""Half widths: the range that a study is promised, when runs in stages stop, and what their interval is worth then."""

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

from lithobrake.analysis import (
    best_runs_a_bed,
    cost_over_best,
    half_width,
    half_width_of,
    half_width_range,
    next_run_count,
    scatter_of,
    share_estimate,
    unseen_limit,
)
from lithobrake.analysis.half_width import AllOrNothing, LikeRuns, Shares
from lithobrake.analysis.share_estimate import plain_interval
from lithobrake.chaos import sobol_sequence

from ..synthetic_landings import INPUTS, Truth, exact_share, returns

BED = np.arange(96) % 24


def test_where_all_come_to_rest_the_half_width_is_that_of_the_upper_limit() -> None:
    found = half_width_range(AllOrNothing(1.0, 1.0), BED)
    assert found == pytest.approx([0.5 * unseen_limit(BED)] * 3)


def test_the_range_holds_nine_in_ten_studies() -> None:
    """400 studies with half of the landers at rest or nearly all, on beds of beta laws of many correlations."""
    random, widths = np.random.default_rng(3), []
    for _ in range(400):
        share = 1.0 - 0.5 * random.random() ** 2
        size = 1.0 / min(random.exponential(0.05) + 1e-3, 0.5) - 1.0
        of_bed = random.beta(size * share + 1e-9, size * (1.0 - share) + 1e-9, 24)
        widths.append(half_width_of(random.random(96) < of_bed[BED], BED))
    found = half_width_range(AllOrNothing(1.0, 0.5), BED, correlation=0.05)
    held = np.mean((found.lower <= np.array(widths)) & (np.array(widths) <= found.upper))
    # Half widths of all or nothing are few values: those at the ends count as held.
    assert 0.86 <= held <= 0.97


def test_runs_that_have_ended_narrow_the_range_until_nothing_is_left_open() -> None:
    random = np.random.default_rng(1)
    values = (random.random(96) < 0.8).astype(float)
    law = LikeRuns(values[:32], BED[:32])
    before = half_width_range(AllOrNothing(1.0, 0.5), BED)
    third = half_width_range(law, BED[32:], values=values[:32], values_bed=BED[:32])
    ended = half_width_range(law, [], values=values, values_bed=BED)
    assert ended == pytest.approx([half_width_of(values, BED)] * 3)
    assert third.upper - third.lower < before.upper - before.lower
    assert third.lower < half_width_of(values, BED) < third.upper


def test_runs_that_all_end_alike_do_not_say_that_none_will_differ() -> None:
    ones = np.ones(32)
    found = half_width_range(LikeRuns(ones, BED[:32]), BED[32:], values=ones, values_bed=BED[:32])
    assert found.lower < 0.5 * (1.0 - 0.1 ** (1 / 24)) <= found.upper


def test_missing_runs_and_one_bed() -> None:
    law = Shares(0.75, 0.14, 0.21)
    all_known, some_lost = half_width_range(law, BED), half_width_range(law, BED, missing=0.1)
    assert 0.03 < some_lost.median - all_known.median < 0.06
    assert half_width_range(law, np.zeros(96)) is None
    with pytest.raises(ValueError, match=r"missing is 1\.5"):
        half_width_range(law, BED, missing=1.5)


def test_the_plain_interval_is_that_of_the_estimate() -> None:
    random = np.random.default_rng(2)
    for lost in (0, 5):
        values = np.clip(random.normal(0.7, 0.2, 96), 0.0, 1.0)
        values[random.permutation(96)[:lost]] = np.nan
        found = share_estimate(values, BED)
        assert plain_interval(values, BED) == pytest.approx(found.share.bounds)
    assert plain_interval(np.ones(5), np.zeros(5)) is None


def test_the_best_number_of_runs_a_bed_costs_least() -> None:
    best = best_runs_a_bed(25.0, 0.05)
    assert best == pytest.approx((25.0 * 0.95 / 0.05) ** 0.5)
    assert cost_over_best(best, best, 25.0, 0.05) == 1.0
    assert min(cost_over_best(one, best, 25.0, 0.05) for one in (0.5 * best, 2.0 * best)) > 1.05
    assert best_runs_a_bed(0.001) == 1.0
    assert best_runs_a_bed(1.0, 0.0) == np.inf
    with pytest.raises(ValueError, match="bed_cost is 0"):
        best_runs_a_bed(0.0)


def test_a_third_of_the_runs_says_what_all_of_them_give(monkeypatch: pytest.MonkeyPatch) -> None:
    """6 studies of 60 runs on 15 beds that are correlated by 0.05: nine in ten, less two standard deviations."""
    monkeypatch.setattr(half_width, "STUDIES", 100)
    random, held = np.random.default_rng(0), 0
    for _ in range(6):
        bed = np.concatenate([random.permutation(15) for _ in range(4)])
        values = (random.random(60) < random.beta(19.0 * 0.8, 19.0 * 0.2, 15)[bed]).astype(float)
        first = np.unique(bed[:20], return_inverse=True)[1]
        law, width = LikeRuns(values[:20], first), half_width_of(values, bed) or 0.0
        found = half_width_range(law, bed[20:], values=values[:20], values_bed=bed[:20], correlation=0.05)
        held += found is not None and found.lower <= width <= found.upper
    assert held >= 4


STUDIES, FIRST, LARGEST = 20, 120, 1200
Answers = Callable[[np.ndarray, np.ndarray], np.ndarray]


def captured(y: np.ndarray, outcome: np.ndarray) -> np.ndarray:
    return np.where(outcome == "left_sideways", np.nan, (outcome == "captured").astype(float))


def bed_count_of(run_count: int) -> int:
    """A bed for ten runs, from a dozen to sixty."""
    return min(60, max(12, -(-run_count // 10)))


def landings(truth: Truth, answer: Answers, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """The answers of all runs that a study could make, in their order, and their beds."""
    rng = np.random.default_rng(seed)
    x = sobol_sequence(INPUTS, LARGEST, seed=int(rng.integers(2**31)))
    few, growing = np.arange(120) % 12, np.arange(120, 600) // 10
    bed = np.concatenate([few, growing, np.arange(600, LARGEST) % 60])
    found = truth.draw(x, rng.standard_normal(60)[bed], rng)
    return answer(found.y, found.outcome), bed


def stop(values: np.ndarray, bed: np.ndarray, half_width: float) -> list[int]:
    """The counts of runs that a study goes through."""
    counts = [FIRST]
    while True:
        count = next_run_count(values[: counts[-1]], bed[: counts[-1]], half_width, LARGEST, bed_count_of)
        if count is None:
            return counts
        counts.append(count)


@pytest.mark.parametrize("rho", [0.0, 0.2])
def test_runs_go_on_until_the_interval_is_narrow_enough_and_then_it_holds_the_truth(rho: float) -> None:
    truth, half_width = Truth(rho=rho), 0.015
    exact, held, counts = exact_share(truth, 200_000), 0, []
    for seed in range(STUDIES):
        values, bed = landings(truth, returns, seed)
        path = stop(values, bed, half_width)
        end = path[-1]
        assert (half_width_of(values[:end], bed[:end]) or 1.0) <= half_width
        # It stopped at the first look that was good enough, and no look was a small step behind another.
        assert all((half_width_of(values[:n], bed[:n]) or 1.0) > half_width for n in path[:-1])
        assert all(1.1 * one - 5 <= other <= 2 * one for one, other in pairwise(path))
        estimate = share_estimate(values[:end], bed[:end])
        assert estimate.share.upper is not None
        held += estimate.share.lower <= exact <= estimate.share.upper
        counts.append(end)
    # A nominal 90 %, looked at several times, less 2.5 standard deviations of the share of so many studies.
    assert 0.9 - 2.5 * math.sqrt(0.09 / STUDIES) <= held / STUDIES <= 1.0
    # Beds that differ ask for more runs: t sd sqrt(rho / B + (1 - rho) / N) with sd 0.14 is 0.015 at 240 and 600.
    assert {0.0: 200, 0.2: 280}[rho] < np.mean(counts) < {0.0: 360, 0.2: 600}[rho]


def test_an_outcome_of_yes_or_no_asks_for_more_runs_and_missing_ones_for_more_still() -> None:
    ends = {}
    for rim in ("none", "random"):
        truth = Truth(capture=0.2, rim=rim)
        ends[rim] = [stop(*landings(truth, captured, seed), 0.03)[-1] for seed in range(20)]
    # 1.67 sqrt(0.16 / N) is 0.03 at 500 runs; a tenth of eight tenths is missing with a rim.
    assert 400 < np.mean(ends["none"]) < 620
    assert np.mean(ends["none"]) < np.mean(ends["random"])


def test_no_event_so_far_is_no_certainty() -> None:
    bed = np.arange(120) % 12
    # A share of up to 0.06 may hide behind no event in ten runs on each of a dozen beds.
    assert half_width_of(np.zeros(120), bed) == pytest.approx(0.5 * unseen_limit(bed))
    assert next_run_count(np.zeros(120), bed, 0.02, LARGEST, bed_count_of) == 240
    assert next_run_count(np.zeros(120), bed, 0.09, LARGEST, bed_count_of) is None
    assert scatter_of(np.zeros(120), bed) is None


def test_the_largest_count_ends_it_and_what_tells_nothing_doubles_the_runs() -> None:
    values, bed = landings(Truth(), returns, 0)
    assert next_run_count(values[:120], bed[:120], 1e-4, 130, bed_count_of) == 130
    assert next_run_count(values[:120], bed[:120], 1e-4, 120, bed_count_of) is None
    for told, beds in ((np.full(30, np.nan), bed[:30]), (values[:30], np.zeros(30))):
        assert half_width_of(told, beds) is None
        assert next_run_count(told, beds, 0.02, LARGEST, bed_count_of) == 60


def test_the_scatter_is_that_of_runs_and_beds() -> None:
    rng = np.random.default_rng(3)
    bed = np.arange(6000) % 60
    values = 0.5 + 0.03 * rng.standard_normal(60)[bed] + 0.04 * rng.standard_normal(6000)
    spread, correlation = scatter_of(values, bed) or (0.0, 0.0)
    # The variance of sixty beds is known to 18 %.
    assert (spread, correlation) == (pytest.approx(0.05, rel=0.15), pytest.approx(0.36, abs=0.15))
    assert scatter_of(values[:2], bed[:2]) == (pytest.approx(values[:2].std(ddof=1)), 0.0)
    assert scatter_of([0.3, np.nan], [0, 1]) is None


def test_what_landings_without_an_outcome_hide_asks_for_no_more_runs() -> None:
    rng, bed = np.random.default_rng(3), np.arange(240) % 24
    values = np.where(rng.random(240) < 0.05, np.nan, np.clip(0.7 + 0.1 * rng.standard_normal(240), 0.0, 1.0))
    width = half_width_of(values, bed)
    assert width == pytest.approx(1.71 * 0.1 / math.sqrt(228), rel=0.2)
    found = share_estimate(values, bed)
    assert 0.5 * (found.share.upper - found.share.lower) > 2.0 * width
    assert next_run_count(values, bed, 1.1 * width, 2400, lambda count: count // 10) is None
