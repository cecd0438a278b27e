"""Chances of outcomes, rare and never met."""

import numpy as np
import pytest
from scipy import special

from lithobrake.chaos import Uniform, sobol_sequence
from lithobrake.emulator.law import INVERSE_PENALTIES, OutcomeClasses, best_class_choice, fit_classes
from lithobrake.emulator.mean_law import candidate_terms

COUNT = 300


def test_an_outcome_that_never_was_has_half_an_event() -> None:
    linear = np.random.default_rng(0).standard_normal((COUNT, 2))
    classes = fit_classes(linear, np.ones(2), np.zeros(COUNT, dtype=int), 2, INVERSE_PENALTIES[0], np.ones(COUNT))
    np.testing.assert_allclose(classes.chances(linear)[:, 1], 0.5 / (COUNT + 1))
    np.testing.assert_allclose(classes.chances(linear).sum(axis=1), 1.0)


@pytest.mark.parametrize("class_count", [2, 3, 4])
def test_chances_sum_to_one_and_are_near_the_shares(class_count: int) -> None:
    random = np.random.default_rng(1)
    linear = random.standard_normal((COUNT, 3))
    outcome = np.minimum(random.integers(0, 20, COUNT), min(class_count, 3) - 1)
    classes = fit_classes(linear, np.ones(3), outcome, class_count, INVERSE_PENALTIES[0], np.ones(COUNT))
    chances = classes.chances(linear)
    np.testing.assert_allclose(chances.sum(axis=1), 1.0)
    assert (chances > 0.0).all()
    # Half an event for each class that was met, and for one that was not.
    counts = np.bincount(outcome, minlength=class_count)
    met, never = counts > 0, (counts == 0).sum() * 0.5 / (COUNT + 1.0)
    expected = np.where(met, (1.0 - never) * (counts + 0.5) / (COUNT + 0.5 * met.sum()), 0.5 / (COUNT + 1.0))
    np.testing.assert_allclose(chances.mean(axis=0), expected, rtol=1e-3)


def fitted(matrix: np.ndarray, outcome: np.ndarray, indices: np.ndarray) -> OutcomeClasses:
    """Chances with what groups left out have chosen; outputs come with the outcome 0."""
    choice = best_class_choice(indices, matrix, outcome, 0, 2, np.arange(COUNT) % 5)
    return fit_classes(matrix, choice.factors(indices), outcome, 2, choice.inverse_penalty, np.ones(COUNT))


def test_a_slope_is_followed_and_noise_is_not() -> None:
    random = np.random.default_rng(2)
    linear, indices = random.standard_normal((COUNT, 2)), np.eye(2, dtype=int)
    steep = (random.random(COUNT) < special.expit(-1.0 + 1.5 * linear[:, 0])).astype(int)
    low, high = fitted(linear, steep, indices).chances(np.array([[-1.5, 0.0], [1.5, 0.0]]))[:, 1]
    assert low < 0.15 < 0.55 < high
    flat = (random.random(COUNT) < 0.04).astype(int)
    assert np.abs(fitted(linear, flat, indices).chances(linear)[:, 1] - 0.04).mean() < 0.02


def test_a_ring_is_followed() -> None:
    """What lies in a ring about the middle is captured: a linear logit is off by 0.46, as a constant is."""
    inputs = {"a": Uniform(-1.0, 1.0), "b": Uniform(-1.0, 1.0), "c": Uniform(-1.0, 1.0)}
    terms, fresh = candidate_terms(inputs), sobol_sequence(inputs, 500, seed=4)
    x = sobol_sequence(inputs, COUNT, seed=3)
    captured = (np.abs(np.hypot(x[:, 0], x[:, 1]) - 0.6) < 0.2).astype(int)
    chances = fitted(terms.matrix(x), captured, terms.indices).chances(terms.matrix(fresh))[:, 1]
    truth = np.abs(np.hypot(fresh[:, 0], fresh[:, 1]) - 0.6) < 0.2
    assert np.sqrt(np.mean((chances - truth) ** 2)) < 0.25
