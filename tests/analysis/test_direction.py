"""Mean direction and resultant length of an angle, with intervals from beds."""

import math

import numpy as np
import pytest
from scipy import stats

from lithobrake.analysis import direction_estimate


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
