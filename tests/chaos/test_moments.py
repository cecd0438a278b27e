"""Moments, effects, slopes and marginals against closed forms, and expansions against other programs."""

import numpy as np
import pytest
from scipy import stats

from lithobrake.chaos import (
    Beta,
    Empirical,
    Exponential,
    Gamma,
    LogNormal,
    LogUniform,
    Normal,
    TruncatedNormal,
    Uniform,
    density,
    fit,
    gradient,
    latin_hypercube,
    main_effect,
    marginal,
    multi_index_set,
    output_correlation,
    quantiles,
    shape_moments,
    smolyak,
    smolyak_count,
    sobol_sequence,
)
from lithobrake.chaos.moments import _by_grid as moments_by_grid
from lithobrake.chaos.polynomial_products import central_moments


def test_sum_of_independent_inputs_adds_cumulants():
    inputs = {
        "n": Normal(3.0, 0.5), "e": Exponential(2.0), "g": Gamma(2.5, 0.4), "b": Beta(2.0, 5.0, 0.0, 3.0),
        "u": Uniform(-1.0, 2.0), "t": TruncatedNormal(0.0, 1.0, -1.0, 2.0), "m": Empirical([1.0, 2.0, 2.5, 4.0]),
    }  # fmt: skip
    oracles = [
        stats.norm(3.0, 0.5), stats.expon(scale=0.5), stats.gamma(2.5, scale=0.4), stats.beta(2.0, 5.0, 0.0, 3.0),
        stats.uniform(-1.0, 3.0), stats.truncnorm(-1.0, 2.0),
    ]  # fmt: skip
    rows = [[float(one) for one in oracle.stats(moments="vsk")] for oracle in oracles]
    samples = np.array([1.0, 2.0, 2.5, 4.0])
    rows.append([samples.var(), stats.skew(samples), stats.kurtosis(samples)])
    variances, skewnesses, excesses = np.array(rows).T
    x = latin_hypercube(inputs, 60, seed=1)
    surrogate = fit(inputs, x, x.sum(axis=1), degree=1)
    total = variances.sum()
    assert shape_moments(surrogate)["exact"]
    assert surrogate.skewness == pytest.approx((skewnesses * variances**1.5).sum() / total**1.5, rel=1e-9)
    assert surrogate.kurtosis == pytest.approx(3.0 + (excesses * variances**2).sum() / total**2, rel=1e-9)


def test_squares_and_logarithms_with_several_outputs():
    inputs = {"a": Normal(1.0, 2.0), "b": LogUniform(1.0, 100.0), "idle": Uniform(0.0, 1.0), "c": LogNormal(0.5, 0.7)}
    x = latin_hypercube(inputs, 80, seed=2)
    square = ((x[:, 0] - 1.0) / 2.0) ** 2
    y = np.column_stack([square, np.log(x[:, 1]), np.log(x[:, 3]), np.full(80, 2.0), square * np.log(x[:, 3])])
    surrogate = fit(inputs, x, y, degree=3)
    # Chi-square of one degree of freedom, uniform, normal, constant.
    assert np.allclose(surrogate.skewness[:4], [np.sqrt(8.0), 0.0, 0.0, 0.0], atol=1e-10)
    assert np.allclose(surrogate.kurtosis[:4], [15.0, 1.8, 3.0, 0.0], atol=1e-9)
    # A product of independent factors has products of raw moments: chi-square 1, 3, 15, 105, and the normal's.
    chi, normal = np.array([1.0, 1.0, 3.0, 15.0, 105.0]), [stats.norm(0.5, 0.7).moment(k) for k in range(1, 5)]
    m = chi * np.array([1.0, *normal])
    variance = m[2] - m[1] ** 2
    third = m[3] - 3.0 * m[1] * m[2] + 2.0 * m[1] ** 3
    fourth = m[4] - 4.0 * m[1] * m[3] + 6.0 * m[1] ** 2 * m[2] - 3.0 * m[1] ** 4
    assert surrogate.skewness[4] == pytest.approx(third / variance**1.5, rel=1e-9)
    assert surrogate.kurtosis[4] == pytest.approx(fourth / variance**2, rel=1e-9)


def test_many_inputs_stay_exact_by_products_of_terms():
    inputs = {f"x{k}": Uniform(0.0, 1.0) for k in range(12)}
    x = sobol_sequence(inputs, 200)
    shape = shape_moments(fit(inputs, x, (x[:, :3] ** 2).sum(axis=1) + x[:, 3:].sum(axis=1), degree=2))
    assert shape["exact"]
    # Variance, third and fourth cumulant of u**2 are 4/45, 16/945 and the bracket; nine uniforms add 9/12, 0, -9/120.
    variance = 3.0 * 4.0 / 45.0 + 9.0 / 12.0
    assert shape["skewness"] == pytest.approx(3.0 * 16.0 / 945.0 / variance**1.5, rel=1e-9)
    excess = 3.0 * (1.0 / 9.0 - 4.0 / 21.0 + 6.0 / 45.0 - 3.0 / 81.0 - 3.0 * (4.0 / 45.0) ** 2) - 9.0 / 120.0
    assert shape["kurtosis"] == pytest.approx(3.0 + excess / variance**2, rel=1e-9)


def test_products_and_gauss_nodes_agree_in_every_family():
    inputs = {
        "n": Normal(0.0, 1.0), "g": Gamma(2.5, 0.4), "b": Beta(2.0, 5.0), "t": TruncatedNormal(0.0, 1.0, -1.0, 2.0),
        "idle": Uniform(0.0, 1.0), "m": Empirical(np.random.default_rng(1).normal(size=80)),
    }  # fmt: skip
    indices = multi_index_set(6, 4, max_degrees=[4, 3, 4, 2, 0, 4])
    coefficients = np.random.default_rng(0).normal(size=(len(indices), 2)) / (1.0 + indices.sum(axis=1))[:, None] ** 2
    degrees = indices.max(axis=0)
    rules = [entry.gauss(2 * int(d) + 1) for entry, d in zip(inputs.values(), degrees, strict=True) if d > 0]
    expansion = inputs, indices, coefficients
    for products, nodes in zip(central_moments(*expansion), moments_by_grid(*expansion, rules), strict=True):
        assert np.allclose(products, nodes, rtol=1e-10)


def test_a_constant_has_no_shape():
    surrogate = fit({"a": Uniform(0.0, 1.0)}, [0.1, 0.5, 0.9], [2.0, 2.0, 2.0], degree=1)
    expansion = surrogate.inputs, surrogate.multi_indices, surrogate.coefficients[:, None]
    assert central_moments(*expansion)[0].tolist() == [0.0]
    assert (surrogate.skewness, surrogate.kurtosis) == (0.0, 0.0)


def test_sampling_takes_over_where_neither_is_affordable(monkeypatch):
    monkeypatch.setattr("lithobrake.chaos.moments.PRODUCT_LIMIT", 10)
    monkeypatch.setattr("lithobrake.chaos.moments.NODE_LIMIT", 10)
    inputs = {"a": Exponential(1.0), "b": Exponential(1.0)}
    x = sobol_sequence(inputs, 40)
    shape = shape_moments(fit(inputs, x, x.sum(axis=1), degree=2), count=200_000)
    assert not shape["exact"]
    assert shape["skewness"] == pytest.approx(np.sqrt(2.0), abs=0.02)
    assert shape["kurtosis"] == pytest.approx(6.0, abs=0.2)


INPUTS = {"a": Uniform(-1.0, 1.0), "b": LogUniform(1.0, 10.0), "c": Normal(2.0, 0.5)}


def truth(x):
    return x[:, 0] ** 2 * x[:, 2] + np.log(x[:, 1]) * x[:, 2]


@pytest.fixture(scope="module")
def surrogate():
    x = sobol_sequence(INPUTS, 100)
    return fit(INPUTS, x, np.column_stack([truth(x), x[:, 2]]), degree=3, output_names=["t", "c"])


def test_main_effect_is_the_conditional_mean(surrogate):
    values, effect = main_effect(surrogate, "a", [-0.5, 0.0, 1.0])
    assert np.allclose(effect[:, 0], 2.0 * values**2 + np.log(10.0), rtol=1e-12)
    values, effect = main_effect(surrogate, "b", 7)
    assert len(values) == 7
    assert np.allclose(effect[:, 0], 2.0 / 3.0 + 2.0 * np.log(values), rtol=1e-12)
    with pytest.raises(ValueError, match="no input is named"):
        main_effect(surrogate, "z")


def test_marginal_keeps_mean_and_group_share(surrogate):
    reduced = marginal(surrogate, ["c", "a"])
    assert reduced.input_names == ["c", "a"]
    assert np.allclose(reduced.mean, surrogate.mean)
    assert np.allclose(reduced.variance, surrogate.variance * surrogate.sobol_group(["a", "c"]))
    assert np.allclose(reduced([[2.5, 0.3]])[0, 0], 2.5 * (0.09 + 0.5 * np.log(10.0)))


def test_gradient(surrogate):
    x = sobol_sequence(INPUTS, 20, seed=3)
    exact = np.column_stack([2.0 * x[:, 0] * x[:, 2], x[:, 2] / x[:, 1], x[:, 0] ** 2 + np.log(x[:, 1])])
    assert np.allclose(gradient(surrogate, x)[:, 0], exact, rtol=1e-10, atol=1e-10)
    assert np.allclose(gradient(surrogate, x)[:, 1], [0.0, 0.0, 1.0], atol=1e-10)


def test_distribution_of_the_outputs(surrogate):
    assert np.allclose(quantiles(surrogate, [0.5, 0.975])[:, 1], [2.0, 2.0 + 0.5 * 1.96], atol=0.02)
    values, heights = density(surrogate, "c")
    exact = np.exp(-0.5 * ((values - 2.0) / 0.5) ** 2) / (0.5 * np.sqrt(2.0 * np.pi))
    assert np.abs(heights - exact).max() < 0.03
    shape = shape_moments(surrogate)
    assert shape["skewness"][1] == pytest.approx(0.0, abs=0.02)
    assert shape["kurtosis"][1] == pytest.approx(3.0, abs=0.05)
    covariance = 0.25 * (1.0 / 3.0 + 0.5 * np.log(10.0))
    correlation = covariance / np.sqrt(0.25 * surrogate.variance[0])
    assert output_correlation(surrogate)[0, 1] == pytest.approx(correlation, rel=1e-10)
    with pytest.raises(ValueError, match="output"):
        density(surrogate, "z")


ORACLE_INPUTS = {"a": Uniform(-1.0, 3.0), "b": Normal(1.0, 0.5), "c": Uniform(0.0, 2.0)}


def model(x):
    return np.exp(0.3 * x[:, 0]) * np.sin(x[:, 1]) + x[:, 2] ** 3


@pytest.fixture(scope="module")
def fitted():
    x = sobol_sequence(ORACLE_INPUTS, 120)
    return x, model(x), fit(ORACLE_INPUTS, x, model(x), degree=4, method="ols")


def test_chaospy_gives_the_same_expansion(fitted):
    chaospy = pytest.importorskip("chaospy", reason="chaospy is not installed")
    x, y, surrogate = fitted
    joint = chaospy.J(chaospy.Uniform(-1.0, 3.0), chaospy.Normal(1.0, 0.5), chaospy.Uniform(0.0, 2.0))
    basis = chaospy.generate_expansion(4, joint, normed=True)
    theirs, coefficients = chaospy.fit_regression(basis, x.T, y, retall=1)
    assert len(basis) == surrogate.term_count
    # Terms are ordered differently; orthonormal coefficients are equal up to their order and sign.
    assert np.allclose(np.sort(np.abs(coefficients)), np.sort(np.abs(surrogate.coefficients)), atol=1e-10)
    assert surrogate.mean == pytest.approx(float(chaospy.E(theirs, joint)), rel=1e-10)
    assert surrogate.variance == pytest.approx(float(chaospy.Var(theirs, joint)), rel=1e-10)
    assert np.allclose(surrogate.sobol_first, chaospy.Sens_m(theirs, joint), atol=1e-10)
    assert np.allclose(surrogate.sobol_total, chaospy.Sens_t(theirs, joint), atol=1e-10)


def test_chaospy_gives_the_same_sparse_grid():
    chaospy = pytest.importorskip("chaospy", reason="chaospy is not installed")
    joint = chaospy.J(chaospy.Uniform(-1.0, 1.0), chaospy.Uniform(-1.0, 1.0), chaospy.Uniform(-1.0, 1.0))
    nodes, _ = chaospy.generate_quadrature(3, joint, rule="clenshaw_curtis", sparse=True, growth=True)
    ours = smolyak({name: Uniform(-1.0, 1.0) for name in "abc"}, 3)
    theirs = np.unique(np.round(nodes.T, 12), axis=0)
    assert len(theirs) == smolyak_count(3, 3)
    assert np.allclose(theirs, np.unique(np.round(ours, 12), axis=0), atol=1e-10)


def test_openturns_gives_the_same_coefficients(fitted):
    openturns = pytest.importorskip("openturns", reason="openturns is not installed")
    x, y, surrogate = fitted
    joint = openturns.JointDistribution(
        [openturns.Uniform(-1.0, 3.0), openturns.Normal(1.0, 0.5), openturns.Uniform(0.0, 2.0)]
    )
    enumeration = openturns.LinearEnumerateFunction(3)
    families = [openturns.StandardDistributionPolynomialFactory(joint.getMarginal(k)) for k in range(3)]
    basis = openturns.OrthogonalProductPolynomialFactory(families, enumeration)
    algorithm = openturns.FunctionalChaosAlgorithm(
        openturns.Sample(x.tolist()), openturns.Sample(y[:, None].tolist()), joint,
        openturns.FixedStrategy(basis, len(multi_index_set(3, 4))), openturns.LeastSquaresStrategy(),
    )  # fmt: skip
    algorithm.run()
    result = algorithm.getResult()
    theirs = {tuple(enumeration(index)): result.getCoefficients()[k, 0] for k, index in enumerate(result.getIndices())}
    assert len(theirs) == surrogate.term_count
    for index, value in zip(surrogate.multi_indices.tolist(), surrogate.coefficients, strict=True):
        assert value == pytest.approx(theirs[tuple(index)], abs=1e-10)
