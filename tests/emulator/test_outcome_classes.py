"""Chances of outcomes, rare and never met."""

import numpy as np
import pytest
from scipy import special

from lithobrake.emulator.outcome_classes import INVERSE_PENALTIES, best_inverse_penalty, fit_classes

COUNT = 300


def test_an_outcome_that_never_was_has_half_an_event() -> None:
    linear = np.random.default_rng(0).standard_normal((COUNT, 2))
    classes = fit_classes(linear, np.zeros(COUNT, dtype=int), 2, INVERSE_PENALTIES[0], np.ones(COUNT))
    np.testing.assert_allclose(classes.chances(linear)[:, 1], 0.5 / (COUNT + 1))
    np.testing.assert_allclose(classes.chances(linear).sum(axis=1), 1.0)


@pytest.mark.parametrize("class_count", [2, 3, 4])
def test_chances_sum_to_one_and_are_near_the_shares(class_count: int) -> None:
    random = np.random.default_rng(1)
    linear = random.standard_normal((COUNT, 3))
    outcome = np.minimum(random.integers(0, 20, COUNT), min(class_count, 3) - 1)
    classes = fit_classes(linear, outcome, class_count, INVERSE_PENALTIES[0], np.ones(COUNT))
    chances = classes.chances(linear)
    np.testing.assert_allclose(chances.sum(axis=1), 1.0)
    assert (chances > 0.0).all()
    # Half an event for each class that was met, and for one that was not.
    counts = np.bincount(outcome, minlength=class_count)
    met, never = counts > 0, (counts == 0).sum() * 0.5 / (COUNT + 1.0)
    expected = np.where(met, (1.0 - never) * (counts + 0.5) / (COUNT + 0.5 * met.sum()), 0.5 / (COUNT + 1.0))
    np.testing.assert_allclose(chances.mean(axis=0), expected, rtol=1e-3)


def test_a_slope_is_followed_and_noise_is_not() -> None:
    random = np.random.default_rng(2)
    linear = random.standard_normal((COUNT, 2))
    fold = np.arange(COUNT) % 5
    steep = (random.random(COUNT) < special.expit(-1.0 + 1.5 * linear[:, 0])).astype(int)
    penalty = best_inverse_penalty(linear, steep, 2, fold)
    classes = fit_classes(linear, steep, 2, penalty, np.ones(COUNT))
    low, high = classes.chances(np.array([[-1.5, 0.0], [1.5, 0.0]]))[:, 1]
    assert low < 0.15 < 0.55 < high
    flat = (random.random(COUNT) < 0.04).astype(int)
    loose = fit_classes(linear, flat, 2, best_inverse_penalty(linear, flat, 2, fold), np.ones(COUNT))
    assert np.abs(loose.chances(linear)[:, 1] - 0.04).mean() < 0.02
