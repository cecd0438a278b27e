"""Mean law E[y | x] as an expansion: how much of the variance it has, and which inputs, freed of noise.

Squares of coefficients hold their noise too: the square of each standard error is taken off. A ridge would shrink
them, so they are fitted by least squares, to the terms up to the degree that the ladder stands on.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.counts import term_count
from lithobrake.emulator.ridge_ladder import Ladder
from lithobrake.emulator.terms import Terms, terms_up_to
from lithobrake.vocabulary.arrays import Array

# Least squares with fewer runs to a term has standard errors that are themselves hardly known.
RUNS_PER_TERM = 4
HIGHEST_DEGREE = 5


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


def mean_law(
    inputs: Mapping[str, Distribution], x: Array, target: Array, ladders: Sequence[Ladder], weights: Array
) -> MeanLaw:
    """Fit the mean law of targets [run_count, output_count] with these ladders [output_count].

    x: [run_count, input_count] in physical units; weights: how often each run counts [run_count].
    """
    terms = terms_up_to(inputs, max(_degree(ladder, len(inputs), weights) for ladder in ladders))
    matrix = terms.matrix(x)
    columns = [
        _one_output(terms, matrix, y, _degree(ladder, len(inputs), weights), weights)
        for y, ladder in zip(target.T, ladders, strict=True)
    ]
    mean, variance, share, first, total = zip(*columns, strict=True)
    return MeanLaw(np.array(mean), np.array(variance), np.array(share), np.column_stack(first), np.column_stack(total))


def _degree(ladder: Ladder, input_count: int, weights: Array) -> int:
    """Highest degree that most of a ladder's weight stands on and the runs support, at least 1."""
    degrees = [d for d in range(2, HIGHEST_DEGREE + 1) if sum(one.weight for one in ladder if one.degree >= d) > 0.5]
    runs = RUNS_PER_TERM * np.array([term_count(input_count, d) - 1 for d in degrees])
    return max([d for d, needed in zip(degrees, runs, strict=True) if needed <= weights.sum()], default=1)


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
