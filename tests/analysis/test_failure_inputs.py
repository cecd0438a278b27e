"""Which inputs make failures: found where they do, and hardly ever where none does."""

import numpy as np
import pytest
from scipy import stats

from lithobrake.analysis import failure_inputs
from lithobrake.analysis.failure_probability import OrderedInput
from lithobrake.chaos import LogUniform, Uniform, sobol_sequence

INPUTS = {"friction": Uniform(0.2, 0.8), "young_modulus": LogUniform(1e6, 1e8)}
BED = np.arange(240) % 24


def test_the_input_that_makes_failures_is_found_and_the_other_not() -> None:
    x, random = sobol_sequence(INPUTS, 240, seed=2), np.random.default_rng(3)
    failing = (x[:, 0] + 0.1 * random.standard_normal(240) > 0.65).astype(float)
    found = failure_inputs(INPUTS, x, failing, BED)
    assert (found["friction"].found, found["young_modulus"].found) == (True, False)
    grid = np.linspace(0.2, 0.8, 10_001)
    chance = stats.norm.cdf((grid - 0.65) / 0.1)
    among_failing = np.cumsum(chance) / chance.sum()
    exact = np.max(np.abs(among_failing - INPUTS["friction"].cdf(grid)))
    # About seventy runs fail: their distribution function is within 0.1 of its law in nine of ten studies.
    assert found["friction"].distance.value == pytest.approx(exact, abs=0.1)
    assert found["friction"].distance.lower < exact < found["friction"].distance.upper
    assert found["friction"].median == pytest.approx(grid[np.searchsorted(among_failing, 0.5)], abs=0.03)
    assert found["friction"].median_of_all == pytest.approx(0.5)
    assert found["young_modulus"].median_of_all == pytest.approx(1e7)


def test_the_distance_is_kolmogorovs() -> None:
    values = np.random.default_rng(4).beta(2.0, 2.0, 50)
    column = OrderedInput.of(Uniform(0.0, 1.0), values)
    expected = stats.ks_1samp(values, stats.uniform().cdf).statistic
    assert column.distance(np.ones((1, 50)))[0] == pytest.approx(expected, rel=1e-12)


def test_where_no_input_does_anything_nine_of_ten_studies_find_none() -> None:
    studies = []
    for seed in range(60):
        x, random = sobol_sequence(INPUTS, 120, seed=seed), np.random.default_rng(seed)
        failing = (random.random(120) < 0.15).astype(float)
        studies.append(any(one.found for one in failure_inputs(INPUTS, x, failing, np.arange(120) % 12).values()))
    # Six are expected; a binomial number of sixty is above 12 once in two hundred times.
    assert np.sum(studies) <= 12


def test_runs_of_which_nobody_knows_and_studies_without_failure_say_nothing() -> None:
    x = sobol_sequence(INPUTS, 240, seed=2)
    failing = np.where(x[:, 0] > 0.7, 1.0, 0.0)
    unknown = np.where(np.arange(240) < 40, np.nan, failing)
    alone = failure_inputs(INPUTS, x[40:], failing[40:], BED[40:])
    assert failure_inputs(INPUTS, x, unknown, BED)["friction"].distance.value == alone["friction"].distance.value
    assert failure_inputs(INPUTS, x, np.zeros(240), BED) == {}
