"""Skewness and kurtosis against closed forms, and what happens where the exact way is out of reach."""

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
    fit,
    latin_hypercube,
    shape_moments,
    sobol_sequence,
)


def test_sum_of_independent_inputs_adds_cumulants():
    inputs = {
        "n": Normal(3.0, 0.5),
        "e": Exponential(2.0),
        "g": Gamma(2.5, 0.4),
        "b": Beta(2.0, 5.0, 0.0, 3.0),
        "u": Uniform(-1.0, 2.0),
        "t": TruncatedNormal(0.0, 1.0, -1.0, 2.0),
        "m": Empirical([1.0, 2.0, 2.5, 4.0]),
    }
    oracles = [
        stats.norm(3.0, 0.5),
        stats.expon(scale=0.5),
        stats.gamma(2.5, scale=0.4),
        stats.beta(2.0, 5.0, 0.0, 3.0),
        stats.uniform(-1.0, 3.0),
        stats.truncnorm(-1.0, 2.0),
    ]
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


def test_sampling_takes_over_where_the_grid_is_too_large():
    inputs = {f"x{k}": Uniform(0.0, 1.0) for k in range(12)}
    x = sobol_sequence(inputs, 200)
    surrogate = fit(inputs, x, (x[:, :3] ** 2).sum(axis=1) + x[:, 3:].sum(axis=1), degree=2)
    shape = shape_moments(surrogate, count=200_000)
    assert not shape["exact"]
    # Variance and third cumulant of u**2 are 4/45 and 16/945; nine uniforms add 9/12.
    variance = 3.0 * 4.0 / 45.0 + 9.0 / 12.0
    assert shape["skewness"] == pytest.approx(3.0 * 16.0 / 945.0 / variance**1.5, abs=0.01)
    excess = 3.0 * (1.0 / 9.0 - 4.0 / 21.0 + 6.0 / 45.0 - 3.0 / 81.0 - 3.0 * (4.0 / 45.0) ** 2) - 9.0 / 120.0
    assert shape["kurtosis"] == pytest.approx(3.0 + excess / variance**2, abs=0.02)
