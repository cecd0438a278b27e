"""Distributions, their families of polynomials, and designs: grids, samples, dependent inputs."""

from dataclasses import fields
from functools import partial

import numpy as np
import pytest
from scipy import special, stats

from lithobrake import chaos
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
    christoffel,
    condition_number,
    distribution,
    fekete,
    fit,
    latin_hypercube,
    multi_index_set,
    smolyak,
    smolyak_count,
    sobol_sequence,
    tensor_count,
    tensor_grid,
    term_count,
)
from lithobrake.chaos.basis import outside_count
from lithobrake.chaos.numerical_distributions import KINDS
from lithobrake.study.quantity import DISTRIBUTIONS

PAIRS = [
    (Uniform(2.0, 5.0), stats.uniform(2.0, 3.0)), (LogUniform(1e-3, 1e4), stats.loguniform(1e-3, 1e4)),
    (Normal(-2.0, 0.5), stats.norm(-2.0, 0.5)), (LogNormal(1.0, 0.3), stats.lognorm(0.3, scale=np.exp(1.0))),
    (TruncatedNormal(1.0, 2.0, 0.0, 9.0), stats.truncnorm(-0.5, 4.0, 1.0, 2.0)),
    (TruncatedNormal(0.0, 1.0, 8.0, np.inf), stats.truncnorm(8.0, np.inf)),
    (TruncatedNormal(0.0, 1.0, -np.inf, -8.0), stats.truncnorm(-np.inf, -8.0)),
    (TruncatedNormal(0.0, 1.0, -np.inf, 1.0), stats.truncnorm(-np.inf, 1.0)),
    (TruncatedNormal(0.0, 1.0, -1.0, np.inf), stats.truncnorm(-1.0, np.inf)),
    (TruncatedNormal(0.0, 1.0, 6.0, 9.0), stats.truncnorm(6.0, 9.0)),
    (TruncatedNormal(0.0, 1.0, -9.0, -7.0), stats.truncnorm(-9.0, -7.0)),
    (Beta(2.0, 5.0, -1.0, 3.0), stats.beta(2.0, 5.0, -1.0, 4.0)), (Gamma(3.0, 0.2), stats.gamma(3.0, scale=0.2)),
    (Exponential(4.0), stats.expon(scale=0.25)),
]  # fmt: skip
U = np.array([1e-6, 0.01, 0.3, 0.5, 0.77, 0.999, 1.0 - 1e-9])


@pytest.mark.parametrize(("entry", "oracle"), PAIRS, ids=lambda one: getattr(one, "kind", ""))
def test_quantiles_match_scipy_and_have_their_probability(entry, oracle):
    # SciPy loses digits of a truncated normal from the one end or, by its release, from the other.
    from_below, from_above = oracle.ppf(U), oracle.isf(1.0 - U)
    found = entry.ppf(U)
    near = [np.isclose(found, expected, rtol=1e-9, atol=1e-12) for expected in (from_below, from_above)]
    assert (near[0] | near[1]).all()
    assert entry.median == pytest.approx(oracle.median(), rel=1e-9)
    u = np.array([0.001, 0.2, 0.5, 0.9, 0.999])
    assert np.allclose(entry.cdf(entry.ppf(u)), u, rtol=1e-9)


@pytest.mark.parametrize(
    ("mean", "lower", "upper"),
    [(0.5, 0.1, 0.9), (1.8, 0.1, 0.9), (-0.8, 0.1, 0.9), (0.9, 0.1, np.inf), (0.2, 0.1, 0.9)],
)
def test_probabilities_of_a_truncated_normal_are_those_of_its_quantiles(mean, lower, upper):
    """Also where the mean is 90 standard deviations beyond a limit, and at its limits."""
    entry = TruncatedNormal(mean, 0.01, lower, upper)
    assert np.allclose(entry.cdf(entry.ppf(U)), U, rtol=1e-6, atol=1e-9)
    assert entry.cdf(np.array([lower, upper])).tolist() == [0.0, 1.0]


@pytest.mark.parametrize("entry", [pair[0] for pair in PAIRS], ids=lambda one: one.kind)
def test_germ_and_back_and_slope(entry):
    x = entry.ppf(U)
    assert np.allclose(entry.physical(entry.germ(x)), x, rtol=1e-12)
    step = 1e-6 * np.abs(x[1:5])
    difference = (entry.germ(x[1:5] + step) - entry.germ(x[1:5] - step)) / (2.0 * step)
    assert np.allclose(entry.germ_derivative(x[1:5]), difference, rtol=1e-5)


@pytest.mark.parametrize("entry", [pair[0] for pair in PAIRS] + [Empirical([3.0, 1.0, 2.0])], ids=lambda one: one.kind)
def test_name_and_parameters_give_it_back(entry):
    content = entry.to_json()
    assert distribution(content.pop("kind"), **content) == entry


def test_limits_become_exactly_plus_and_minus_one():
    for entry in (Uniform(0.2, 0.9), LogUniform(1e6, 1e8), Beta(2.0, 3.0, 0.1, 0.7)):
        assert list(entry.germ(np.array(entry.support))) == [-1.0, 1.0]
        assert tuple(entry.physical(np.array([-1.0, 1.0]))) == entry.support


def test_empirical_quantiles_are_its_samples():
    assert Empirical([5.0, 1.0, 3.0]).ppf(np.array([0.0, 0.1, 0.5, 0.9, 1.0])).tolist() == [1.0, 1.0, 3.0, 5.0, 5.0]


@pytest.mark.parametrize("make", [
    lambda: Uniform(1.0, 1.0), lambda: Uniform(2.0, 1.0), lambda: Uniform(float("nan"), 1.0),
    lambda: Uniform("low", 1.0), lambda: Uniform(0.0, float("inf")), lambda: LogUniform(0.0, 1.0),
    lambda: Normal(0.0, 0.0), lambda: Normal(0.0, -1.0), lambda: LogNormal(0.0, 0.0),
    lambda: TruncatedNormal(0.0, 1.0, 2.0, 1.0), lambda: TruncatedNormal(0.0, -1.0, 0.0, 1.0),
    lambda: TruncatedNormal(1e300, 1.0, 0.1, 0.9), lambda: TruncatedNormal(50.0, 0.01, 0.1, 0.9),
    lambda: TruncatedNormal(0.5, 5e-324, 0.1, 0.9), lambda: TruncatedNormal(0.5, 1e300, 0.1, 0.9),
    lambda: TruncatedNormal(0.5, 0.1, -1e308, 1e308), lambda: Beta(0.0, 1.0, 0.0, 1.0), lambda: Gamma(-1.0, 1.0),
    lambda: Gamma(1.0, 0.0), lambda: Exponential(0.0), lambda: Empirical([]), lambda: Empirical([1.0, 1.0]),
    lambda: Empirical([1.0, float("nan")]), lambda: distribution("triangular", lower=0.0),
    lambda: distribution("uniform", lower=0.0), lambda: distribution("uniform", lower=0.0, upper=1.0, mode=0.5),
])  # fmt: skip
def test_wrong_parameters_are_refused_in_one_sentence(make):
    with pytest.raises(ValueError, match=r"^[^\n]+$"):
        make()


@pytest.mark.parametrize("samples", [["rough", "smooth"], [1j, 2.0]])
def test_samples_that_are_no_numbers_are_refused_as_choices(samples):
    with pytest.raises(ValueError, match="discrete choices are not supported"):
        Empirical(samples)
    with pytest.raises(ValueError, match="discrete choices are not supported"):
        distribution("choice", values=samples)


def test_all_distributions_are_public_and_known_to_study_files():
    parameters = {kind: tuple(field.name for field in fields(entry)) for kind, entry in KINDS.items()}
    # Samples do not stand in a study file.
    assert parameters.pop("empirical") == ("samples",)
    assert parameters == DISTRIBUTIONS
    assert {entry.__name__ for entry in KINDS.values()} <= set(dir(chaos))


@pytest.mark.parametrize("entry", [LogUniform(1e-6, 1e8), LogNormal(0.0, 1.0)])
def test_what_has_no_logarithm_is_outside_however_wide_the_support(entry):
    assert outside_count({"a": entry}, np.array([[-1e-5], [0.0], [1.0]]))[0] == 2


def test_probability_of_samples_is_their_rank():
    assert Empirical([1.0, 2.0, 3.0, 4.0]).cdf(np.array([1.0, 4.0])).tolist() == [0.125, 0.875]


DEGREE = 20


def gram_error(table, weights):
    return np.abs((table * weights) @ table.T - np.eye(len(table))).max()


CASES = {
    "uniform": (Uniform(-3.0, 5.0), special.roots_legendre(60)),
    "log_uniform": (LogUniform(1e6, 1e8), special.roots_legendre(60)),
    "normal": (Normal(4.0, 0.1), special.roots_hermitenorm(60)),
    "log_normal": (LogNormal(0.0, 2.0), special.roots_hermitenorm(60)),
    "gamma": (Gamma(2.5, 3.0), special.roots_genlaguerre(60, 1.5)),
    "gamma_steep": (Gamma(0.5, 3.0), special.roots_genlaguerre(60, -0.5)),
    "gamma_narrow": (Gamma(50.0, 1.0), special.roots_genlaguerre(60, 49.0)),
    "exponential": (Exponential(0.2), special.roots_laguerre(60)),
    "beta": (Beta(2.0, 3.5, -1.0, 1.0), special.roots_jacobi(60, 2.5, 1.0)),
    "beta_arcsine": (Beta(0.5, 0.5), special.roots_jacobi(60, -0.5, -0.5)),
    "beta_narrow": (Beta(50.0, 50.0), special.roots_jacobi(60, 49.0, 49.0)),
    "beta_lopsided": (Beta(10.0, 0.7), special.roots_jacobi(60, -0.3, 9.0)),
    "beta_uniform": (Beta(1.0, 1.0), special.roots_legendre(60)),
}


@pytest.mark.parametrize("name", CASES)
def test_classical_families_are_orthonormal_to_degree_20(name):
    entry, rule = CASES[name]
    nodes, weights = rule
    assert gram_error(entry.recurrence(DEGREE).values(nodes), weights / weights.sum()) < 1e-12


@pytest.mark.parametrize(
    "limits", [(-1.0, 2.0), (-3.0, 3.0), (0.5, 4.0), (-np.inf, np.inf), (-1.0, np.inf), (8.0, np.inf), (20.0, 21.0)]
)
def test_truncated_normal_is_orthonormal_to_degree_20(limits):
    entry = TruncatedNormal(10.0, 2.0, *(10.0 + 2.0 * np.array(limits)))
    # The weight times the squared polynomial is negligible 22 standard deviations from the mean and, further out, from
    # the nearer limit.
    low, high = limits[0], min(limits[1], max(limits[0], 0.0) + 22.0)
    edges = np.linspace(max(low, -22.0), high, 46)[:, None]
    nodes, weights = special.roots_legendre(60)
    z = (0.5 * (edges[:-1] + edges[1:]) + 0.5 * (edges[1:] - edges[:-1]) * nodes).ravel()
    mode = min(max(0.0, low), high)
    density = np.tile(weights, 45) * np.exp(-0.5 * (z - mode) * (z + mode))
    table = entry.recurrence(DEGREE).values(entry.germ(10.0 + 2.0 * z))
    assert gram_error(table, density / density.sum()) < 1e-12


def test_empirical_is_orthonormal_over_its_samples():
    samples = np.random.default_rng(3).normal(size=800)
    table = Empirical(samples).recurrence(DEGREE).values(Empirical(samples).germ(samples))
    assert gram_error(table, np.full(800, 1.0 / 800)) < 1e-12


def test_empirical_refuses_a_degree_that_its_values_cannot_tell_apart():
    with pytest.raises(ValueError, match="distinct"):
        Empirical([1.0, 2.0, 2.0, 3.0]).recurrence(3)


def test_degrees_that_rounding_spoils_are_refused():
    entry = Empirical(np.random.default_rng(0).lognormal(0.0, 1.5, size=300))
    highest = int(entry.highest_degree)
    assert 5 < highest < 20
    table = entry.recurrence(highest).values(entry.germ(np.array(entry.samples)))
    assert gram_error(table, np.full(300, 1.0 / 300)) < 1e-8
    with pytest.raises(ValueError, match=f"up to degree {highest}"):
        entry.recurrence(highest + 1)


def test_slopes_are_derivatives():
    recurrence = Gamma(2.0, 1.0).recurrence(6)
    germ, step = np.linspace(0.2, 4.0, 9), 1e-6
    difference = (recurrence.values(germ + step) - recurrence.values(germ - step)) / (2.0 * step)
    assert np.allclose(recurrence.derivatives(germ), difference, rtol=1e-6, atol=1e-6)


def test_gauss_rule_matches_scipy():
    nodes, weights = Normal(0.0, 1.0).recurrence(12).gauss_rule()
    expected, expected_weights = special.roots_hermitenorm(12)
    assert np.allclose(nodes, expected, atol=1e-13)
    assert np.allclose(weights, expected_weights / expected_weights.sum(), rtol=1e-11)


# Distinct nodes of levels 1 to 5 and terms of degrees 1 to 5 for each number of inputs: own count, equal to
# that of two other programs.
NODES = {
    2: [5, 13, 29, 65, 145], 3: [7, 25, 69, 177, 441], 4: [9, 41, 137, 401, 1105], 5: [11, 61, 241, 801, 2433],
    6: [13, 85, 389, 1457, 4865], 7: [15, 113, 589, 2465, 9017], 8: [17, 145, 849, 3937, 15713],
}  # fmt: skip
TERMS = {
    2: [3, 6, 10, 15, 21], 3: [4, 10, 20, 35, 56], 4: [5, 15, 35, 70, 126], 5: [6, 21, 56, 126, 252],
    6: [7, 28, 84, 210, 462], 7: [8, 36, 120, 330, 792], 8: [9, 45, 165, 495, 1287],
}  # fmt: skip


def cube(count):
    return {f"x{k}": Uniform(-1.0, 1.0) for k in range(count)}


@pytest.mark.parametrize("count", NODES)
def test_node_and_term_counts(count):
    for level, (nodes, terms) in enumerate(zip(NODES[count], TERMS[count], strict=True), start=1):
        assert smolyak_count(count, level) == nodes
        assert term_count(count, level) == terms == len(multi_index_set(count, level))
        if nodes < 5000:
            x = smolyak(cube(count), level)
            assert len(x) == nodes == len(np.unique(x, axis=0))


def test_higher_level_starts_with_the_lower_bit_for_bit():
    inputs = {"a": LogUniform(1e6, 1e8), "b": Uniform(0.2, 0.9), "c": Beta(2.0, 2.0, -1.0, 4.0)}
    for level in range(5):
        lower, higher = smolyak(inputs, level), smolyak(inputs, level=level + 1)
        assert np.array_equal(lower, higher[: len(lower)])
    for k, entry in enumerate(inputs.values()):
        assert (higher[:, k].min(), higher[:, k].max()) == entry.support


def test_smolyak_refuses_unbounded_inputs_and_names_the_remedy():
    with pytest.raises(ValueError, match="TruncatedNormal"):
        smolyak({"a": Uniform(0.0, 1.0), "b": Normal(0.0, 1.0)}, level=2)
    with pytest.raises(ValueError, match="level"):
        smolyak(cube(2), level=-1)


def test_condition_numbers_of_the_papers_designs():
    assert condition_number(cube(3), smolyak(cube(3), 5), multi_index_set(3, 5)) == pytest.approx(9.1, abs=0.05)
    assert condition_number(cube(5), smolyak(cube(5), 3), 3) == pytest.approx(5.3, abs=0.05)
    assert condition_number(cube(3), smolyak(cube(3), 4), multi_index_set(3, 5)) == pytest.approx(10.7, abs=0.05)


@pytest.mark.parametrize("count", [2, 3, 4, 5])
def test_rank_on_the_sparse_grid(count):
    for level in (1, 2, 3):
        x = smolyak(cube(count), level)
        fit(cube(count), x, x[:, 0], degree=level, method="ols")
        # One degree more is lost if and only if a product of level + 1 different inputs exists.
        if count >= level + 1 and len(x) >= term_count(count, level + 1):
            with pytest.raises(ValueError, match="terms"):
                fit(cube(count), x, x[:, 0], degree=level + 1, method="ols")


def test_tensor_grid_counts_and_exactness():
    inputs = {"a": Normal(1.0, 2.0), "b": Exponential(3.0)}
    x = tensor_grid(inputs, 4)
    assert len(x) == 25 == tensor_count(2, 4)
    assert len(tensor_grid(inputs, [1, 3])) == 8
    assert np.isfinite(condition_number(inputs, x, multi_index_set(2, 4)))


@pytest.mark.parametrize("design", [sobol_sequence, latin_hypercube, fekete])
def test_designs_by_count_are_deterministic_and_inside(design):
    inputs = {"a": LogUniform(1e6, 1e8), "b": Normal(0.0, 1.0), "c": Uniform(0.2, 0.9), "d": Empirical([1, 2, 3, 5, 9])}
    x = design(inputs, 40, 3)
    assert x.shape == (40, 4)
    assert np.array_equal(x, design(inputs, 40, seed=3))
    assert not np.array_equal(x, design(inputs, 40, seed=4))
    for k, entry in enumerate(inputs.values()):
        assert x[:, k].min() >= entry.support[0]
        assert x[:, k].max() <= entry.support[1]


def test_sobol_sequence_extends():
    inputs = cube(3)
    long = sobol_sequence(inputs, 100, seed=1)
    assert np.array_equal(sobol_sequence(inputs, 37, seed=1), long[:37])
    assert np.array_equal(sobol_sequence(inputs, 63, seed=1, skip=37), long[37:])


def test_latin_hypercube_has_one_point_in_each_stratum():
    x = latin_hypercube(cube(3), 50, seed=2)
    for k in range(3):
        assert sorted(np.floor((x[:, k] + 1.0) * 25.0).astype(int)) == list(range(50))


def test_fekete_is_better_conditioned_than_random_points():
    inputs = cube(3)
    indices = multi_index_set(3, 4)
    chosen = fekete(inputs, degree=4)
    assert len(chosen) == len(indices)
    random = condition_number(inputs, sobol_sequence(inputs, 35), indices)
    assert condition_number(inputs, chosen, indices) < 0.5 * random
    with pytest.raises(ValueError, match="terms"):
        fekete(inputs, 10, degree=4)


def test_counts_are_refused():
    for wrong in (0, -1, 2.5):
        with pytest.raises(ValueError, match="count"):
            sobol_sequence(cube(2), wrong)


@pytest.mark.parametrize("design", [sobol_sequence, latin_hypercube, partial(christoffel, degree=2)])
def test_what_no_memory_holds_and_what_is_no_seed_are_refused(design):
    with pytest.raises(ValueError, match=r"count is 1000000000000, but must be a whole number from 1 to 536870912"):
        design(cube(2), 10**12)
    with pytest.raises(ValueError, match=r"seed is 'x'"):
        design(cube(2), 4, "x")


def test_a_grid_that_no_memory_holds_is_refused():
    with pytest.raises(ValueError, match=r"level is 20, of which a Smolyak grid in 10 inputs has \d+ nodes"):
        smolyak(cube(10), 20)


def test_a_sequence_is_not_longer_than_its_digits():
    with pytest.raises(ValueError, match=r"skip is 1000000000000, .* from 0 to 1073741816"):
        sobol_sequence(cube(2), 8, skip=10**12)
