"""Mean and quantiles of an output, and mean direction and resultant length of an angle, with intervals from beds."""

import math

import numpy as np
import pytest
from scipy import stats

from lithobrake.analysis import direction_estimate, mean_estimate, quantile_estimate, quantile_estimates


def test_with_a_run_a_bed_the_mean_has_the_interval_of_student() -> None:
    y = np.random.default_rng(0).exponential(size=40)
    found = mean_estimate(y, np.arange(40))
    half = stats.t.ppf(0.95, 39) * y.std(ddof=1) / math.sqrt(40)
    assert (found.value, found.lower, found.upper) == pytest.approx((y.mean(), y.mean() - half, y.mean() + half))


def test_quantiles_follow_the_output_and_hold_their_estimates() -> None:
    rng, bed = np.random.default_rng(1), np.arange(240) % 24
    y = rng.exponential(size=240)
    found = quantile_estimates(y, bed)
    assert [one.value for one in found] == pytest.approx(np.quantile(y, [0.05, 0.5, 0.95], method="hazen").tolist())
    assert all(y.min() <= one.lower < one.value < one.upper <= y.max() for one in found)
    # A monotone scale changes nothing but the scale, up to interpolation between neighbours.
    logs = quantile_estimates(np.log(y), bed)
    assert [math.exp(one.upper) for one in logs] == pytest.approx([one.upper for one in found], rel=0.01)


def test_runs_on_beds_that_differ_say_less() -> None:
    rng, bed = np.random.default_rng(2), np.arange(240) % 12
    y = rng.standard_normal(240)
    alone, shared = mean_estimate(y, bed), mean_estimate(y + rng.standard_normal(12)[bed], bed)
    assert shared.upper - shared.lower > 2.0 * (alone.upper - alone.lower)


def test_runs_without_the_output_are_left_out() -> None:
    rng, bed = np.random.default_rng(3), np.arange(60) % 6
    y = rng.standard_normal(60)
    y[bed == 5] = np.nan
    kept = np.isfinite(y)
    assert mean_estimate(y, bed) == mean_estimate(y[kept], bed[kept])
    assert quantile_estimates(y, bed, [0.5]) == quantile_estimates(y[kept], bed[kept], [0.5])


def test_few_beds_give_no_interval_of_a_tail() -> None:
    rng = np.random.default_rng(4)
    y = rng.standard_normal(90)
    for bed_count, told in ((9, False), (10, True)):
        low, middle, high = quantile_estimates(y, np.arange(90) % bed_count)
        for one in (low, high):
            assert (one.lower is not None) == (one.upper is not None) == told
            assert math.isfinite(one.value)
        assert math.isfinite(middle.upper - middle.lower)


@pytest.mark.parametrize("rho", [0.05, 0.2])
def test_an_interval_of_a_tail_on_ten_beds_holds_the_truth(rho: float) -> None:
    held = []
    for seed in range(100):
        rng, bed = np.random.default_rng(seed), np.arange(100) % 10
        y = np.exp(math.sqrt(rho) * rng.standard_normal(10)[bed] + math.sqrt(1.0 - rho) * rng.standard_normal(100))
        found = quantile_estimates(y, bed, [0.05, 0.95])
        held.append([one.lower <= math.exp(z) <= one.upper for one, z in zip(found, (-1.6449, 1.6449), strict=True)])
    # Three standard deviations of 200 intervals below the level.
    assert np.mean(held) >= 0.836


def test_one_bed_and_impossible_probabilities_are_refused() -> None:
    with pytest.raises(ValueError, match="landed on 1 bed"):
        mean_estimate(np.arange(5.0), np.zeros(5))
    with pytest.raises(ValueError, match="between 0 and 1"):
        quantile_estimates(np.arange(5.0), np.arange(5), (0.0,))


def test_an_end_that_cannot_be_told_has_a_reason() -> None:
    rng, bed = np.random.default_rng(5), np.arange(96) % 12
    y = rng.exponential(size=96)
    # Beds that differ: the share below the quantile may reach 1.
    apart = quantile_estimate(y + 5.0 * bed, bed, 0.95)
    assert apart.lower is not None
    assert (apart.upper, apart.why_missing) == (None, "the upper end lies beyond all 96 values")
    few = quantile_estimate(y, bed % 9, 0.95)
    assert (few.lower, few.upper) == (None, None)
    assert "9 beds" in str(few.why_missing)
    assert "one bed" in str(quantile_estimate(y, np.zeros(96), 0.5).why_missing)
    assert quantile_estimate(y, bed, 0.5, why="one impact point").why_missing == "one impact point"
    none = quantile_estimate(np.full(96, np.nan), bed, 0.5)
    assert (none.is_known, none.lower, none.why_missing) == (False, None, "no run has this output")
    with pytest.raises(ValueError, match="between 0 and 1"):
        quantile_estimate(y, bed, 1.0)


def test_the_interval_of_a_tail_is_that_of_a_binomial_law() -> None:
    """2000 independent runs: the order statistics of Student's t and the normal law are those of the binomial one."""
    y, bed = np.random.default_rng(6).exponential(size=2000), np.arange(2000)
    found = quantile_estimate(y, bed, 0.95)
    assert found.value == pytest.approx(np.quantile(y, 0.95, method="hazen"))
    for end, share in ((found.lower, 0.05), (found.upper, 0.95)):
        assert np.mean(y <= end) == pytest.approx(stats.binom.ppf(share, 2000, 0.95) / 2000, abs=1.5e-3)
    # Far from the ends it is Woodruff's with a normal law.
    median, (plain,) = quantile_estimate(y, bed, 0.5), quantile_estimates(y, bed, [0.5])
    assert (median.lower, median.upper) == pytest.approx((plain.lower, plain.upper), rel=2e-3)


def test_a_count_has_quantiles_that_occur() -> None:
    bed = np.arange(240) % 24
    y = np.random.default_rng(7).poisson(3.0, size=240).astype(float)
    for probability in (0.5, 0.95):
        found = quantile_estimate(y, bed, probability, counts=True)
        assert {found.value, found.lower, found.upper} <= set(y)
        assert found.value == stats.poisson.ppf(probability, 3.0)
        assert found.upper is not None
        assert found.lower <= found.value <= found.upper
    same = quantile_estimate(np.full(240, 4.0), bed, 0.5, counts=True)
    assert (same.value, same.lower, same.upper) == (4.0, 4.0, 4.0)


def angles(bed_count: int, concentration: float, middle: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Angles of a von Mises law on beds of ten, turned by 0.2 rad from bed to bed."""
    rng, bed = np.random.default_rng(seed), np.arange(10 * bed_count) % bed_count
    return rng.vonmises(middle, concentration, len(bed)) + 0.2 * rng.standard_normal(bed_count)[bed], bed


def test_the_mean_direction_of_angles_on_both_sides_of_a_half_turn_lies_between_them() -> None:
    found = direction_estimate(np.radians([170.0, -170.0, 180.0, 170.0, -170.0, np.nan]), [0, 0, 1, 1, 2, 2])
    assert abs(found.mean_direction.value) == pytest.approx(math.pi)
    assert found.resultant_length.value == pytest.approx((4.0 * math.cos(math.radians(10.0)) + 1.0) / 5.0)
    assert found.mean_direction.value == pytest.approx(stats.circmean(np.radians([170.0, 190.0, 180.0, 170.0, 190.0])))


def test_bounds_turn_with_the_angle_and_go_beyond_a_half_turn() -> None:
    y, bed = angles(12, 2.0, 0.0, 1)
    plain, turned = direction_estimate(y, bed), direction_estimate(y + math.pi, bed)
    assert turned.mean_direction.bounds[0] < math.pi < turned.mean_direction.bounds[1] or (
        turned.mean_direction.bounds[0] < -math.pi < turned.mean_direction.bounds[1]
    )
    assert turned.resultant_length.bounds == pytest.approx(plain.resultant_length.bounds)
    widths = [one.mean_direction.bounds[1] - one.mean_direction.bounds[0] for one in (plain, turned)]
    assert widths[0] == pytest.approx(widths[1])


@pytest.mark.parametrize(("bed_count", "concentration"), [(12, 0.2), (12, 1.0), (24, 4.0)])
def test_both_intervals_hold_the_truth(bed_count: int, concentration: float) -> None:
    # Independent turns multiply the resultant lengths of both: I1 / I0, and exp(-0.2^2 / 2).
    length = stats.vonmises(concentration).expect(np.cos) * math.exp(-0.02)
    held = []
    for seed in range(120):
        found = direction_estimate(*angles(bed_count, concentration, 3.0, seed))
        lower, upper = found.mean_direction.bounds
        turns = 3.0 + 2.0 * math.pi * np.arange(-1, 2)
        bounds = found.resultant_length.bounds
        held.append([np.any((lower <= turns) & (turns <= upper)), bounds[0] <= length <= bounds[1]])
    # Three standard deviations of 120 studies below the level; the whole turn of a vague direction holds more often.
    assert np.all(np.mean(held, axis=0) >= 0.82)


def test_without_a_preferred_direction_the_interval_is_a_whole_turn_and_reaches_no_length() -> None:
    found = direction_estimate(2.0 * math.pi * np.arange(120) / 120, np.arange(120) % 12)
    assert found.mean_direction.bounds[1] - found.mean_direction.bounds[0] == pytest.approx(2.0 * math.pi)
    assert found.resultant_length.bounds[0] == 0.0 < found.resultant_length.bounds[1] < 0.2


def test_one_bed_or_a_reason_gives_values_without_an_interval() -> None:
    y, bed = angles(12, 2.0, 1.0, 0)
    for found in (direction_estimate(y, np.zeros(120)), direction_estimate(y, bed, why="one impact point")):
        assert (found.mean_direction.bounds, found.resultant_length.bounds) == (None, None)
    assert direction_estimate(y, bed).resultant_length.bounds[1] > 0.5
    with pytest.raises(ValueError, match="no run has the angle"):
        direction_estimate([math.nan], [0])


@pytest.mark.parametrize("angle", [np.tile([0.0, math.pi], 60), 2.0 * math.pi * np.arange(120) / 120])
@pytest.mark.parametrize("bed", [np.arange(120) % 12, np.arange(120) // 10])
def test_a_length_of_0_is_no_proof_that_there_is_no_direction(angle: np.ndarray, bed: np.ndarray) -> None:
    lower, upper = direction_estimate(angle, bed).resultant_length.bounds
    assert lower == 0.0
    # The bound of 120 independent runs at the length that half of all such studies stay below.
    assert upper > math.sqrt(2.0 * math.log(2.0) / 240.0)
