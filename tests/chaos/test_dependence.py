"""Inputs that depend on each other: their copula, Shapley effects against closed forms, and the word at a fit."""

import warnings

import numpy as np
import pytest
from scipy import stats

from lithobrake.chaos import (
    Gamma,
    GaussianCopula,
    LogUniform,
    Normal,
    Uniform,
    fit,
    latin_hypercube,
    shapley_effects,
    sobol_sequence,
    tensor_grid,
)

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
    with pytest.warns(UserWarning, match="a and b depend on each other"):
        surrogate = fit(normals, x, x[:, 0] * x[:, 1], degree=2)
    values = surrogate(copula.sobol_sequence(2**15, seed=1))
    # E[ab] = cov = 1; Var[ab] = mean_a**2 var_b + var_a var_b + cov**2. A Sobol sequence errs by a few parts in 1e4.
    assert values.mean() == pytest.approx(1.0, rel=2e-3)
    assert values.var() == pytest.approx(1.0 + 4.0 + 1.0, rel=5e-3)
    uniforms = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}
    copula = GaussianCopula(uniforms, [[1.0, 0.6], [0.6, 1.0]])
    x = copula.sobol_sequence(300)
    with pytest.warns(UserWarning, match="a and b depend on each other"):
        product = fit(uniforms, x, x[:, 0] * x[:, 1])
    # Spearman's correlation is that of the probabilities: E[ab] = 1/4 + 0.6/12.
    assert product(copula.sobol_sequence(2**15, seed=1)).mean() == pytest.approx(0.3, abs=1e-4)


@pytest.mark.parametrize("matrix", [
    np.eye(2),
    [[1, 0.5, 0], [0.4, 1, 0], [0, 0, 1]],
    2.0 * np.eye(3),
    [[1, 0.9, -0.9], [0.9, 1, 0.9], [-0.9, 0.9, 1]],
])  # fmt: skip
def test_impossible_correlations_are_refused(matrix):
    with pytest.raises(ValueError, match="rank_correlation"):
        GaussianCopula(INPUTS, matrix)


def rank_of(normal: float) -> float:
    """Spearman's correlation of two normals of this correlation. Source: [Kruskal-1958]."""
    return 6.0 / np.pi * np.arcsin(normal / 2.0)


WEIGHTS, STDS, TOGETHER = (1.0, -2.0, 0.5), (1.0, 0.7, 3.0), 0.6


def linear():
    """An expansion of 1 a - 2 b + 0.5 c of three normals, of which a and b have the correlation 0.6."""
    inputs = {name: Normal(0.0, std) for name, std in zip("abc", STDS, strict=True)}
    ranks = np.eye(3)
    ranks[0, 1] = ranks[1, 0] = rank_of(TOGETHER)
    x = sobol_sequence(inputs, 60)
    return fit(inputs, x, x @ WEIGHTS, degree=1), GaussianCopula(inputs, ranks)


def linear_truth() -> np.ndarray:
    """Source: [Iooss-2019]: shares of two correlated normals and of an independent one."""
    first, second, third = (weight * std for weight, std in zip(WEIGHTS, STDS, strict=True))
    cross, square = TOGETHER * first * second, 0.5 * TOGETHER**2
    parts = [
        first**2 * (1.0 - square) + cross + second**2 * square,
        second**2 * (1.0 - square) + cross + first**2 * square,
        third**2,
    ]
    return np.array(parts) / sum(parts)


def test_shapley_effects_of_correlated_normals_are_the_closed_form() -> None:
    found = shapley_effects(*linear())
    assert found.names == ["a", "b", "c"]
    assert found.share.sum() == pytest.approx(1.0, abs=1e-12)
    assert np.abs((found.share - linear_truth()) / found.error).max() < 3.5
    assert found.error.max() < 0.02


def test_their_error_is_the_scatter_between_seeds() -> None:
    surrogate, copula = linear()
    found = [shapley_effects(surrogate, copula, count=400, seed=seed) for seed in range(100)]
    scores = np.array([(one.share - linear_truth()) / one.error for one in found])
    # Of 100 scores the standard deviation errs by 7 %, and by a little more as errors are estimated too.
    assert scores.std(axis=0) == pytest.approx(np.ones(3), abs=0.25)
    assert np.abs(scores.mean(axis=0)).max() < 0.4


def test_inputs_of_one_covariance_count_as_one() -> None:
    surrogate, copula = linear()
    found = shapley_effects(surrogate, copula, groups={"release": ["a", "b"]})
    truth = linear_truth()
    assert found.names == ["release", "c"]
    assert found.share == pytest.approx([truth[0] + truth[1], truth[2]], abs=3.5 * found.error.max())


def test_independent_inputs_share_their_products_and_each_output_has_its_own() -> None:
    """Var[xy] of centred uniforms is in the product alone; a constant output has no shares."""
    inputs = {"x": Uniform(-1.0, 1.0), "y": Uniform(-1.0, 1.0)}
    x = sobol_sequence(inputs, 40)
    outputs = np.column_stack([x[:, 0] * x[:, 1], x[:, 0] + 2.0 * x[:, 1], np.ones(40)])
    surrogate = fit(inputs, x, outputs, degree=2)
    found = shapley_effects(surrogate, GaussianCopula(inputs, np.eye(2)), seed=3)
    assert found.share.shape == (2, 3)
    assert np.abs(found.share[:, :2] - [[0.5, 0.2], [0.5, 0.8]]).max() < 0.02
    assert (found.share[:, 2] == 0.0).all()
    assert (found.error[:, 2] == 0.0).all()


@pytest.mark.parametrize("groups", [{"g": ["a"], "h": ["a"]}, {"g": []}, {"c": ["a", "b"]}])
def test_groups_that_are_none_are_refused(groups) -> None:
    with pytest.raises(ValueError, match="groups must have names and inputs of their own"):
        shapley_effects(*linear(), groups=groups)


def test_other_inputs_and_too_many_are_refused() -> None:
    surrogate, copula = linear()
    with pytest.raises(ValueError, match="the copula has the inputs modulus, friction, speed: give it those of the"):
        shapley_effects(surrogate, GaussianCopula(INPUTS, RANKS))
    wider = {name: Normal(0.0, 2.0 * std) for name, std in zip("abc", STDS, strict=True)}
    with pytest.raises(ValueError, match="the copula has the inputs a, b, c: give it those of the expansion, with"):
        shapley_effects(surrogate, GaussianCopula(wider, np.eye(3)))
    with pytest.raises(ValueError, match="no input is named 'd'"):
        shapley_effects(surrogate, copula, groups={"g": ["d"]})
    with pytest.raises(ValueError, match="count is 1, "):
        shapley_effects(surrogate, copula, count=1)
    many = {f"x{k}": Uniform(0.0, 1.0) for k in range(11)}
    x = sobol_sequence(many, 40)
    surrogate, copula = fit(many, x, x.sum(axis=1), degree=1), GaussianCopula(many, np.eye(11))
    with pytest.raises(ValueError, match="there are 11 inputs and groups, but at most 10 can be told apart"):
        shapley_effects(surrogate, copula)
    together = {"pair": ["x0", "x1"], "six": [f"x{k}" for k in range(2, 8)]}
    found = shapley_effects(surrogate, copula, groups=together, count=2000)
    assert found.share == pytest.approx(np.array([2.0, 6.0, 1.0, 1.0, 1.0]) / 11.0, abs=0.06)


def test_a_fit_says_which_inputs_depend_on_each_other() -> None:
    copula = GaussianCopula(INPUTS, RANKS)
    x = copula.sobol_sequence(100)
    with pytest.warns(UserWarning, match=r"modulus and friction depend .* \(rank correlation 0\.5"):
        surrogate = fit(INPUTS, x, x[:, 1], degree=1)
    (pair,) = [pair for pair in surrogate.report["dependent_inputs"] if pair[0] == "modulus"]
    assert pair[:2] == ["modulus", "friction"]
    assert pair[2] == pytest.approx(0.6, abs=0.1)


@pytest.mark.parametrize("design", ["grid", "sequence", "hypercube", "few", "repeated"])
def test_designs_of_independent_inputs_raise_no_word(design) -> None:
    x = {
        "grid": lambda: tensor_grid(INPUTS, 2),
        "sequence": lambda: sobol_sequence(INPUTS, 50),
        "hypercube": lambda: latin_hypercube(INPUTS, 30),
        "few": lambda: sobol_sequence(INPUTS, 4),
        # Runs of one point say nothing of the design.
        "repeated": lambda: np.repeat(sobol_sequence(INPUTS, 20, seed=2), 20, axis=0),
    }[design]()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        surrogate = fit(INPUTS, x, x[:, 1], degree=0)
    assert surrogate.report["dependent_inputs"] == []


def test_missing_runs_make_no_inputs_dependent() -> None:
    """Where runs are missing by the sum of two inputs, those that are left would look correlated."""
    inputs = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}
    x = sobol_sequence(inputs, 128)
    y = np.where(x.sum(axis=1) < 0.8, np.nan, x[:, 0])
    left = x[np.isfinite(y)]
    assert stats.spearmanr(left).statistic < -0.3
    assert fit(inputs, x, y, degree=1).report["dependent_inputs"] == []
