"""Ridges against their normal equations, and what a ladder makes of known laws."""

import numpy as np
import pytest

from lithobrake.chaos import Uniform, sobol_sequence
from lithobrake.emulator.ridge_ladder import (
    SECOND_FACTORS,
    Rung,
    _rungs,
    averaged_ridge,
    best_ladder,
    degree_of,
    highest_degree,
    terms_up_to,
)

INPUTS = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0), "c": Uniform(0.0, 1.0)}
TERMS = terms_up_to(INPUTS, 2)
COUNT = 120
MATRIX = TERMS.matrix(sobol_sequence(INPUTS, COUNT, seed=3))
NOISE = np.random.default_rng(2).standard_normal(COUNT)
LADDER = (Rung((0, 2), 0.4, 0.0, 0.1, 0.7), Rung((1,), 0.0, 0.0, 0.03, 0.2))


def test_linear_terms_come_first_in_the_order_of_the_inputs() -> None:
    np.testing.assert_array_equal(TERMS.indices[:3], np.eye(3))
    assert len(TERMS.indices) == 9


def test_a_rung_is_a_ridge_on_its_own_terms() -> None:
    rung = Rung((0, 2), 0.5, 0.0, 0.1)
    coefficients, _ = averaged_ridge(TERMS.indices, MATRIX, NOISE, (rung,), np.ones(COUNT))
    factors = rung.factors(TERMS.indices)
    assert ((factors > 0.0) == (TERMS.indices[:, 1] == 0)).all()
    # The same by the penalty on each coefficient: a factor f divides it by f squared.
    kept = factors > 0.0
    centred = MATRIX[:, kept] - MATRIX[:, kept].mean(axis=0)
    penalty = np.diag(0.1 * COUNT / factors[kept] ** 2)
    expected = np.linalg.solve(centred.T @ centred + penalty, centred.T @ (NOISE - NOISE.mean()))
    np.testing.assert_allclose(coefficients[1:][kept], expected, rtol=1e-9)
    assert (coefficients[1:][~kept] == 0.0).all()


def test_leave_one_out_residuals_are_those_of_fits_without_the_run() -> None:
    rung = Rung((0, 1, 2), 0.4, 0.0, 1e-9)
    _, residual = averaged_ridge(TERMS.indices, MATRIX, NOISE, (rung,), np.ones(COUNT))
    for run in (0, 17, 80):
        rest = np.arange(COUNT) != run
        law, _ = averaged_ridge(TERMS.indices, MATRIX[rest], NOISE[rest], (rung,), np.ones(COUNT - 1))
        assert residual[run] == pytest.approx(NOISE[run] - law[0] - MATRIX[run] @ law[1:], rel=1e-6)


def test_an_average_is_the_sum_of_its_rungs() -> None:
    ones = np.ones(COUNT)
    whole = averaged_ridge(TERMS.indices, MATRIX, NOISE, LADDER, ones)[0][1:]
    parts = [
        averaged_ridge(TERMS.indices, MATRIX, NOISE, (Rung(r.inputs, r.second, 0.0, r.penalty),), ones)[0][1:]
        for r in LADDER
    ]
    np.testing.assert_allclose(whole, 0.7 * parts[0] + 0.2 * parts[1], rtol=1e-9, atol=1e-12)


def test_weights_count_a_run_several_times() -> None:
    weights = np.random.default_rng(0).integers(0, 3, COUNT)
    repeated = np.repeat(np.arange(COUNT), weights)
    by_weight = averaged_ridge(TERMS.indices, MATRIX, NOISE, LADDER, weights.astype(float))[0]
    by_copies = averaged_ridge(TERMS.indices, MATRIX[repeated], NOISE[repeated], LADDER, np.ones(len(repeated)))[0]
    np.testing.assert_allclose(by_weight, by_copies, rtol=1e-9)


def test_a_strong_law_is_found_with_its_inputs_and_degree() -> None:
    linear, curved = MATRIX[:, 0] + 0.1 * NOISE, MATRIX[:, 0] + MATRIX[:, 3] + 0.1 * NOISE
    for target, degree in ((linear, 1), (curved, 2)):
        ladder = best_ladder(TERMS.indices, MATRIX, target)
        assert sum(rung.weight for rung in ladder if 0 in rung.inputs) == pytest.approx(1.0, abs=1e-6)
        coefficients, _ = averaged_ridge(TERMS.indices, MATRIX, target, ladder, np.ones(COUNT))
        assert abs(coefficients[1] - 1.0) < 0.05
        assert degree_of(ladder) >= degree


def test_noise_leaves_hardly_a_law() -> None:
    explained = []
    for seed in range(20):
        noise = np.random.default_rng(seed).standard_normal(COUNT)
        ladder = best_ladder(TERMS.indices, MATRIX, noise)
        explained.append((averaged_ridge(TERMS.indices, MATRIX, noise, ladder, np.ones(COUNT))[0][1:] ** 2).sum())
    # Least squares on the nine terms would explain 9 / 120 of the noise.
    assert np.mean(explained) < 0.02


def test_a_constant_has_no_rungs() -> None:
    assert best_ladder(TERMS.indices, MATRIX, np.full(COUNT, 7.0)) == ()


def test_a_ridge_on_many_inputs_is_linear() -> None:
    """Of thirty inputs there are 465 terms of two degrees, for each of as many sets of inputs: a fit had no end."""
    rng = np.random.default_rng(0)
    inputs = {f"input {k}": Uniform(0.0, 1.0) for k in range(14)}
    terms = terms_up_to(inputs, highest_degree(600, len(inputs)))
    assert terms.degrees.max() == 2
    matrix = terms.matrix(rng.random((30, 14)))
    seconds = {}
    for count in (12, 13):
        rungs = _rungs(terms.indices, tuple(range(count)), matrix.T @ matrix, matrix.T @ matrix[:, 0], 30.0, 30)
        seconds[count] = {rung.second for _, rung in rungs}
    assert seconds == {12: set(SECOND_FACTORS), 13: {0.0}}


@pytest.mark.parametrize(("runs", "inputs", "degree"), [(600, 12, 3), (600, 13, 2), (500, 3, 2)])
def test_cubes_are_for_many_runs_of_few_inputs(runs: int, inputs: int, degree: int) -> None:
    assert highest_degree(runs, inputs) == degree
