"""Location and scale: one ridge that walks from no inputs to a linear, a quadratic and, with many runs, a cubic law.

The linear terms of an orthonormal basis stand as they are, products and squares (and cubes) times a factor, under one
penalty; factor and penalty are those of the smallest leave-one-out error, in closed form from one singular value
decomposition. The result is a polynomial chaos expansion. Source: [Hoerl-1970] (ridge); [Allen-1974] (leave-one-out).
"""

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.polynomials import Array

SECOND_FACTORS = (0.0, 0.15, 0.4, 1.0)
THIRD_FACTORS = (0.0, 0.15, 0.4)
# Cubic terms of five inputs are 35: with fewer runs than this they are mostly noise.
CUBIC_FROM = 500
# Penalties in units of the number of runs: of a term of an orthonormal basis 1 / (1 + penalty) is left.
PENALTIES = (np.inf, *np.logspace(2.0, -3.5, 23))


@dataclass(frozen=True)
class Rung:
    """Where a law stands on the ladder: factors of second and third block, and the penalty (infinite: no inputs)."""

    second: float = 0.0
    third: float = 0.0
    penalty: float = float("inf")

    def factors(self, degrees: NDArray[np.int64]) -> Array:
        """Factor of each term, from its total degree [term_count]."""
        return np.array([0.0, 1.0, self.second, self.third])[degrees]


def highest_degree(run_count: int) -> int:
    """Total degree of the terms that a ladder looks at."""
    return 3 if run_count > CUBIC_FROM else 2


def best_rungs(matrix: Array, degrees: NDArray[np.int64], targets: Array) -> list[Rung]:
    """Rung of least leave-one-out error for each target [count, target_count].

    matrix: terms without the constant [count, term_count]; degrees: their total degrees [term_count].
    """
    count = len(matrix)
    least = np.full(targets.shape[1], np.inf)
    rungs = [Rung()] * targets.shape[1]
    centred = targets - targets.mean(axis=0)
    thirds = THIRD_FACTORS if degrees.max() > 2 else (0.0,)
    for second, third in product(SECOND_FACTORS if degrees.max() > 1 else (0.0,), thirds):
        scaled = matrix * Rung(second, third).factors(degrees)
        used = scaled[:, scaled.any(axis=0)]
        left, values, _ = np.linalg.svd(used - used.mean(axis=0), full_matrices=False)
        projected, squares = left.T @ centred, left**2
        for penalty in PENALTIES:
            kept = values**2 / (values**2 + penalty * count)
            residual = centred - left @ (kept[:, None] * projected)
            error = np.mean((residual / _room(1.0 - 1.0 / count - squares @ kept)[:, None]) ** 2, axis=0)
            for k in np.nonzero(error < least)[0]:
                least[k], rungs[k] = error[k], Rung(second, third, float(penalty))
    return rungs


def ridge(matrix: Array, degrees: NDArray[np.int64], target: Array, rung: Rung, weights: Array) -> tuple[Array, Array]:
    """Coefficients [1 + term_count], the constant first, and leave-one-out residuals [count] of one target [count].

    weights: how often each run counts [count]. The residual of a run leaves out one of its copies.
    """
    total = weights.sum()
    coefficients = np.zeros(1 + matrix.shape[1])
    mean = weights @ target / total
    coefficients[0] = mean
    if np.isinf(rung.penalty):
        return coefficients, (target - mean) / _room(1.0 - 1.0 / total)
    factors = rung.factors(degrees)
    scaled = (matrix * factors)[:, factors > 0.0]
    centre = weights @ scaled / total
    centred = scaled - centre
    normal = centred.T @ (weights[:, None] * centred) + rung.penalty * total * np.eye(centred.shape[1])
    solved = np.linalg.solve(normal, np.column_stack([centred.T @ (weights * (target - mean)), centred.T]))
    coefficients[1:][factors > 0.0] = factors[factors > 0.0] * solved[:, 0]
    coefficients[0] -= centre @ solved[:, 0]
    leverage = 1.0 / total + np.einsum("ij,ji->i", centred, solved[:, 1:])
    return coefficients, (target - mean - centred @ solved[:, 0]) / _room(1.0 - leverage)


def _room(one_minus_leverage: Array | float) -> Array:
    """What is left of 1 by a leverage; a run that its fit passes through has no residual to inflate."""
    return np.maximum(one_minus_leverage, 0.05)
