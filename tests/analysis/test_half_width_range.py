"""The range of half widths that a study is promised, beside half widths of studies that are made up here."""

import numpy as np
import pytest

from lithobrake.analysis import best_runs_a_bed, cost_over_best, half_width_of, half_width_range, share_estimate
from lithobrake.analysis.half_width import AllOrNothing, LikeRuns, Shares
from lithobrake.analysis.share_estimate import plain_interval

BED = np.arange(96) % 24


def test_where_all_come_to_rest_the_half_width_is_that_of_the_upper_limit() -> None:
    found = half_width_range(AllOrNothing(1.0, 1.0), BED)
    assert found == pytest.approx([0.5 * (1.0 - 0.1 ** (1 / 24))] * 3)


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


def test_a_third_of_the_runs_says_what_all_of_them_give() -> None:
    """25 studies of 60 runs on 15 beds that are correlated by 0.05: nine in ten, less three standard deviations."""
    random, held = np.random.default_rng(0), 0
    for _ in range(25):
        bed = np.concatenate([random.permutation(15) for _ in range(4)])
        values = (random.random(60) < random.beta(19.0 * 0.8, 19.0 * 0.2, 15)[bed]).astype(float)
        first = np.unique(bed[:20], return_inverse=True)[1]
        law, width = LikeRuns(values[:20], first), half_width_of(values, bed) or 0.0
        found = half_width_range(law, bed[20:], values=values[:20], values_bed=bed[:20], correlation=0.05)
        held += found is not None and found.lower <= width <= found.upper
    assert held >= 18
