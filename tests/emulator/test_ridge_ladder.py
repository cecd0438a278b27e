"""Ridges against their normal equations, and what a ladder makes of known laws."""

from dataclasses import replace

import numpy as np
import pytest

from lithobrake.chaos import Uniform, sobol_sequence
from lithobrake.emulator.ridge_ladder import Rung, Smoother, TermTable, best_ladder
from lithobrake.emulator.terms import MOST_TERMS, candidate_terms, terms_up_to

INPUTS = {"a": Uniform(0.0, 1.0), "b": Uniform(0.0, 1.0), "c": Uniform(0.0, 1.0)}
TERMS = terms_up_to(INPUTS, 2)
COUNT = 120
MATRIX = TERMS.matrix(sobol_sequence(INPUTS, COUNT, seed=3))
NOISE = np.random.default_rng(2).standard_normal(COUNT)
DESIGN = TermTable(TERMS.indices, MATRIX, np.ones(COUNT))
LADDER = (Rung((1.0, 0.0, 1.0), (0.4, 0.4, 0.4), 2, 0.1, 0.7), Rung((0.0, 1.0, 0.0), (0.4, 0.4, 0.4), 1, 0.03, 0.2))


def test_linear_terms_come_first_in_the_order_of_the_inputs() -> None:
    np.testing.assert_array_equal(TERMS.indices[:3], np.eye(3))
    assert len(TERMS.indices) == 9


def test_a_rung_is_a_ridge_on_its_own_terms() -> None:
    rung = Rung((1.0, 0.0, 0.7), (0.5, 0.5, 0.3), 2, 0.1)
    coefficients = Smoother(DESIGN, (rung,)).coefficients(NOISE)
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
    rung = Rung((1.0, 1.0, 1.0), (0.4, 0.4, 0.4), 2, 1e-9)
    residual = Smoother(DESIGN, (rung,)).left_out(NOISE)
    for run in (0, 17, 80):
        rest = np.arange(COUNT) != run
        law = Smoother(DESIGN.of(rest), (rung,)).coefficients(NOISE[rest])
        assert residual[run] == pytest.approx(NOISE[run] - law[0] - MATRIX[run] @ law[1:], rel=1e-6)


def test_an_average_is_the_sum_of_its_rungs() -> None:
    whole = Smoother(DESIGN, LADDER).coefficients(NOISE)[1:]
    parts = [Smoother(DESIGN, (replace(rung, weight=1.0),)).coefficients(NOISE)[1:] for rung in LADDER]
    np.testing.assert_allclose(whole, 0.7 * parts[0] + 0.2 * parts[1], rtol=1e-9, atol=1e-12)


def test_weights_count_a_run_several_times() -> None:
    weights = np.random.default_rng(0).integers(0, 3, COUNT)
    repeated = np.repeat(np.arange(COUNT), weights)
    by_weight = Smoother(TermTable(TERMS.indices, MATRIX, weights.astype(float)), LADDER).coefficients(NOISE)
    copies = TermTable(TERMS.indices, MATRIX[repeated], np.ones(len(repeated)))
    by_copies = Smoother(copies, LADDER).coefficients(NOISE[repeated])
    np.testing.assert_allclose(by_weight, by_copies, rtol=1e-9)


def test_a_strong_law_is_found_with_its_inputs_and_degree() -> None:
    linear, curved = MATRIX[:, 0] + 0.1 * NOISE, MATRIX[:, 0] + MATRIX[:, 3] + 0.1 * NOISE
    for target, degree in ((linear, 1), (curved, 2)):
        ladder = best_ladder(DESIGN, target)
        assert sum(rung.weight for rung in ladder if rung.amplitudes[0] > 0.0) == pytest.approx(1.0, abs=1e-6)
        coefficients = Smoother(DESIGN, ladder).coefficients(target)
        assert abs(coefficients[1] - 1.0) < 0.05
        assert sum(rung.weight for rung in ladder if rung.degree >= degree) > 0.5


def test_noise_leaves_hardly_a_law() -> None:
    explained = []
    for seed in range(20):
        noise = np.random.default_rng(seed).standard_normal(COUNT)
        explained.append((Smoother(DESIGN, best_ladder(DESIGN, noise)).coefficients(noise)[1:] ** 2).sum())
    # Least squares on the nine terms would explain 9 / 120 of the noise.
    assert np.mean(explained) < 0.02


def test_a_constant_has_no_rungs() -> None:
    assert best_ladder(DESIGN, np.full(COUNT, 7.0)) == ()


def test_a_law_that_bends_is_followed_as_far_as_it_bends() -> None:
    """Of sin(4 a) among three inputs a ridge of two degrees leaves 0.99 of the variance, of 300 runs."""
    terms = candidate_terms(INPUTS)
    x, fresh = sobol_sequence(INPUTS, 300, seed=1), sobol_sequence(INPUTS, 500, seed=2)
    wave = np.sin(8.0 * x[:, 0] - 4.0) + 0.1 * np.random.default_rng(0).standard_normal(300)
    design = TermTable(terms.indices, terms.matrix(x), np.ones(300))
    coefficients = Smoother(design, best_ladder(design, wave)).coefficients(wave)
    truth = np.sin(8.0 * fresh[:, 0] - 4.0)
    error = coefficients[0] + terms.matrix(fresh) @ coefficients[1:] - truth
    # Fifteen terms of the one input that counts would leave 15 / 300 of the scatter's hundredth.
    assert np.mean(error**2) < 0.002 * np.var(truth)


@pytest.mark.parametrize("count", [1, 3, 5, 12, 14, 30])
def test_terms_are_no_more_than_runs_can_tell_apart(count: int) -> None:
    terms = candidate_terms({f"input {k}": Uniform(0.0, 1.0) for k in range(count)})
    np.testing.assert_array_equal(terms.indices[:count], np.eye(count))
    assert len(terms.indices) <= MOST_TERMS
    assert len(np.unique(terms.indices, axis=0)) == len(terms.indices)
