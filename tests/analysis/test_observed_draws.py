"""Draws weighted by an observed run, beside posteriors in closed form."""

import math

import numpy as np
import pytest

from lithobrake.analysis.observed_draws import FEWEST, ObservedDraws, observed_draws, weighted_quantiles

COUNT = 100_000


@pytest.fixture(scope="module")
def cause() -> np.ndarray:
    return np.random.default_rng(1).standard_normal(COUNT)


@pytest.fixture(scope="module")
def effect(cause: np.ndarray) -> np.ndarray:
    """A number about 5 with the cause and a scatter of 0.5 in it."""
    return 5.0 + cause + 0.5 * np.random.default_rng(2).standard_normal(COUNT)


def weighed(effect: np.ndarray, seen: float, error: float = 0.0, source: np.ndarray | None = None) -> ObservedDraws:
    own = np.arange(COUNT) if source is None else source
    return observed_draws({"y": effect}, {"y": seen}, {"y": error}, np.full(COUNT, True), own)


@pytest.mark.parametrize("error", [0.0, 0.7])
def test_the_posterior_of_a_normal_law_is_the_known_one(cause: np.ndarray, effect: np.ndarray, error: float) -> None:
    variance = 1.0 + 0.25 + error**2
    found = weighed(effect, 6.0, error)
    lower, middle, upper = found.quantiles(cause, [0.05, 0.5, 0.95])
    deviation = math.sqrt(1.0 - 1.0 / variance)
    assert middle == pytest.approx(1.0 / variance, abs=0.05)
    assert (upper - lower) / 3.29 == pytest.approx(deviation, rel=0.05)
    assert found.is_reliable
    assert found.weights.sum() == pytest.approx(1.0)


def test_most_draws_are_as_unlikely_as_the_middle_and_few_as_the_tail(effect: np.ndarray) -> None:
    """The share of a normal law beyond one and beyond two of its deviations is 0.317 and 0.046."""
    deviation = math.sqrt(1.25)
    assert weighed(effect, 5.0).p_value > 0.8
    assert weighed(effect, 5.0 + deviation).p_value == pytest.approx(0.317, abs=0.06)
    assert weighed(effect, 5.0 + 2.0 * deviation).p_value == pytest.approx(0.046, abs=0.03)


def test_what_lies_outside_of_all_draws_has_no_interval(effect: np.ndarray) -> None:
    found = weighed(effect, 50.0)
    assert found.p_value == 0.0
    assert not found.is_reliable


def test_draws_of_one_source_count_as_one(effect: np.ndarray) -> None:
    found = weighed(effect, 5.0, source=np.arange(COUNT) % 20)
    assert found.effective_count <= 20.0 < FEWEST
    assert not found.is_reliable


def test_an_outcome_alone_weighs_all_that_ended_so(cause: np.ndarray) -> None:
    found = observed_draws({}, {}, {}, cause > 1.0, np.arange(COUNT))
    assert found.p_value is None
    assert found.quantiles(cause, [0.5])[0] == pytest.approx(1.41, abs=0.02)


def test_taken_draws_are_as_often_as_their_weights(cause: np.ndarray, effect: np.ndarray) -> None:
    found = weighed(effect, 6.0)
    assert cause[found.taken(2000, 1)].mean() == pytest.approx(found.weights @ cause, abs=0.03)


def test_quantiles_leave_out_what_is_not_known() -> None:
    values, weights = np.array([1.0, np.nan, 3.0, 2.0]), np.array([0.25, 0.25, 0.0, 0.5])
    assert weighted_quantiles(values, weights, [0.0, 1.0]) == [1.0, 2.0]
    assert math.isnan(weighted_quantiles(np.array([np.nan]), np.ones(1), [0.5])[0])


def test_what_no_draw_can_be_is_refused(effect: np.ndarray) -> None:
    every, own = np.full(COUNT, True), np.arange(COUNT)
    with pytest.raises(ValueError, match=r"z is observed, which no draw has; allowed: y"):
        observed_draws({"y": effect}, {"z": 1.0}, {}, every, own)
    with pytest.raises(ValueError, match=r"the error of y is -1\.0, but must be a finite number of at least 0"):
        weighed(effect, 5.0, -1.0)
    with pytest.raises(ValueError, match=r"none of 100000 draws ended as the observed run did"):
        observed_draws({"y": effect}, {"y": 5.0}, {}, ~every, own)
    with pytest.raises(ValueError, match=r"1 of 100000 draws ended as the observed run did; allowed: at least 5"):
        observed_draws({"y": effect}, {"y": 5.0}, {}, own == 3, own)


def test_an_output_that_varies_by_rounding_weighs_nothing(cause: np.ndarray, effect: np.ndarray) -> None:
    """0.1 + 0.2 is another number than 0.3; seen is what all draws have."""
    alike = np.where(cause > 0.0, 0.1 + 0.2, 0.3)
    every, own = np.full(COUNT, True), np.arange(COUNT)
    both = observed_draws({"y": effect, "z": alike}, {"y": 6.0, "z": 0.3}, {"y": 0.5}, every, own)
    assert np.allclose(both.weights, weighed(effect, 6.0, 0.5).weights)
