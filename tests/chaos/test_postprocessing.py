"""Effects, slopes, marginals and distributions against closed forms."""

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
    shape_moments,
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
