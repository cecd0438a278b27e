"""Which inputs change the outputs at all: one test for all of them together, by permutation.

Inputs and outputs are paired anew many times, which is what no effect looks like, however outputs scatter and however
runs of a group hang together, as long as inputs were drawn without regard to the groups. The largest statistic over all
inputs and outputs of each permutation gives one limit for all. Source: [Westfall-1993] (largest statistic).
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.emulator.mean_law import RUNS_PER_TERM
from lithobrake.emulator.terms import Terms, terms_up_to
from lithobrake.vocabulary.arrays import Array
from lithobrake.vocabulary.given_numbers import finite_number, random_numbers

PERMUTATIONS = 399


def found_inputs(
    inputs: Mapping[str, Distribution], x: Array, targets: Array, level: float, seed: int
) -> NDArray[np.bool_]:
    """Say for each input [input_count] whether it changes the mean of any target [run_count, target_count].

    x: [run_count, input_count] in physical units. level: chance that no input is found where none has an effect.
    """
    terms = terms_up_to(inputs, 2)
    matrix = terms.matrix(x)
    finite_number("level", level, above=0.0, below=1.0)
    random = random_numbers(seed)
    varying = targets[:, np.ptp(targets, axis=0) > 0.0]
    if varying.shape[1] == 0:
        return np.zeros(len(terms.inputs), dtype=bool)
    orders = [random.permutation(len(targets)) for _ in range(PERMUTATIONS)]
    # All permutations are columns of one table: the terms, and so their factorisation, stay the same.
    table = np.concatenate([varying, *(varying[order] for order in orders)], axis=1)
    evidence = _evidence(terms, matrix, table).reshape(len(terms.inputs), 1 + PERMUTATIONS, -1).max(axis=2)
    limit = np.quantile(evidence[:, 1:].max(axis=0), level, method="higher")
    return np.asarray(evidence[:, 0] > limit)


def _evidence(terms: Terms, matrix: Array, table: Array) -> Array:
    """Evidence for each input and column, [input_count, column_count]: the larger of that of its linear term and that
    of all its terms up to the second degree, as the negative logarithm of the chance of as large an F by luck.
    """
    degrees = [1, 2] if RUNS_PER_TERM * (terms.degrees <= 2).sum() <= len(matrix) else [1]
    centred = table - table.mean(axis=0)
    evidence = np.full((len(terms.inputs), table.shape[1]), -np.inf)
    for degree in degrees:
        used = terms.degrees <= degree
        columns, active = matrix[:, used] - matrix[:, used].mean(axis=0), terms.indices[used] > 0
        left = _unexplained(columns, centred)
        freedom = len(matrix) - 1 - columns.shape[1]
        for k in range(len(terms.inputs)):
            without = _unexplained(columns[:, ~active[:, k]], centred)
            count = int(active[:, k].sum())
            # What rounding leaves of outputs without scatter is no scatter.
            ratio = (without - left) / count / (np.maximum(left, 1e-12 * (centred**2).sum(axis=0)) / freedom)
            evidence[k] = np.maximum(evidence[k], -stats.f.logsf(ratio, count, freedom))
    return evidence


def _unexplained(columns: Array, table: Array) -> Array:
    """Sum of squares of each column of a table that least squares on these columns leaves."""
    basis = np.linalg.qr(columns)[0]
    return (table**2).sum(axis=0) - ((basis.T @ table) ** 2).sum(axis=0)
