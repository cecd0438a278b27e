"""Dependent inputs: margins and correlations as asked, moments of known cases, refused correlations."""

import numpy as np
import pytest
from scipy import stats

from lithobrake.chaos import Gamma, GaussianCopula, LogUniform, Normal, Uniform, fit

INPUTS = {"modulus": LogUniform(1e6, 1e8), "friction": Uniform(0.2, 0.9), "speed": Gamma(2.0, 0.1)}
# That of a normal correlation of 0.5. Source: [Kruskal-1958].
RANK_OF_HALF = 6.0 / np.pi * np.arcsin(0.5 / 2.0)
RANKS = np.array([[1.0, 0.6, 0.0], [0.6, 1.0, -0.3], [0.0, -0.3, 1.0]])


def test_samples_have_the_margins_and_rank_correlations():
    x = GaussianCopula(INPUTS, RANKS).sobol_sequence(8192, seed=1)
    assert np.allclose(stats.spearmanr(x).statistic, RANKS, atol=0.02)
    for k, entry in enumerate(INPUTS.values()):
        assert np.quantile(x[:, k], 0.3) == pytest.approx(float(entry.ppf(0.3)), rel=0.01)


def test_moments_under_dependent_inputs_are_those_of_values_at_dependent_points():
    normals = {"a": Normal(1.0, 2.0), "b": Normal(0.0, 1.0)}
    copula = GaussianCopula(normals, [[1.0, RANK_OF_HALF], [RANK_OF_HALF, 1.0]])
    x = copula.sobol_sequence(40)
    surrogate = fit(normals, x, x[:, 0] * x[:, 1], degree=2)
    values = surrogate(copula.sobol_sequence(2**15, seed=1))
    # E[ab] = cov = 1; Var[ab] = mean_a**2 var_b + var_a var_b + cov**2. A Sobol sequence errs by a few parts in 1e4.
    assert values.mean() == pytest.approx(1.0, rel=2e-3)
    assert values.var() == pytest.approx(1.0 + 4.0 + 1.0, rel=5e-3)
    uniforms = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}
    copula = GaussianCopula(uniforms, [[1.0, 0.6], [0.6, 1.0]])
    x = copula.sobol_sequence(300)
    product = fit(uniforms, x, x[:, 0] * x[:, 1])
    # Spearman's correlation is that of the probabilities: E[ab] = 1/4 + 0.6/12.
    assert product(copula.sobol_sequence(2**15, seed=1)).mean() == pytest.approx(0.3, abs=1e-4)


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
