"""Scatter: how often intervals hold the truth under noise, and scatter as a function of the inputs."""

import numpy as np
import pytest

from lithobrake import emulator
from lithobrake.chaos import (
    Normal,
    Uniform,
    basis_matrix,
    christoffel,
    christoffel_weights,
    coefficient_changes,
    condition_number,
    d_optimal,
    fit,
    fit_stochastic,
    load_stochastic,
    multi_index_set,
    score_intervals,
    smolyak,
    sobol_estimates,
    sobol_intervals,
    sobol_sequence,
)

CUBE = {name: Uniform(-1.0, 1.0) for name in "abc"}
# y = a + b / 2 + a c: variances 1/3, 1/12, 1/9.
PARTS = np.array([1.0 / 3.0, 1.0 / 12.0, 1.0 / 9.0])
FIRST = np.array([PARTS[0], PARTS[1], 0.0]) / PARTS.sum()
TOTAL = np.array([PARTS[0] + PARTS[2], PARTS[1], PARTS[2]]) / PARTS.sum()


def runs(count, seed, scatter=0.2):
    x = sobol_sequence(CUBE, count, seed=seed)
    noise = scatter * np.random.default_rng(seed).normal(size=count)
    return x, x[:, 0] + 0.5 * x[:, 1] + x[:, 0] * x[:, 2] + noise


# Of a scatter of 0.9 are six tenths of the variance: what a fit finds then depends on luck, and its interval says so.
@pytest.mark.parametrize(("keywords", "scatter", "trials", "widest"), [
    ({"degree": 2}, 0.2, 40, 0.2),
    ({"method": "lars", "degree": 3}, 0.2, 5, 0.2),
    ({}, 0.2, 4, 0.2),
    ({"method": "gaussian_process"}, 0.9, 4, 1.0),
    ({"method": "omp"}, 0.9, 5, 1.0),
])  # fmt: skip
def test_sobol_intervals_cover_the_truth_under_noise(keywords, scatter, trials, widest):
    covered, width = np.zeros((2, 3)), np.zeros((2, 3))
    for seed in range(trials):
        x, y = runs(60, seed, scatter)
        surrogate = fit(CUBE, x, y, **keywords)
        bounds = sobol_intervals(surrogate, x, y, count=200, level=0.9, seed=seed)
        for row, (key, truth) in enumerate((("first", FIRST), ("total", TOTAL))):
            low, high = bounds[key]
            covered[row] += (low <= truth + 1e-12) & (truth <= high + 1e-12)
            width[row] += (high - low) / trials
        assert np.all(bounds["first"][0] <= surrogate.sobol_first)
        assert np.all(surrogate.sobol_total <= bounds["total"][1])
    # 90 % intervals: two standard deviations of a share counted in so many trials, and 0.02, below.
    assert np.all(covered / trials > 0.88 - 2.0 * np.sqrt(0.09 / trials))
    # Useful, too: a fifth of the width of knowing nothing.
    assert width.max() < widest


def test_no_input_is_ruled_out_by_outputs_that_are_all_scatter():
    x = sobol_sequence(CUBE, 60)
    y = np.random.default_rng(4).normal(size=60)
    bounds = sobol_intervals(fit(CUBE, x, y), x, y, count=200)
    assert np.all(bounds["total"][0] == 0.0)
    assert np.all(bounds["total"][1] > 0.5)


def test_estimates_are_free_of_the_variance_that_scatter_adds_to_squares():
    """Three quarters of the variance are scatter: what the expansion says of inputs that do nothing is scatter, too."""
    estimates, own = [], []
    for seed in range(60):
        x = sobol_sequence(CUBE, 60, seed=seed)
        y = x[:, 0] + np.random.default_rng(seed).normal(size=60)
        surrogate = fit(CUBE, x, y, degree=2)
        estimates.append(sobol_estimates(surrogate, x, y, count=100, seed=seed)["first"])
        own.append(surrogate.sobol_first)
    point, low, high = np.mean(estimates, axis=0)
    # The truth is 1, 0, 0. What is cut at 0 and 1 keeps a little of the scatter.
    assert np.all(low <= point)
    assert np.all(point <= high)
    assert point[0] > 0.9 > 0.8 > np.mean(own, axis=0)[0]
    assert np.all(point[1:] < 0.6 * np.mean(own, axis=0)[1:])


def test_an_effect_too_small_for_the_choice_of_terms_stays_possible():
    held = 0
    for seed in range(20):
        x, y = runs(40, seed)
        y += 0.08 * (3.0 * x[:, 2] ** 2 - 1.0)
        surrogate = fit(CUBE, x, y, method="omp", degree=4)
        # Its variance is 0.08**2 * 4 / 5; the scatter alone has 0.04.
        share = 0.08**2 * 0.8 / (PARTS.sum() + 0.08**2 * 0.8)
        low, high = sobol_intervals(surrogate, x, y, count=100, level=0.9)["first"][:, 2]
        held += low <= share <= high
    assert held >= 16


def test_several_outputs_of_different_methods_and_a_constant_one():
    inputs = {name: Uniform(0.0, 1.0) for name in "ab"}
    x = sobol_sequence(inputs, 50)
    y = np.column_stack([np.abs(x[:, 0] - 0.4) + 0.1 * x[:, 1], x[:, 0] * x[:, 1], np.full(50, 2.0)])
    bounds = sobol_intervals(fit(inputs, x, y), x, y, count=100)
    assert bounds["first"].shape == bounds["total"].shape == (2, 2, 3)
    assert np.all(bounds["first"][0] <= bounds["first"][1])
    assert np.all(bounds["first"][:, :, 2] == 0.0)
    assert np.allclose(bounds["first"][:, :, 1], 3.0 / 7.0, atol=1e-6)


def test_on_a_grid_only_terms_that_it_determines_are_drawn():
    x = smolyak(CUBE, 4)
    y = x[:, 0] + 0.5 * x[:, 1] + x[:, 0] * x[:, 2] + 0.2 * np.random.default_rng(0).normal(size=len(x))
    bounds = sobol_intervals(fit(CUBE, x, y, method="omp"), x, y, count=100)
    assert np.all(bounds["total"][0] <= TOTAL)
    assert np.all(bounds["total"][1] - bounds["total"][0] < 0.3)


def test_score_intervals_hold_the_scores_of_many_runs():
    x, y = runs(60, 0)
    # Shifted, so that no output is near 0, where a percentage error has no spread to speak of.
    surrogate = fit(CUBE, x, y + 3.0, degree=2)

    def test_runs(count, seed):
        generator = np.random.default_rng([7, seed])
        points = generator.uniform(-1.0, 1.0, size=(count, 3))
        truth = points[:, 0] + 0.5 * points[:, 1] + points[:, 0] * points[:, 2] + 3.0
        return points, truth + 0.2 * generator.normal(size=count)

    exact = surrogate.score(*test_runs(200_000, 0))["y"]
    trials = 100
    covered = dict.fromkeys(("mape", "q2", "rrmse", "rmse"), 0)
    for seed in range(1, trials + 1):
        bounds = score_intervals(surrogate, *test_runs(60, seed), count=200, level=0.9)["y"]
        for key in covered:
            covered[key] += bounds[key][0] <= exact[key] <= bounds[key][1]
    # A share of 0.9 counted in 100 trials has a standard deviation of 0.03.
    assert min(covered.values()) >= 0.84 * trials, covered


def test_score_intervals_of_few_perfect_and_impossible_scores():
    x, _ = runs(30, 0)
    surrogate = fit(CUBE, x, x[:, 0], degree=1)
    assert score_intervals(surrogate, x[:4], x[:4, 0] + 0.1)["y"]["q2"] == (-np.inf, 1.0)
    exact = score_intervals(surrogate, x, surrogate(x))["y"]
    assert (exact["mape"], exact["q2"]) == ((0.0, 0.0), (1.0, 1.0))
    # One true value of 0: no percentage, but all else.
    y = x[:, 0] + 0.1 * x[:, 1]
    y[3] = 0.0
    bounds = score_intervals(surrogate, x, y)["y"]
    assert bounds["mape"] == (np.inf, np.inf)
    assert 0.0 < bounds["rmse"][0] < surrogate.score(x, y)["y"]["rmse"] < bounds["rmse"][1] < np.inf
    assert bounds["q2"] == (1.0 - bounds["rrmse"][1] ** 2, 1.0 - bounds["rrmse"][0] ** 2)
    # Constant outputs have no share of a variance.
    assert score_intervals(surrogate, x, np.full(30, 1.5))["y"]["q2"] == (-np.inf, -np.inf)


def test_score_intervals_of_errors_with_long_tails_reach_far_enough():
    surrogate = fit(CUBE, *runs(60, 0), degree=2)
    generator, held, trials = np.random.default_rng(4), 0, 200
    for seed in range(trials):
        x = generator.uniform(-1.0, 1.0, size=(50, 3))
        y = surrogate(x) + 0.1 * generator.standard_t(4, size=50)
        low, high = score_intervals(surrogate, x, y, count=200, level=0.9, seed=seed)["y"]["rmse"]
        # The variance of Student's t with 4 degrees of freedom is 2.
        held += low <= 0.1 * np.sqrt(2.0) <= high
    # Over 600 trials 0.82 held it, 0.74 with plain percentiles; a share of 200 has a standard deviation of 0.027.
    assert held >= 0.77 * trials


def test_wrong_levels_and_counts_are_refused():
    x, y = runs(30, 0)
    surrogate = fit(CUBE, x, y, degree=1)
    with pytest.raises(ValueError, match="level"):
        score_intervals(surrogate, x, y, level=1.5)
    with pytest.raises(ValueError, match="count"):
        sobol_intervals(surrogate, x, y, count=3)


def test_changes_of_coefficients_scatter_as_least_squares_does():
    x, y = runs(60, 3)
    surrogate = fit(CUBE, x, y, degree=2, method="ols")
    indices, changes = coefficient_changes(surrogate, x, y, count=4000, seed=1)
    assert indices.tolist() == sorted(surrogate.multi_indices.tolist())
    matrix = basis_matrix(CUBE, indices, x)
    expected = 0.2 * np.sqrt(np.diag(np.linalg.inv(matrix.T @ matrix)))
    # Sixty residuals know their own spread to a tenth; they are enlarged to those of left-out points.
    assert changes[..., 0].std(axis=0) == pytest.approx(expected, rel=0.35)
    assert np.all(np.abs(changes[..., 0].mean(axis=0)) < 4.0 * expected / np.sqrt(4000))


INPUTS = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}


def test_mean_scatter_and_joint_samples(tmp_path):
    x = np.repeat(sobol_sequence(INPUTS, 40), 8, axis=0)
    generator = np.random.default_rng(0)
    common = generator.normal(size=len(x))
    std = 0.1 * np.exp(x[:, 0])
    first = x[:, 1] + std * common
    second = 2.0 - x[:, 0] + 0.2 * (0.8 * common + 0.6 * generator.normal(size=len(x)))
    model = fit_stochastic(INPUTS, x, np.column_stack([first, second]), output_names=["p", "q"])
    test = sobol_sequence(INPUTS, 50, seed=5)
    error = model.mean(test) - np.column_stack([test[:, 1], 2.0 - test[:, 0]])
    # 320 runs average the scatter down to a tenth of it or so, depending on how many terms the fit takes up.
    assert np.all(np.sqrt(np.mean(error**2, axis=0)) < 0.25 * model.scatter_std(test).mean(axis=0))
    # The logarithm of a variance from 8 runs has the standard deviation sqrt(trigamma(3.5)) = 0.57; forty groups and
    # three to six terms leave 0.57 sqrt(6 / 40) / 2 = 0.11 in the logarithm of the standard deviation.
    assert np.sqrt(np.mean(np.log(model.scatter_std(test)[:, 0] / (0.1 * np.exp(test[:, 0]))) ** 2)) < 0.18
    assert model.correlation[0, 1] == pytest.approx(0.8, abs=0.08)
    many = np.tile(test[:1], (20000, 1))
    drawn = model.sample(many, seed=3)
    assert np.allclose(drawn.std(axis=0), model.scatter_std(test[:1])[0], rtol=0.03)
    assert np.corrcoef(drawn.T)[0, 1] == pytest.approx(model.correlation[0, 1], abs=0.02)
    with pytest.raises(ValueError, match="seed is 'x'"):
        model.sample(test, seed="x")
    model.save(tmp_path / "model.json")
    with pytest.raises(ValueError, match="not a lithobrake emulator, but a lithobrake stochastic surrogate"):
        emulator.load(tmp_path / "model.json")
    assert np.array_equal(load_stochastic(tmp_path / "model.json").sample(test, seed=8), model.sample(test, seed=8))


def test_without_repeats_or_scatter_it_is_refused():
    x = sobol_sequence(INPUTS, 20)
    with pytest.raises(ValueError, match="repeat"):
        fit_stochastic(INPUTS, x, x[:, 0])
    twice = np.repeat(x, 2, axis=0)
    with pytest.raises(ValueError, match="no scatter"):
        fit_stochastic(INPUTS, twice, twice[:, 0])


def test_weighted_christoffel_design_is_well_conditioned():
    inputs = {"a": Normal(0.0, 1.0), "b": Uniform(0.0, 1.0)}
    indices = multi_index_set(2, 8)
    x = christoffel(inputs, 3 * len(indices), degree=8, seed=1)
    weights = christoffel_weights(inputs, x, indices)
    assert condition_number(inputs, x, indices, weights=weights) < 8.0
    assert condition_number(inputs, x, indices, weights=weights) < 0.1 * condition_number(
        inputs, sobol_sequence(inputs, 3 * len(indices)), indices
    )
    y = np.exp(0.3 * x[:, 0]) * np.sin(2.0 * x[:, 1])
    surrogate = fit(inputs, x, y, degree=8, weights=weights)
    test = sobol_sequence(inputs, 500, seed=9)
    assert surrogate.score(test, np.exp(0.3 * test[:, 0]) * np.sin(2.0 * test[:, 1]))["y"]["rrmse"] < 1e-5


def test_added_points_mend_an_existing_design():
    indices = multi_index_set(2, 4)
    half = sobol_sequence({"a": Uniform(0.0, 0.5), "b": Uniform(0.0, 0.5)}, 15)
    added = d_optimal(INPUTS, 10, degree=4, existing=half)
    assert added.shape == (10, 2)
    assert condition_number(INPUTS, np.vstack([half, added]), indices) < 0.05 * condition_number(INPUTS, half, indices)


def test_d_optimal_chooses_among_given_candidates_once():
    candidates = sobol_sequence(INPUTS, 40)
    chosen = d_optimal(INPUTS, 12, degree=2, candidates=candidates)
    assert len(np.unique(chosen, axis=0)) == 12
    assert all((candidates == row).all(axis=1).any() for row in chosen)
    with pytest.raises(ValueError, match="candidates"):
        d_optimal(INPUTS, 41, degree=2, candidates=candidates)
