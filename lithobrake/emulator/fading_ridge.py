"""A ridge that learns how its terms fade: a Gaussian process of finite degree, with lengths of its own for each input.

A term has the prior deviation prod_k a_k f_k**(i_k - 1) over the inputs k that it has in a degree i_k > 0: an input
counts by its amplitude a_k, and bends by its fade f_k. Both, and the penalty, are those of the highest marginal
likelihood, whose gradient costs as much as the fit. Source: [Rasmussen-2006], sections 2.1 (a process as a ridge) and
5.4.1 (gradient); [Durrande-2012] (products over inputs).
"""

import numpy as np
from scipy import linalg, optimize

from lithobrake.chaos.multi_index import Indices
from lithobrake.vocabulary.arrays import Array

# Logarithms of amplitudes, fades and penalty in units of the number of runs: first values and bounds. The likelihood of
# a smooth law and that of one that bends have peaks of their own, so fades start at two.
AMPLITUDE, AMPLITUDES = -1.0, (-5.0, 2.0)
FADES_FIRST, FADES = (-0.9, -0.1), (-4.0, 0.2)
PENALTY, PENALTIES = -5.0, (-23.0, 2.0)
STEPS = 60
# Change of the evidence at which a search ends.
TOLERANCE = 1e-3
REFUSED = 1e10


def exponents(indices: Indices) -> Array:
    """Powers of amplitudes and of fades in the deviation of each term, [term_count, 2 * input_count]."""
    return np.hstack([indices > 0, np.maximum(indices - 1, 0)]).astype(float)


def learnt(indices: Indices, gram: Array, moments: Array, total: float, count: int) -> tuple[float, Array]:
    """Evidence, the logarithm of the marginal likelihood over that of no inputs, and logarithms of amplitudes, fades
    and penalty [2 * input_count + 1].

    gram, moments, total: sums of squares of centred terms, with the target, and of the target; of count runs.
    """
    inputs, powers = indices.shape[1], exponents(indices)

    def loss(vector: Array) -> tuple[float, Array]:
        return _loss(powers, vector, gram, moments, total, count)

    bounds = [*[AMPLITUDES] * inputs, *[FADES] * inputs, PENALTIES]
    options = {"maxiter": STEPS, "ftol": TOLERANCE / count}
    found = []
    for fade in FADES_FIRST:
        first = np.array([*[AMPLITUDE] * inputs, *[fade] * inputs, PENALTY])
        found.append(optimize.minimize(loss, first, jac=True, method="L-BFGS-B", bounds=bounds, options=options))
    best = min(found, key=lambda one: float(one.fun))
    return -float(best.fun), np.asarray(best.x)


def _loss(powers: Array, vector: Array, gram: Array, moments: Array, total: float, count: int) -> tuple[float, Array]:
    """Negative evidence and its gradient; the deviation of the scatter is that of most evidence."""
    factors, ridge = np.exp(powers @ vector[:-1]), count * np.exp(vector[-1])
    scaled = factors[:, None] * gram * factors
    scaled[np.diag_indices_from(scaled)] += ridge
    try:
        lower = linalg.cholesky(scaled, lower=True, check_finite=False)
    except linalg.LinAlgError:
        # The search steps back from parameters for which rounding makes the matrix indefinite.
        return REFUSED, np.zeros_like(vector)
    weighted = factors * moments
    slopes = linalg.cho_solve((lower, True), weighted, check_finite=False)
    unexplained = max(1.0 - float(weighted @ slopes) / total, 1e-12)
    value = 0.5 * (count - 1.0) * np.log(unexplained)
    value += np.log(np.diag(lower)).sum() - 0.5 * len(factors) * np.log(ridge)
    diagonal = np.diag(linalg.lapack.dpotri(lower, lower=1)[0])
    by_factor = 1.0 - ridge * diagonal - ridge * slopes**2 * (count - 1.0) / (unexplained * total)
    # The penalty is one over the square of a factor that all terms have.
    return float(value), np.append(powers.T @ by_factor, -0.5 * by_factor.sum())
