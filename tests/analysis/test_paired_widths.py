"""Half-widths of a difference of two studies, and the beds that one asks for."""

import numpy as np
import pytest

from lithobrake.analysis import expected_half_width
from lithobrake.analysis.comparisons import difference_bounds
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
