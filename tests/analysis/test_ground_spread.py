"""Intervals of one ground, and curves against its size, of synthetic grounds whose truth is known."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from lithobrake.analysis.ground_spread import median_over_grounds, share_over_grounds
from lithobrake.analysis.smooth_curve import curve_sizes, median_curve, share_curve

Truth = tuple[np.ndarray, np.ndarray]


def by_size(chance: np.random.Generator, count: int) -> Truth:
    """Fraction at rest and median time of grounds whose size nobody knows."""
    size = chance.random(count)
    return 1.0 / (1.0 + np.exp(3.0 * size - 3.0)), 13.0 * np.exp(0.7 * size)


def of_two_kinds(chance: np.random.Generator, count: int) -> Truth:
    """The same of two kinds, seven in ten of one."""
    first = chance.random(count) < 0.7
    return np.where(first, 0.95, 0.6), np.where(first, 13.0, 25.0)


def runs(chance: np.random.Generator, truth: Truth, each: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Whether runs rest, when, and on which ground."""
    share, time = truth
    bed = np.repeat(np.arange(len(share)), each)
    rests = chance.random(len(bed)) < share[bed]
    return rests, np.where(rests, time[bed] * np.exp(0.5 * chance.normal(size=len(bed))), np.nan), bed


@pytest.mark.parametrize("draw", [by_size, of_two_kinds])
def test_intervals_hold_the_answer_on_one_more_ground(draw: Callable[[np.random.Generator, int], Truth]) -> None:
    chance, held = np.random.default_rng(3), []
    for _ in range(60):
        rests, time, bed = runs(chance, draw(chance, 12), 6)
        share, median = share_over_grounds(rests, bed), median_over_grounds(time, bed)
        p, t = draw(chance, 300)
        for value, one in ((p, share), (t, median)):
            assert one.lower is not None
            assert one.upper is not None
            assert one.lower <= one.value <= one.upper
            held.append(np.mean((value >= one.lower) & (value <= one.upper)))
    # 90 %, with 120 studies: their mean has an error of some 0.015.
    assert 0.84 < np.mean(held) < 0.96


def test_grounds_of_one_run_each_say_so() -> None:
    bed = np.arange(12)
    assert "one run" in str(median_over_grounds(np.arange(1.0, 13.0), bed).why_missing)
    assert "one run" in str(share_over_grounds(bed % 2, bed).why_missing)
    assert share_over_grounds(np.ones(12), bed).value == 1.0
    assert math.isnan(median_over_grounds(np.full(12, np.nan), bed).value)
    assert median_over_grounds(np.ones(4), np.zeros(4), why="one place").why_missing == "one place"


def test_a_curve_follows_what_changes_with_the_size() -> None:
    chance = np.random.default_rng(5)
    bed = np.repeat(np.arange(40), 25)
    size = np.geomspace(0.05, 0.8, 40)[bed]
    truth = np.log(size / 0.05) / math.log(16.0)
    met, y = chance.random(len(bed)) < truth, 10.0 * (1.0 + truth) * np.exp(0.1 * chance.normal(size=len(bed)))
    at = np.log(curve_sizes(size) / 0.05) / math.log(16.0)
    share, median = share_curve(met, size, bed, 1), median_curve(y, size, bed, 1)
    inner = slice(3, -3)
    assert np.array([one.value for one in share])[inner] == pytest.approx(at[inner], abs=0.05)
    assert np.array([one.value for one in median])[inner] == pytest.approx(10.0 * (1.0 + at[inner]), rel=0.03)
    held = [one.lower <= truth <= one.upper for one, truth in zip(share[inner], at[inner], strict=True)]  # type: ignore[operator]
    assert np.mean(held) >= 0.7
    # Not asked, and not counted.
    assert share_curve(np.where(bed < 20, met, np.nan), size, bed, 1)[2].value == pytest.approx(
        share[2].value, abs=0.02
    )
