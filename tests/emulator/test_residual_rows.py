"""Rows of scatter: chances, draws and smoothing."""

import numpy as np
from scipy import stats

from lithobrake.emulator.law import drawn_rows, row_weights, smoothed, smoothing


def test_near_rows_are_drawn_more_often() -> None:
    rows = np.array([[-1.0], [0.0], [1.0]])
    chances = row_weights(np.array([[-1.0], [1.0], [50.0]]), rows, np.ones(3), [0.5 * np.sqrt(2.0)])
    np.testing.assert_allclose(chances.sum(axis=1), 1.0)
    assert (np.diff(chances[0]) < 0.0).all()
    assert (np.diff(chances[1]) > 0.0).all()
    assert chances[2].argmax() == 2
    np.testing.assert_allclose(row_weights(rows, rows, np.array([1.0, 0.0, 3.0]), np.inf), [[0.25, 0.0, 0.75]] * 3)


def test_rows_are_drawn_by_their_chances() -> None:
    chances = np.array([[0.2, 0.0, 0.8], [0.0, 1.0, 0.0], [0.5, 0.5, 0.0]])
    row = drawn_rows(chances, 20_000, np.random.default_rng(0))
    for found, expected in zip(row, chances, strict=True):
        np.testing.assert_allclose(np.bincount(found, minlength=3) / 20_000, expected, atol=0.015)


def test_smoothing_keeps_mean_variance_correlation_and_most_of_the_skewness() -> None:
    random = np.random.default_rng(1)
    first = random.exponential(size=300)
    rows = np.column_stack([first, first + random.standard_normal(300)])
    rows = (rows - rows.mean(axis=0)) / rows.std(axis=0)
    size, root = smoothing(rows, np.ones(300))
    drawn = smoothed(rows[random.integers(300, size=200_000)], size, root, random)
    assert len(np.unique(drawn[:, 0])) == 200_000
    np.testing.assert_allclose(drawn.mean(axis=0), 0.0, atol=0.01)
    np.testing.assert_allclose(np.cov(drawn.T), np.cov(rows.T, ddof=0), atol=0.02)
    assert stats.skew(drawn[:, 0]) > 0.85 * stats.skew(rows[:, 0])
