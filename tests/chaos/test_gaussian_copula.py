"""Dependent inputs: correlations as asked, round trip, moments of a known case, and refused indices."""

import numpy as np
import pytest
from scipy import stats

from lithobrake.chaos import (
    Beta,
    Empirical,
    Exponential,
    Gamma,
    GaussianCopula,
    LogNormal,
    LogUniform,
    Normal,
    TruncatedNormal,
    Uniform,
    fit_dependent,
    load,
    load_dependent,
)

INPUTS = {"modulus": LogUniform(1e6, 1e8), "friction": Uniform(0.2, 0.9), "speed": Gamma(2.0, 0.1)}
RANKS = np.array([[1.0, 0.6, 0.0], [0.6, 1.0, -0.3], [0.0, -0.3, 1.0]])


def test_samples_have_the_margins_and_rank_correlations():
    x = GaussianCopula(INPUTS, RANKS).sobol_sequence(8192, seed=1)
    assert np.allclose(stats.spearmanr(x).statistic, RANKS, atol=0.02)
    for k, entry in enumerate(INPUTS.values()):
        assert np.quantile(x[:, k], 0.3) == pytest.approx(float(entry.ppf(0.3)), rel=0.01)


def test_germs_and_back():
    copula = GaussianCopula(INPUTS, RANKS)
    x = copula.sobol_sequence(100)
    assert np.allclose(copula.physical(copula.germs(x)), x, rtol=1e-9)


def test_moments_of_correlated_normals(tmp_path):
    inputs = {"a": Normal(1.0, 2.0), "b": Normal(0.0, 1.0)}
    rank = 6.0 / np.pi * np.arcsin(0.5 / 2.0)
    x = GaussianCopula(inputs, [[1.0, rank], [rank, 1.0]]).sobol_sequence(40)
    surrogate = fit_dependent(inputs, [[1.0, rank], [rank, 1.0]], x, x[:, 0] * x[:, 1], degree=2)
    # Linear correlation 0.5: E[ab] = cov = 1; Var[ab] = mean_a**2 var_b + var_a var_b + cov**2.
    assert surrogate.mean == pytest.approx(1.0, rel=1e-9)
    assert surrogate.variance == pytest.approx(1.0 + 4.0 + 1.0, rel=1e-9)
    assert np.allclose(surrogate(x), x[:, 0] * x[:, 1])
    with pytest.raises(ValueError, match="dependent"):
        _ = surrogate.sobol_first
    assert surrogate.independent.sobol_total.shape == (2,)
    surrogate.save(tmp_path / "model.json")
    assert np.array_equal(load_dependent(tmp_path / "model.json")(x), surrogate(x))
    with pytest.raises(ValueError, match="is not a"):
        load(tmp_path / "model.json")


def test_moments_of_margins_that_are_not_normal():
    uniforms = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}
    x = GaussianCopula(uniforms, [[1.0, 0.6], [0.6, 1.0]]).sobol_sequence(300)
    # Spearman's correlation is that of the probabilities: E[ab] = 1/4 + 0.6/12.
    product = fit_dependent(uniforms, [[1.0, 0.6], [0.6, 1.0]], x, x[:, 0] * x[:, 1])
    assert product.mean == pytest.approx(0.3, abs=1e-5)
    logs = {"a": LogNormal(0.1, 0.3), "b": LogNormal(-0.2, 0.2)}
    rank = 6.0 / np.pi * np.arcsin(-0.5 / 2.0)
    x = GaussianCopula(logs, [[1.0, rank], [rank, 1.0]]).sobol_sequence(300)
    product = fit_dependent(logs, [[1.0, rank], [rank, 1.0]], x, x[:, 0] * x[:, 1], degree=9)
    # A product of log-normals of normal correlation -0.5 is log-normal.
    mean, variance = -0.1, 0.3**2 + 0.2**2 - 0.3 * 0.2
    assert product.mean == pytest.approx(np.exp(mean + 0.5 * variance), rel=1e-9)
    # Powers beyond the ninth hold a billionth of its variance.
    assert product.variance == pytest.approx(np.expm1(variance) * np.exp(2.0 * mean + variance), rel=1e-8)


@pytest.mark.parametrize(
    "matrix",
    [
        np.eye(2),
        [[1, 0.5, 0], [0.4, 1, 0], [0, 0, 1]],
        2.0 * np.eye(3),
        [[1, 0.9, -0.9], [0.9, 1, 0.9], [-0.9, 0.9, 1]],
    ],
)
def test_impossible_correlations_are_refused(matrix):
    with pytest.raises(ValueError, match="rank_correlation"):
        GaussianCopula(INPUTS, matrix)


@pytest.mark.parametrize(
    "entry",
    [
        Uniform(1.0, 2.0),
        LogUniform(1.0, 100.0),
        Normal(1.0, 2.0),
        LogNormal(0.0, 1.0),
        TruncatedNormal(0.0, 1.0, -1.0, 3.0),
        TruncatedNormal(0.0, 1.0, 6.0, 9.0),
        TruncatedNormal(0.0, 1.0, -np.inf, 1.0),
        TruncatedNormal(0.0, 1.0, -1.0, np.inf),
        TruncatedNormal(0.0, 1.0, -9.0, -7.0),
        Beta(2.0, 3.0, -1.0, 1.0),
        Gamma(2.0, 3.0),
        Exponential(2.0),
    ],
    ids=lambda entry: f"{entry.kind} {entry.support}",
)
def test_probability_of_a_quantile_is_the_probability(entry):
    u = np.array([0.001, 0.2, 0.5, 0.9, 0.999])
    assert np.allclose(entry.cdf(entry.ppf(u)), u, rtol=1e-9)


def test_probability_of_samples_is_their_rank():
    assert Empirical([1.0, 2.0, 3.0, 4.0]).cdf(np.array([1.0, 4.0])).tolist() == [0.125, 0.875]
