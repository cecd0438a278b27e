"""Half-widths of a difference of two studies, and the beds that one asks for."""

import math

import numpy as np
import pytest
from scipy.special import ndtri

from lithobrake.analysis import expected_half_width, share_difference
from lithobrake.analysis.paired_difference import difference_bounds
from lithobrake.analysis.paired_widths import beds_for_half_width, difference_half_width, half_width_on
from lithobrake.vocabulary.estimate import Estimate


@pytest.mark.parametrize("correlation", [-0.5, 0.0, 0.3, 1.0])
def test_the_half_width_is_that_of_the_bounds_of_a_comparison(correlation: float) -> None:
    one, two = Estimate(0.5, 0.4, 0.6), Estimate(0.6, 0.52, 0.68)
    lower, upper = difference_bounds(one, two, correlation) or (np.nan, np.nan)
    assert difference_half_width(0.1, 0.08, correlation) == pytest.approx(0.5 * (upper - lower))


def test_more_beds_narrow_it_as_those_of_one_study() -> None:
    few, many = (expected_half_width(4 * beds, beds) for beds in (6, 30))
    assert few is not None
    assert half_width_on(few, 6, 30) == pytest.approx(many)
    assert half_width_on(few, 6, 6) == few


@pytest.mark.parametrize("asked", [0.2, 0.05, 0.011])
def test_the_beds_asked_for_are_the_fewest(asked: float) -> None:
    beds = beds_for_half_width(0.1, 12, asked)
    assert half_width_on(0.1, 12, beds) <= asked
    assert beds == 2 or half_width_on(0.1, 12, beds - 1) > asked


@pytest.mark.parametrize(("chance", "other"), [(0.5, 0.6), (0.9, 0.8)])
def test_what_pairs_gain_follows_from_their_correlation(chance: float, other: float) -> None:
    """Of synthetic pairs on beds that explain 7 % of the variance."""
    random, bed = np.random.default_rng(3), np.arange(96) % 24
    made, expected = [], []
    for _ in range(30):
        common = random.standard_normal(24)[bed] * math.sqrt(0.07) + random.standard_normal(96) * math.sqrt(0.93)
        one, two = (0.95 * common + math.sqrt(1.0 - 0.95**2) * random.standard_normal(96) for _ in range(2))
        found = share_difference(one < ndtri(chance), two < ndtri(other), bed)
        lower, upper = found.unpaired or (math.nan, math.nan)
        made.append(found.difference.half_width)
        expected.append(0.5 * (upper - lower) * math.sqrt(1.0 - (found.correlation or 0.0)))
    assert np.mean(made) == pytest.approx(np.mean(expected), rel=0.1)


@pytest.mark.parametrize(("call", "said"), [
    (lambda: difference_half_width(-0.1, 0.1, 0.0), "first"),
    (lambda: difference_half_width(0.1, 0.1, 1.1), "correlation"),
    (lambda: difference_half_width(0.1, float("nan"), 0.1), "second"),
    (lambda: half_width_on(0.1, 1, 4), "bed_count"),
    (lambda: half_width_on(0.1, 4, 1), "beds"),
    (lambda: beds_for_half_width(0.1, 4, 0.0), "asked"),
    (lambda: beds_for_half_width(float("inf"), 4, 0.1), "half_width"),
])  # fmt: skip
def test_numbers_that_cannot_be_are_refused(call: object, said: str) -> None:
    assert callable(call)
    with pytest.raises(ValueError, match=said):
        call()
