"""Intervals of shares."""

import numpy as np
import pytest

from lithobrake.analysis import wilson_interval


@pytest.mark.parametrize(("count", "total", "lower", "upper"), [
    # Newcombe 1998, Statistics in Medicine 17, 857, table I, method 3.
    (81, 263, 0.2553, 0.3662),
    (15, 148, 0.0624, 0.1605),
    (0, 20, 0.0, 0.1611),
    (1, 29, 0.0061, 0.1718),
])  # fmt: skip
def test_published_intervals(count: int, total: int, lower: float, upper: float) -> None:
    assert wilson_interval(count, total) == pytest.approx((lower, upper), abs=5e-5)


def test_interval_of_none_and_of_all() -> None:
    assert wilson_interval(0, 10)[0] == 0.0
    assert wilson_interval(10, 10)[1] == 1.0


def test_it_covers_the_truth_as_often_as_it_says() -> None:
    counts = np.random.default_rng(1).binomial(200, 0.3, size=2000)
    ends = [wilson_interval(int(count), 200) for count in counts]
    assert np.mean([low <= 0.3 <= high for low, high in ends]) == pytest.approx(0.95, abs=0.02)


def test_impossible_counts_are_refused() -> None:
    for count, total in ((1, 0), (-1, 5), (6, 5), (1.5, 2), (1, float("nan"))):
        with pytest.raises(ValueError, match=r"(count|total) is .* whole number"):
            wilson_interval(count, total)  # type: ignore[arg-type]
    for quantile in (-5.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match=r"quantile is .* of at least 0 and of at most 40"):
            wilson_interval(1, 2, quantile)
