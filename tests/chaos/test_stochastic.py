"""Scatter as a function of the inputs, and designs that complete others."""

import numpy as np
import pytest

from lithobrake.chaos import (
    Normal,
    Uniform,
    christoffel,
    christoffel_weights,
    condition_number,
    d_optimal,
    fit,
    fit_stochastic,
    load_stochastic,
    multi_index_set,
    sobol_sequence,
)
from lithobrake.emulator import load_stochastic_expansion

INPUTS = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0)}


def test_mean_scatter_and_joint_samples(tmp_path):
    x = np.repeat(sobol_sequence(INPUTS, 60), 8, axis=0)
    generator = np.random.default_rng(0)
    common = generator.normal(size=len(x))
    std = 0.1 * np.exp(x[:, 0])
    first = x[:, 1] + std * common
    second = 2.0 - x[:, 0] + 0.2 * (0.8 * common + 0.6 * generator.normal(size=len(x)))
    model = fit_stochastic(INPUTS, x, np.column_stack([first, second]), output_names=["p", "q"])
    test = sobol_sequence(INPUTS, 50, seed=5)
    error = model.mean(test) - np.column_stack([test[:, 1], 2.0 - test[:, 0]])
    # 480 runs average the scatter down to a tenth of it or so, depending on how many terms the fit takes up.
    assert np.all(np.sqrt(np.mean(error**2, axis=0)) < 0.25 * model.scatter_std(test).mean(axis=0))
    # The logarithm of a variance from 8 runs has the standard deviation sqrt(trigamma(3.5)) = 0.57; sixty groups and
    # three to six terms leave 0.57 sqrt(6 / 60) / 2 = 0.09 in the logarithm of the standard deviation.
    logarithm = np.log(model.scatter_std(test)[:, 0] / (0.1 * np.exp(test[:, 0])))
    assert np.sqrt(np.mean(logarithm**2)) < 0.18
    assert model.correlation[0, 1] == pytest.approx(0.8, abs=0.08)
    many = np.tile(test[:1], (20000, 1))
    drawn = model.sample(many, seed=3)
    assert np.allclose(drawn.std(axis=0), model.scatter_std(test[:1])[0], rtol=0.03)
    assert np.corrcoef(drawn.T)[0, 1] == pytest.approx(model.correlation[0, 1], abs=0.02)
    with pytest.raises(ValueError, match="seed is 'x'"):
        model.sample(test, seed="x")
    model.save(tmp_path / "model.json")
    with pytest.raises(
        ValueError, match="not a lithobrake stochastic expansion, but a lithobrake stochastic surrogate"
    ):
        load_stochastic_expansion(tmp_path / "model.json")
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
