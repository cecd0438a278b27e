"""Scores against closed forms and against another library."""

import math
from types import ModuleType

import numpy as np
import pytest

from lithobrake.scoring.proper_scores import crps, energy_score, log_score, probability_below


def test_one_value_is_scored_by_its_distance() -> None:
    assert crps([3.0], 5.0).of() == 2.0
    assert energy_score([[1.0, 2.0, 2.0]], [0.0, 0.0, 0.0]).of() == 3.0


def test_an_error_makes_a_normal_law_of_one_value(scoringrules: ModuleType) -> None:
    """The CRPS of a normal law at its mean is (sqrt 2 - 1) / sqrt pi of its standard deviation [Gneiting-2007]."""
    assert crps([2.0], 2.0, 0.5).of() == pytest.approx(0.5 * (math.sqrt(2.0) - 1.0) / math.sqrt(math.pi), rel=1e-12)
    assert crps([1.0], 2.5, 0.5).of() == pytest.approx(float(scoringrules.crps_normal(2.5, 1.0, 0.5)), rel=1e-9)


def test_samples_have_the_score_of_another_library(scoringrules: ModuleType) -> None:
    values = np.random.default_rng(1).gamma(2.0, 3.0, 200)
    for observed in (0.5, 6.0, 30.0):
        found = float(scoringrules.crps_ensemble(observed, values, estimator="fair"))
        assert crps(values, observed).of() == pytest.approx(found, rel=1e-9)
    places = np.random.default_rng(2).normal(0.0, [1.0, 2.0, 3.0], (150, 3))
    found = float(scoringrules.es_ensemble(np.array([1.0, 1.0, -4.0]), places, estimator="fair"))
    assert energy_score(places, [1.0, 1.0, -4.0]).of() == pytest.approx(found, rel=1e-9)


def test_weights_count_in_both_means() -> None:
    """Of values 1, 4, 9 with weights 1, 2, 3: to 5 in the mean 3; of two different ones 106 / 22."""
    apart = 2.0 * (2.0 * 3.0 + 3.0 * 8.0 + 6.0 * 5.0) / (36.0 - 14.0)
    expected = (4.0 + 2.0 + 12.0) / 6.0 - 0.5 * apart
    assert crps([1.0, 4.0, 9.0], 5.0).of([1.0, 2.0, 3.0]) == pytest.approx(expected, rel=1e-12)
    places = np.outer([1.0, 4.0, 9.0], [0.0, 0.6, 0.8])
    assert energy_score(places, [0.0, 3.0, 4.0]).of([1.0, 2.0, 3.0]) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("count", [4, 12, 60])
def test_the_score_of_a_small_sample_is_in_the_mean_that_of_its_distribution(
    scoringrules: ModuleType, count: int
) -> None:
    """Of a standard normal law at 0.3: [Gneiting-2007], Equation 5 in closed form."""
    generator = np.random.default_rng(count)
    found = [crps(generator.normal(size=count), 0.3).of() for _ in range(3000)]
    truth = float(scoringrules.crps_normal(0.3, 0.0, 1.0))
    assert np.mean(found) == pytest.approx(truth, abs=3.0 * float(np.std(found)) / math.sqrt(3000))


def test_an_error_of_a_place_scores_as_a_cloud_of_it() -> None:
    """One place with its error, at that place: the energy score of a normal law in three dimensions at its mean.

    Mean length of a normal vector: 2 sqrt(2 / pi) of its deviation; between two of them sqrt 2 times as much.
    """
    mean = 2.0 * math.sqrt(2.0 / math.pi) * 0.7
    assert energy_score([[5.0, 5.0, 5.0]], [5.0, 5.0, 5.0], 0.7).of() == pytest.approx(
        mean * (1.0 - math.sqrt(0.5)), rel=0.1
    )


@pytest.mark.parametrize("score", ["crps", "energy", "logarithmic"])
def test_the_truth_has_the_best_mean_score(score: str) -> None:
    """Against predictions that are shifted, too narrow and too wide; the observation has an error."""
    generator = np.random.default_rng(3)
    truth, error = generator.normal(0.0, 1.0, (300, 3)), 0.5
    observed = truth[:, :1] + generator.normal(0.0, error, (300, 1))
    sample = generator.normal(0.0, 1.0, (150, 3))

    def mean(shift: float, scale: float) -> float:
        values = shift + scale * sample
        if score == "logarithmic":
            share = (values[:, 0] > 0.5).mean()
            hits = np.arange(1000) < 1000 * share
            return float(np.mean([log_score(hits if one > 0.5 else ~hits, 2) for one in truth[:, 0]]))
        if score == "crps":
            return float(np.mean([crps(values[:, 0], one, error).of() for one in observed[:50, 0]]))
        return float(np.mean([energy_score(values, one).of() for one in truth[:50]]))

    best = mean(0.0, 1.0)
    for shift, scale in ((1.0, 1.0), (0.0, 0.3), (0.0, 3.0)):
        if score == "logarithmic" and shift == 0.0 and scale == 3.0:
            continue
        assert mean(shift, scale) > best


def test_what_no_sample_shows_is_not_impossible() -> None:
    assert log_score(np.zeros(9), 2) == pytest.approx(-math.log2(0.5 / 10.0))
    # Half of the weight lies on one landing, so 10 landings count as the effective number of them.
    weights = np.array([9.0, *np.ones(9)])
    effective = 18.0**2 / (81.0 + 9.0)
    expected = -math.log2((effective * 0.5 + 0.5) / (effective + 2.0))
    assert log_score(np.arange(10) == 0, 4, weights) == pytest.approx(expected)


def test_the_place_of_an_observation_counts_ties_half() -> None:
    assert probability_below([1.0, 2.0, 3.0, 4.0], 2.0, 0.0, np.ones(4)) == 0.375
    assert probability_below([1.0, 3.0], 2.0, 1.0, np.ones(2)) == pytest.approx(0.5)
