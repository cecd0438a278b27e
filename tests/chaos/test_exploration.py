"""Effects, slopes, marginals, distributions and intervals against closed forms."""

import numpy as np
import pytest

from lithobrake.chaos import (
    LogUniform,
    Normal,
    Uniform,
    density,
    fit,
    gradient,
    main_effect,
    marginal,
    output_correlation,
    quantiles,
    score_intervals,
    shape_moments,
    sobol_intervals,
    sobol_sequence,
)

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


def test_sobol_intervals_cover_the_truth_under_noise():
    inputs = {name: Uniform(-1.0, 1.0) for name in "abc"}
    # y = a + b / 2 + a c: variances 1/3, 1/12, 1/9.
    parts = np.array([1.0 / 3.0, 1.0 / 12.0, 1.0 / 9.0])
    first = np.array([parts[0], parts[1], 0.0]) / parts.sum()
    total = np.array([parts[0] + parts[2], parts[1], parts[2]]) / parts.sum()
    covered = np.zeros(5)
    trials = 60
    for seed in range(trials):
        x = sobol_sequence(inputs, 60, seed=seed)
        noise = 0.2 * np.random.default_rng(seed).normal(size=60)
        y = x[:, 0] + 0.5 * x[:, 1] + x[:, 0] * x[:, 2] + noise
        bounds = sobol_intervals(fit(inputs, x, y, degree=2), x, y, count=200, level=0.9, seed=seed)
        inside_first = (bounds["first"][0] <= first) & (first <= bounds["first"][1])
        inside_total = (bounds["total"][0] <= total) & (total <= bounds["total"][1])
        covered += np.append(inside_first[:2], inside_total)
    # 90 % intervals; 60 trials have a standard deviation of 4 % in the share covered.
    assert np.all(covered / trials > 0.78)


def test_score_intervals_hold_the_score(surrogate):
    x = sobol_sequence(INPUTS, 60, seed=9)
    y = np.column_stack([truth(x), x[:, 2]]) + 0.3 * np.random.default_rng(0).normal(size=(60, 2))
    bounds, score = score_intervals(surrogate, x, y), surrogate.score(x, y)
    for name in ("t", "c"):
        for key in ("mape", "q2"):
            assert bounds[name][key][0] < score[name][key] < bounds[name][key][1]
    with pytest.raises(ValueError, match="level"):
        score_intervals(surrogate, x, y, level=1.5)


def test_intervals_stand_for_a_process_by_least_squares():
    inputs = {name: Uniform(0.0, 1.0) for name in "ab"}
    x = sobol_sequence(inputs, 50)
    y = np.abs(x[:, 0] - 0.4) + 0.1 * x[:, 1]
    surrogate = fit(inputs, x, y)
    bounds = sobol_intervals(surrogate, x, y, count=100)
    assert bounds["degree"] is None or bounds["degree"] >= 1
    assert bounds["first"].shape == (2, 2)
