"""What a law is worth on groups that it has not seen, by proper scores."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.emulator.training_runs import TrainingRuns
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.number_words import HIGH, LOW

BAND = (LOW, HIGH)


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
    # From ranks, so that the mean distance of members costs a sort and not all pairs of them.
    below = np.cumsum(sorted_weights, axis=1) - 0.5 * sorted_weights
    spread = (sorted_weights * sorted_values * (2.0 * below - 1.0)).sum(axis=1)
    return (weights * np.abs(values - observed[:, None])).sum(axis=1) - spread


def pit(values: Array, weights: Array, observed: Array) -> Array:
    """Probability integral transform [case_count]: the ensemble's chance of less than what was observed.

    Uniform between 0 and 1 where ensembles are right.
    """
    return (weights * ((values < observed[:, None]) + 0.5 * (values == observed[:, None]))).sum(axis=1)


@dataclass(frozen=True)
class Scores:
    """Scores on held-out groups, in coordinates divided by their spread; smaller is better.

    energy, energy_of_rows: mean energy scores of the law and of drawing rows alone. gain: their mean difference, and
    gain_error its standard error over groups; both are 0 where rows alone were chosen. crps_skill: 1 - CRPS / CRPS of
    rows alone, for each modelled output. band_90: share of runs inside the middle 90 % of what was foretold
    [modelled_count]. pit: where in its foretold distribution each run lay [output_run_count, modelled_count].
    """

    energy: float
    energy_of_rows: float
    gain: float
    gain_error: float
    crps_skill: Array
    band_90: Array
    pit: Array


# Runs that are left out [output_run_count], and coordinates [case_count, member_count, modelled_count] and weights
# [case_count, member_count] of what is foretold of them.
Ensembles = Iterable[tuple[NDArray[np.bool_], Array, Array]]


def scores_of(
    runs: TrainingRuns, ensembles: Ensembles, of_rows: Ensembles, energy: Array, energy_of_rows: Array
) -> Scores:
    """Scores of ensembles beside those of rows alone, with energy scores [output_run_count] of both."""
    gain, error = mean_by_groups(energy_of_rows - energy, runs.group[runs.has_outputs])
    losses, places = _calibration(runs, ensembles)
    worst = _calibration(runs, of_rows)[0].mean(axis=0)
    skill = 1.0 - losses.mean(axis=0) / np.where(worst > 0.0, worst, 1.0)
    held = ((places >= BAND[0]) & (places <= BAND[1])).mean(axis=0)
    # Of rows alone there is no gain, and no error of it.
    error = error if (energy != energy_of_rows).any() else 0.0
    return Scores(float(energy.mean()), float(energy_of_rows.mean()), gain, error, skill, held, places)


def _calibration(runs: TrainingRuns, ensembles: Ensembles) -> tuple[Array, Array]:
    """CRPS and PIT of each output of runs left out, [output_run_count, modelled_count]."""
    y = runs.y[:, list(runs.modelled)]
    losses, places = np.empty(y.shape), np.empty(y.shape)
    for test, values, weights in ensembles:
        members = runs.outputs_of(values, runs.lower[test][:, None], runs.upper[test][:, None])
        for j in range(y.shape[1]):
            losses[test, j] = crps(members[:, :, j], weights, y[test, j])
            places[test, j] = pit(members[:, :, j], weights, y[test, j])
    return losses, places
