"""Scores of what was foretold, the smaller the better, and of groups that are left out together."""

import numpy as np
from numpy.typing import NDArray

from lithobrake.vocabulary.arrays import Array


def folds_of(group: NDArray[np.int64], most: int) -> NDArray[np.int64]:
    """Fold of each run [run_count], whole groups together, numbered from 0."""
    numbers = np.unique(group, return_inverse=True)[1]
    # Neighbours in a sequence of runs fall into different folds.
    return np.asarray(numbers % min(most, int(numbers.max()) + 1), dtype=np.int64)


def mean_by_groups(values: Array, group: NDArray[np.int64]) -> tuple[float, float]:
    """Mean of values [run_count] and its standard error, as groups and not runs are independent; infinite for one."""
    numbers = np.unique(group, return_inverse=True)[1]
    sums = np.bincount(numbers, weights=values - values.mean())
    count = len(sums)
    if count == 1:
        return float(values.mean()), np.inf
    return float(values.mean()), float(np.sqrt(count / (count - 1.0) * (sums**2).sum()) / len(values))


def energy_scores(points: Array, weights: Array, scales: Array, observed: Array) -> Array:
    """Energy score of ensembles that share their members, [weighting_count, case_count]; the smaller, the better.

    points [member_count, output_count], which case i stretches by scales [case_count, output_count]; weights
    [weighting_count, case_count, member_count] sum to 1; observed [case_count, output_count], from the ensemble's
    location. Source: [Gneiting-2007], Eq 22.
    """
    squares = (points[:, None] - points) ** 2
    scores = np.empty(weights.shape[:2])
    for case, (scale, seen) in enumerate(zip(scales, observed, strict=True)):
        weight = weights[:, case]
        distances = np.sqrt(((seen - scale * points) ** 2).sum(axis=1))
        spread = np.sqrt(squares @ scale**2)
        scores[:, case] = weight @ distances - 0.5 * ((weight @ spread) * weight).sum(axis=1)
    return scores


def crps(values: Array, weights: Array, observed: Array) -> Array:
    """Continuous ranked probability score of ensembles, [case_count]: values, weights [case_count, member_count].

    Source: [Gneiting-2007], Eq 21.
    """
    order = np.argsort(values, axis=1)
    sorted_values, sorted_weights = (
        np.take_along_axis(values, order, axis=1),
        np.take_along_axis(weights, order, axis=1),
    )
    below = np.cumsum(sorted_weights, axis=1) - 0.5 * sorted_weights
    spread = (sorted_weights * sorted_values * (2.0 * below - 1.0)).sum(axis=1)
    return (weights * np.abs(values - observed[:, None])).sum(axis=1) - spread


def pit(values: Array, weights: Array, observed: Array) -> Array:
    """Probability integral transform [case_count]: the ensemble's chance of less than what was observed.

    Uniform between 0 and 1 where ensembles are right.
    """
    return (weights * ((values < observed[:, None]) + 0.5 * (values == observed[:, None]))).sum(axis=1)
