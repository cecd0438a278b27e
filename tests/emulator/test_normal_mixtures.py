"""Mixtures of normals, which are the law of a stochastic expansion, and the ensembles that stand for them."""

import numpy as np
import pytest
from scipy import special

from lithobrake.chaos import Uniform
from lithobrake.emulator.latent_variable import latent_terms
from lithobrake.emulator.stochastic_expansion import Normals, StochasticExpansion
from lithobrake.emulator.validation import crps, pit

OBSERVED = np.array([-3.0, -0.4, 0.1, 2.0])


@pytest.fixture
def mixture() -> Normals:
    return Normals(np.tile([0.7, 0.3], (4, 1)), np.tile([-1.0, 1.5], (4, 1)), np.full((4, 1), 0.6))


def test_the_score_of_a_mixture_is_that_of_its_draws(mixture: Normals) -> None:
    random, count = np.random.default_rng(0), 200_000
    part = (random.random((4, count)) < 0.3).astype(int)
    draws = np.take_along_axis(mixture.means, part, axis=1) + 0.6 * random.standard_normal((4, count))
    weights = np.full(draws.shape, 1.0 / count)
    # Four standard errors: a draw is some 1.3 from the next.
    np.testing.assert_allclose(mixture.crps(OBSERVED), crps(draws, weights, OBSERVED), atol=4.0 * 1.3 / count**0.5)


def test_the_score_of_one_normal_is_the_known_one() -> None:
    alone = Normals(np.ones((1, 1)), np.zeros((1, 1)), np.ones((1, 1)))
    # Of a standard normal at its mean: (sqrt(2) - 1) / sqrt(pi).
    assert alone.crps(np.zeros(1))[0] == pytest.approx((np.sqrt(2.0) - 1.0) / np.sqrt(np.pi), rel=1e-12)


def test_an_ensemble_of_two_branches_scores_as_their_law_does() -> None:
    terms = latent_terms({"x": Uniform(0.0, 1.0)}, 1, "branches")
    law = StochasticExpansion(terms, np.random.default_rng(1).standard_normal(terms.parameter_count), 0.5)
    points = np.linspace(0.1, 0.9, 4)[:, None]
    values, weights = law.members(points)
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, rtol=1e-12)
    normals = law.normals(points)
    # Fifty values of the noise: steps of the distribution of 0.01 a branch, and tails of 0.01 that are cut off, which
    # take half a percent of the noise of 0.5 from the mean distance of two members.
    np.testing.assert_allclose(crps(values, weights, OBSERVED), normals.crps(OBSERVED), atol=0.005 * 0.5)
    below = normals.averaged(special.ndtr, OBSERVED[:, None])
    np.testing.assert_allclose(pit(values, weights, OBSERVED), below[:, 0], atol=0.01)
