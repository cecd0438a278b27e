"""Designs: the sparse grid and least squares on it, the other designs, and dependent inputs."""

from functools import partial

import numpy as np
import pytest
from scipy import stats

from lithobrake.chaos import (
    Beta,
    Empirical,
    Exponential,
    Gamma,
    GaussianCopula,
    LogUniform,
    Normal,
    Uniform,
    christoffel,
    condition_number,
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
    values = fit(normals, x, x[:, 0] * x[:, 1], degree=2)(copula.sobol_sequence(2**15, seed=1))
    # E[ab] = cov = 1; Var[ab] = mean_a**2 var_b + var_a var_b + cov**2. A Sobol sequence errs by a few parts in 1e4.
    assert values.mean() == pytest.approx(1.0, rel=2e-3)
    assert values.var() == pytest.approx(1.0 + 4.0 + 1.0, rel=5e-3)
    uniforms = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}
    copula = GaussianCopula(uniforms, [[1.0, 0.6], [0.6, 1.0]])
    x = copula.sobol_sequence(300)
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
