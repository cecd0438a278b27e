"""Fits against exact moments and published functions; moments and effects against closed forms and other programs."""

from itertools import pairwise

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
    fekete,
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
    tensor_grid,
)
from lithobrake.chaos.sobol_indices import _by_grid as moments_by_grid
from lithobrake.chaos.sobol_indices import central_moments
from lithobrake.chaos.sparse_regression import _order

ISHIGAMI = {name: Uniform(-np.pi, np.pi) for name in ("a", "b", "c")}
ISHIGAMI_VARIANCE = 49.0 / 8.0 + 0.1 * np.pi**4 / 5.0 + 0.01 * np.pi**8 / 18.0 + 0.5
ISHIGAMI_FIRST = np.array([0.5 * (1.0 + 0.1 * np.pi**4 / 5.0) ** 2, 49.0 / 8.0, 0.0]) / ISHIGAMI_VARIANCE


def ishigami(x):
    """Source: Ishigami and Homma, 1990, a = 7, b = 0.1."""
    return np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


def test_polynomial_in_mixed_families_has_exact_moments():
    samples = np.random.default_rng(0).normal(size=60)
    inputs = {"u": Uniform(-1.0, 3.0), "n": Normal(0.5, 2.0), "g": Gamma(2.0, 0.5), "e": Exponential(2.0),
        "b": Beta(2.0, 3.0, 0.0, 2.0), "t": TruncatedNormal(0.0, 1.0, -1.0, 2.0), "m": Empirical(samples)}  # fmt: skip
    oracles = [stats.uniform(-1.0, 4.0), stats.norm(0.5, 2.0), stats.gamma(2.0, scale=0.5), stats.expon(scale=0.5),
        stats.beta(2.0, 3.0, 0.0, 2.0), stats.truncnorm(-1.0, 2.0)]  # fmt: skip
    x = latin_hypercube(inputs, 300, seed=1)
    y = 1.0 + np.prod(x[:, [0, 1]], axis=1) + x[:, 2] * x[:, 3] + x[:, 4] ** 2 - x[:, 5] ** 2 + x[:, 6] * x[:, 0]
    surrogate = fit(inputs, x, y, degree=2, method="ols")
    m = [[oracle.moment(power) for power in range(5)] for oracle in oracles]
    m.append([np.mean(samples**power) for power in range(5)])
    mean = 1 + m[0][1] * m[1][1] + m[2][1] * m[3][1] + m[4][2] - m[5][2] + m[6][1] * m[0][1]
    variance = m[2][2] * m[3][2] - (m[2][1] * m[3][1]) ** 2 + m[4][4] - m[4][2] ** 2 + m[5][4] - m[5][2] ** 2
    # u (n + m): both products share u.
    variance += m[0][2] * (m[1][2] + m[6][2] + 2 * m[1][1] * m[6][1]) - (m[0][1] * (m[1][1] + m[6][1])) ** 2
    assert surrogate.mean == pytest.approx(mean, rel=1e-10)
    assert surrogate.variance == pytest.approx(variance, rel=1e-10)


def test_logarithmic_germs():
    inputs = {"a": LogUniform(1.0, np.e**2), "b": LogNormal(0.0, 0.5)}
    x = fekete(inputs, degree=2)
    surrogate = fit(inputs, x, np.log(x[:, 0]) * np.log(x[:, 1]) + np.log(x[:, 0]), degree=2)
    assert surrogate.mean == pytest.approx(1.0, rel=1e-12)
    assert surrogate.variance == pytest.approx((4.0 / 3.0) * 0.25 + 1.0 / 3.0, rel=1e-12)


def test_ishigami_converges_with_degree():
    x = tensor_grid(ISHIGAMI, 13)
    y = ishigami(x)
    test = sobol_sequence(ISHIGAMI, 500, seed=9)
    errors = []
    for degree in (4, 6, 8, 10, 12):
        surrogate = fit(ISHIGAMI, x, y, degree=degree, method="ols")
        errors.append(surrogate.score(test, ishigami(test))["y"]["rrmse"])
    assert all(later < 0.5 * earlier for earlier, later in pairwise(errors))
    assert surrogate.mean == pytest.approx(3.5, abs=1e-4)
    assert surrogate.variance == pytest.approx(ISHIGAMI_VARIANCE, rel=1e-3)
    assert np.allclose(surrogate.sobol_first, ISHIGAMI_FIRST, atol=1e-3)
    assert surrogate.sobol_total[2] == pytest.approx(1.0 - ISHIGAMI_FIRST[:2].sum(), abs=1e-3)


def test_sobol_g_indices_converge():
    a = np.array([0.0, 1.0, 4.5])
    inputs = {f"x{k}": Uniform(0.0, 1.0) for k in range(3)}
    # An even number of nodes an input: none sits on the kink, where it would count too much.
    x = tensor_grid(inputs, 15)
    y = np.prod((np.abs(4.0 * x - 2.0) + a) / (1.0 + a), axis=1)
    partial = 1.0 / (3.0 * (1.0 + a) ** 2)
    exact = partial / (np.prod(1.0 + partial) - 1.0)
    errors = [np.abs(fit(inputs, x, y, degree=d).sobol_first - exact).max() for d in (4, 8, 12)]
    assert errors[2] < errors[1] < errors[0]
    assert errors[2] < 0.002


def test_several_outputs_equal_single_ones():
    x = smolyak(ISHIGAMI, 3)
    y = ishigami(x)
    both = fit(ISHIGAMI, x, np.column_stack([y, -2.0 * y]), degree=3, output_names=["up", "down"])
    one = fit(ISHIGAMI, x, y, degree=3)
    assert both.output_names == ["up", "down"]
    assert both.mean.shape == both.variance.shape == (2,)
    assert both.sobol_first.shape == both.sobol_total.shape == (3, 2)
    assert one.sobol_first.shape == one.sobol_total.shape == (3,)
    assert np.allclose(both.coefficients[:, 0], one.coefficients, atol=1e-12)
    assert np.allclose(both(x)[:, 1], -2.0 * one(x), atol=1e-10)
    assert one.sobol_group(["a", "b", "c"]) == pytest.approx(1.0)
    assert both.sobol_group(["a"]) == pytest.approx(both.sobol_first[0])


def test_missing_runs_are_dropped_and_counted_other_nan_refused():
    x = smolyak(ISHIGAMI, 3)
    holes = np.column_stack([ishigami(x), x[:, 0]]).copy()
    holes[[3, 10]] = np.nan
    surrogate = fit(ISHIGAMI, x, holes, degree=3)
    assert (surrogate.dropped_count, surrogate.report["train_count"]) == (2, len(x) - 2)
    holes[20, 0] = np.nan
    with pytest.raises(ValueError, match="NaN"):
        fit(ISHIGAMI, x, holes, degree=3)
    with pytest.raises(ValueError, match="none of"):
        fit(ISHIGAMI, x, np.full(len(x), np.nan), degree=1)


def test_masked_outputs_are_missing_runs_and_masked_inputs_are_refused():
    x = smolyak(ISHIGAMI, 3)
    y, hidden = ishigami(x), np.arange(len(x)) < 5
    surrogate = fit(ISHIGAMI, x, np.ma.masked_array(np.where(hidden, 1e3, y), mask=hidden), degree=2)
    assert surrogate.dropped_count == 5
    assert np.array_equal(surrogate.coefficients, fit(ISHIGAMI, x[5:], y[5:], degree=2).coefficients)
    with pytest.raises(ValueError, match="x has 1 masked values"):
        fit(ISHIGAMI, np.ma.masked_array(x, mask=np.arange(x.size).reshape(x.shape) == 4), y, degree=2)
    with pytest.raises(ValueError, match="weights has 5 masked values"):
        fit(ISHIGAMI, x, y, degree=2, weights=np.ma.masked_array(np.ones(len(x)), mask=hidden))


@pytest.mark.parametrize(
    ("factor", "words"), [(1e307, "larger unit"), (1e120, "larger unit"), (1e-200, "smaller unit")]
)
def test_outputs_whose_squares_are_no_numbers_are_refused(factor, words):
    x = smolyak(ISHIGAMI, 3)
    with pytest.raises(ValueError, match=words):
        fit(ISHIGAMI, x, x[:, 0] * factor, degree=2)


@pytest.mark.parametrize(("keywords", "match"), [
    ({"degree": 5}, "points cannot determine"),
    ({"degree": 4}, "terms"),
    ({"degree": -1}, "degree"),
    ({"degree": 2, "method": "magic"}, "method"),
    ({"degree": 2, "q_norm": 0.0}, "q_norm"),
    ({"degree": 2, "weights": [1.0]}, "weights"),
    ({"degree": 2, "output_names": ["a", "b"]}, "output_names"),
])  # fmt: skip
def test_refusals(keywords, match):
    x = smolyak({f"x{k}": Uniform(-1.0, 1.0) for k in range(5)}, 3)
    with pytest.raises(ValueError, match=match):
        fit({f"x{k}": Uniform(-1.0, 1.0) for k in range(5)}, x, x[:, 0], **keywords)


def test_shapes_and_supports_are_refused():
    inputs = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}
    x = sobol_sequence(inputs, 20)
    for wrong_x, wrong_y in ((x[:, :1], x[:, 0]), (x, x[:5, 0]), (x + 1.0, x[:, 0]), (x * np.nan, x[:, 0])):
        with pytest.raises(ValueError, match=r"x|y"):
            fit(inputs, wrong_x, wrong_y, degree=1)
    with pytest.raises(ValueError, match="discrete"):
        fit({"a": [1, 2, 3], "b": Uniform(0.0, 1.0)}, x, x[:, 0], degree=1)


def test_lost_terms_are_named():
    inputs = {name: Uniform(-1.0, 1.0) for name in "abcd"}
    x = smolyak(inputs, 2)
    with pytest.raises(ValueError, match=r"31 of 35 terms \(lost: a b c, a b d, a c d, b c d, "):
        fit(inputs, x, x[:, 0], degree=3, method="ols")


@pytest.mark.parametrize("wrong", [None, "2", 2.5, float("nan"), True, -1])
def test_what_is_no_whole_number_is_refused_with_its_name(wrong):
    inputs = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}
    x = sobol_sequence(inputs, 20)
    calls = {
        "level": [lambda: smolyak(inputs, wrong), lambda: tensor_grid(inputs, wrong)],
        "count": [lambda: sobol_sequence(inputs, wrong), lambda: latin_hypercube(inputs, wrong)],
        "max_degrees": [lambda: fit(inputs, x, x[:, 0], degree=1, max_degrees=[1, wrong])],
    }
    for name, makers in calls.items():
        for make in makers:
            with pytest.raises(ValueError, match=f"{name} is"):
                make()
    if wrong is not None:
        with pytest.raises(ValueError, match="degree is"):
            fit(inputs, x, x[:, 0], degree=wrong)


@pytest.mark.parametrize("method", [None, "ols", "lars", "omp"])
def test_inputs_of_few_values_limit_only_their_own_degree(method):
    inputs = {"a": Empirical([1.0, 2.0, 4.0]), "b": Uniform(0.0, 1.0)}
    x, test = sobol_sequence(inputs, 60, seed=1), sobol_sequence(inputs, 200, seed=2)
    surrogate = fit(inputs, x, x[:, 0] + np.tanh(3.0 * x[:, 1]), method=method)
    assert surrogate.score(test, test[:, 0] + np.tanh(3.0 * test[:, 1]))["y"]["rrmse"] < 1e-3
    assert surrogate.multi_indices[:, 0].max() <= 2


@pytest.mark.parametrize("size", [1.0, 1e-9])
def test_terms_enter_in_the_order_of_another_library(size):
    from sklearn.linear_model import orthogonal_mp

    random = np.random.default_rng(5)
    matrix = np.column_stack([np.ones(60), random.normal(size=(60, 90))])
    y = matrix[:, 7] - 0.6 * matrix[:, 30] + 0.3 * random.normal(size=60)
    columns = matrix[:, 1:] - matrix[:, 1:].mean(axis=0)
    path = orthogonal_mp(columns / np.linalg.norm(columns, axis=0), y - y.mean(), n_nonzero_coefs=30, return_path=True)
    entered = np.where((path != 0.0).any(axis=1), (path != 0.0).argmax(axis=1), 30)
    # The unit of an output is nothing to its terms.
    assert _order(matrix, size * y, "omp").tolist() == (1 + np.argsort(entered, kind="stable")[:30]).tolist()


def test_equal_points_and_far_too_few_still_give_an_expansion():
    inputs = {f"x{k}": Uniform(0.0, 1.0) for k in range(12)}
    x = sobol_sequence(inputs, 8)
    assert np.isfinite(fit(inputs, np.tile(x[:1], (8, 1)), np.arange(8.0)).mean)
    for count in (1, 2, 8):
        for method in (None, "lars", "omp"):
            assert np.isfinite(fit(inputs, x[:count], x[:count, 0], method=method).mean)


def test_scores_of_wrong_shapes_are_refused():
    inputs = {"a": Uniform(0.0, 1.0)}
    x = sobol_sequence(inputs, 10)
    surrogate = fit(inputs, x, x[:, 0], degree=1)
    for points, y in ((x, x[:5, 0]), (x, np.zeros((10, 2))), (np.zeros((0, 1)), np.zeros(0))):
        with pytest.raises(ValueError, match="y has shape"):
            surrogate.score(points, y)


@pytest.mark.parametrize(("degree", "said"), [
    (10**9, "whole number from 0 to 20000000"),
    (20_000_000, "too many terms to look at"),
    (100_000, "50 points cannot"),
])  # fmt: skip
def test_a_degree_beyond_all_memory_is_refused_before_anything_is_made(degree, said):
    x = sobol_sequence({"a": Uniform(0.0, 1.0)}, 50)
    with pytest.raises(ValueError, match=said):
        fit({"a": Uniform(0.0, 1.0)}, x, x[:, 0], degree=degree)
    many = {name: Uniform(0.0, 1.0) for name in "abcdef"}
    with pytest.raises(ValueError, match="too many terms to look at"):
        fit(many, sobol_sequence(many, 50), np.arange(50.0), degree=1000)


@pytest.mark.parametrize("method", ["omp", "lars"])
def test_an_output_whose_mean_is_off_it_by_rounding_is_constant(method):
    inputs = {"a": Uniform(0.0, 1.0)}
    values = np.full(5, 0.013)
    assert values.mean() != 0.013
    surrogate = fit(inputs, smolyak(inputs, 2), values, None, method)
    assert (surrogate.mean, surrogate.variance) == (pytest.approx(0.013, rel=1e-15), 0.0)


def test_sum_of_independent_inputs_adds_cumulants():
    inputs = {"n": Normal(3.0, 0.5), "e": Exponential(2.0), "g": Gamma(2.5, 0.4), "b": Beta(2.0, 5.0, 0.0, 3.0),
        "u": Uniform(-1.0, 2.0), "t": TruncatedNormal(0.0, 1.0, -1.0, 2.0),
        "m": Empirical([1.0, 2.0, 2.5, 4.0])}  # fmt: skip
    oracles = [stats.norm(3.0, 0.5), stats.expon(scale=0.5), stats.gamma(2.5, scale=0.4),
        stats.beta(2.0, 5.0, 0.0, 3.0), stats.uniform(-1.0, 3.0), stats.truncnorm(-1.0, 2.0)]  # fmt: skip
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
    inputs = {"n": Normal(0.0, 1.0), "g": Gamma(2.5, 0.4), "b": Beta(2.0, 5.0),
        "t": TruncatedNormal(0.0, 1.0, -1.0, 2.0), "idle": Uniform(0.0, 1.0),
        "m": Empirical(np.random.default_rng(1).normal(size=80))}  # fmt: skip
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
    monkeypatch.setattr("lithobrake.chaos.sobol_indices.PRODUCT_LIMIT", 10)
    monkeypatch.setattr("lithobrake.chaos.sobol_indices.NODE_LIMIT", 10)
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
    algorithm = openturns.FunctionalChaosAlgorithm(openturns.Sample(x.tolist()), openturns.Sample(y[:, None].tolist()),
        joint, openturns.FixedStrategy(basis, len(multi_index_set(3, 4))),
        openturns.LeastSquaresStrategy())  # fmt: skip
    algorithm.run()
    result = algorithm.getResult()
    theirs = {tuple(enumeration(index)): result.getCoefficients()[k, 0] for k, index in enumerate(result.getIndices())}
    assert len(theirs) == surrogate.term_count
    for index, value in zip(surrogate.multi_indices.tolist(), surrogate.coefficients, strict=True):
        assert value == pytest.approx(theirs[tuple(index)], abs=1e-10)
