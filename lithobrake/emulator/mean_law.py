"""Mean law E[y | x] as an expansion: how much of the variance it has, and which inputs, freed of noise.

Squares of coefficients hold their noise too: the square of each standard error is taken off. A ridge would shrink
them, so they are fitted by least squares, to the terms up to the degree that the ladder stands on.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lithobrake.emulator.ridge_ladder import Ladder, Terms, degree_of
from lithobrake.vocabulary.arrays import Array

# Least squares with fewer runs to a term has standard errors that are themselves hardly known.
RUNS_PER_TERM = 4


@dataclass(frozen=True)
class MeanLaw:
    """mean [output_count] of the output; variance [output_count] of E[y | x] over the inputs, and share, what that is
    of the variance of the output. sobol_first, sobol_total [input_count, output_count]: shares of the variance of
    E[y | x]; 0 where there is none.
    """

    mean: Array
    variance: Array
    share: Array
    sobol_first: Array
    sobol_total: Array


def mean_law(terms: Terms, matrix: Array, target: Array, ladders: Sequence[Ladder], weights: Array) -> MeanLaw:
    """Fit the mean law of targets [run_count, output_count] with these ladders [output_count].

    matrix: terms [run_count, term_count]; weights: how often each run counts [run_count].
    """
    columns = [
        _one_output(terms, matrix, y, _degree(ladder, terms, weights), weights)
        for y, ladder in zip(target.T, ladders, strict=True)
    ]
    mean, variance, share, first, total = zip(*columns, strict=True)
    return MeanLaw(np.array(mean), np.array(variance), np.array(share), np.column_stack(first), np.column_stack(total))


def _degree(ladder: Ladder, terms: Terms, weights: Array) -> int:
    """Highest degree of the terms that a ladder stands on and the runs support."""
    wanted = degree_of(ladder)
    supported = [d for d in range(1, wanted + 1) if RUNS_PER_TERM * (terms.degrees <= d).sum() <= weights.sum()]
    return max(supported, default=1)


def _one_output(
    terms: Terms, matrix: Array, y: Array, degree: int, weights: Array
) -> tuple[float, float, float, Array, Array]:
    """Mean, variance, share, first-order and total indices [input_count] of one output [run_count]."""
    used = terms.degrees <= degree
    indices = terms.indices[used]
    squares, mean = noise_freed_squares(matrix[:, used], y, weights)
    variance = max(0.0, float(squares.sum()))
    spread = float(weights @ (y - weights @ y / weights.sum()) ** 2 / weights.sum())
    active = indices > 0
    alone = active & (active.sum(axis=1) == 1)[:, None]
    shares = [np.clip(group.T @ squares, 0.0, None) for group in (alone.astype(float), active.astype(float))]
    scaled = [np.minimum(share / variance, 1.0) if variance > 0.0 else 0.0 * share for share in shares]
    return mean, variance, variance / spread if spread > 0.0 else 0.0, scaled[0], scaled[1]


def noise_freed_squares(matrix: Array, y: Array, weights: Array) -> tuple[Array, float]:
    """Squares of least-squares coefficients less their variances [term_count], and the constant.

    The variances hold whatever the scatter does with the inputs. Source: [MacKinnon-1985], HC2.
    """
    full = np.column_stack([np.ones(len(matrix)), matrix])
    inverse = np.linalg.pinv(full.T @ (weights[:, None] * full))
    coefficients = inverse @ (full.T @ (weights * y))
    influence = full @ inverse
    leverage = np.minimum((influence * full).sum(axis=1), 0.95)
    residual = (y - full @ coefficients) ** 2 / (1.0 - leverage)
    variances = (weights * residual) @ influence**2
    return (coefficients**2 - variances)[1:], float(coefficients[0])
