"""What a law is worth on groups that it has not seen, by proper scores."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.basis import Indices
from lithobrake.emulator.law import Choices, Law, best_choices, fit_law, kernels, row_weights, rows_alone
from lithobrake.emulator.ridge_ladder import TermTable
from lithobrake.emulator.training_runs import TrainingRuns
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.number_words import HIGH, LOW

# Groups beyond this many are left out several at a time: the time grows with the folds, the answer hardly changes.
MOST_FOLDS = 12
# Rows of an ensemble whose mutual distances are taken; of more than this every second, third, ... one.
MOST_MEMBERS = 300
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
    """Of runs in groups left out, coordinates in units of their spread; the smaller a score, the better.

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


@dataclass(frozen=True)
class _Fold:
    """Runs that are left out, test [output_run_count], and what is fitted to the others: a law, and rows alone."""

    test: NDArray[np.bool_]
    law: Law
    rows: Law


def choices_by_groups(runs: TrainingRuns, indices: Indices, matrix: Array) -> tuple[Choices, Scores]:
    """Choose law and kernel, leaving groups out; matrix [output_run_count, term_count].

    Each fold is scored by a law and a kernel that are chosen without it, so that the gain is what fresh runs would
    show. Where it is not more than its standard error, rows alone are chosen.
    """
    group, design = runs.group[runs.has_outputs], TermTable(indices, matrix, np.ones(len(matrix)))
    folds = _folds(runs, design, folds_of(group, MOST_FOLDS))
    tried = kernels(len(runs.inputs))
    energies, energy_of_rows = np.empty((len(tried), len(group))), np.empty(len(group))
    for fold in folds:
        energies[:, fold.test] = _energies(runs, matrix, fold, fold.law, tried)
        energy_of_rows[fold.test] = _energies(runs, matrix, fold, fold.rows, tried[:1])[0]
    energy, widths = np.empty(len(group)), []
    for fold in folds:
        # The kernel is chosen without the fold that it is scored on, or its luck would count as gain.
        own = _best_kernel(energies[:, ~fold.test], group[~fold.test])
        energy[fold.test] = energies[own, fold.test]
        widths.append(tried[own])
    gain, error = mean_by_groups(energy_of_rows - energy, group)
    choices = rows_alone(runs.coordinates.shape[1], len(runs.inputs))
    if gain > error:
        choices = replace(best_choices(design, runs.coordinates), widths=tried[_best_kernel(energies, group)])
    else:
        energy, gain, error, widths = energy_of_rows, 0.0, 0.0, [choices.widths] * len(folds)
        folds = [replace(fold, law=fold.rows) for fold in folds]
    skill, held, places = _calibration(runs, matrix, folds, widths)
    return choices, Scores(float(energy.mean()), float(energy_of_rows.mean()), gain, error, skill, held, places)


def _best_kernel(energies: Array, group: NDArray[np.int64]) -> int:
    """The kernel of least energy [kernel_count, run_count], if it beats the first, none, by a standard error."""
    best = int(np.argmin(energies.mean(axis=1)))
    gain, error = mean_by_groups(energies[0] - energies[best], group)
    return best if gain > error else 0


def _folds(runs: TrainingRuns, design: TermTable, fold: NDArray[np.int64]) -> list[_Fold]:
    """Fit anew without each fold, and choose anew too: a choice must not have seen what it is tested on."""
    folds = []
    for number in range(int(fold.max()) + 1):
        test = fold == number
        rest, kept = design.of(~test), runs.coordinates[~test]
        laws = [
            fit_law(rest, kept, choices)
            for choices in (best_choices(rest, kept), rows_alone(kept.shape[1], len(runs.inputs)))
        ]
        folds.append(_Fold(test, laws[0], laws[1]))
    return folds


def _energies(runs: TrainingRuns, matrix: Array, fold: _Fold, law: Law, tried: Sequence[Sequence[float]]) -> Array:
    """Energy scores [kernel_count, case_count] of the runs that a law has not seen, in units of the spread."""
    spread = runs.coordinates.std(axis=0)
    unit = np.where(spread > 0.0, spread, 1.0)
    location, scale = law.at(matrix[fold.test])
    observed = (runs.coordinates[fold.test] - location) / unit
    inputs = len(runs.inputs)
    # Of one output the score costs no mutual distances.
    thinned = slice(None, None, 1 if scale.shape[1] == 1 else -(-len(law.rows) // MOST_MEMBERS))
    rows, points = law.rows[thinned], matrix[~fold.test][thinned, :inputs]
    weights = [row_weights(matrix[fold.test, :inputs], points, np.ones(len(rows)), one) for one in tried]
    if scale.shape[1] == 1:
        return np.stack([crps(scale / unit * rows[:, 0], one, observed[:, 0]) for one in weights])
    return energy_scores(rows, np.stack(weights), scale / unit, observed)


def _calibration(
    runs: TrainingRuns, matrix: Array, folds: Sequence[_Fold], widths: Sequence[Sequence[float]]
) -> tuple[Array, Array, Array]:
    """CRPS skill and share in the 90 % band [modelled_count], and PIT [output_run_count, modelled_count].

    widths: of the kernel of each fold.
    """
    columns, inputs = list(runs.modelled), len(runs.inputs)
    y, places = runs.y[:, columns], np.empty(runs.coordinates.shape)
    losses, losses_of_rows = np.empty(y.shape), np.empty(y.shape)
    alike = rows_alone(len(columns), inputs).widths
    for fold, own in zip(folds, widths, strict=True):
        test, law = fold.test, fold.law
        points, others = matrix[test, :inputs], matrix[~test, :inputs]
        weights, equal = (row_weights(points, others, law.weights, one) for one in (own, alike))
        members, members_of_rows = (_members(runs, matrix, test, one) for one in (law, fold.rows))
        for j in range(len(columns)):
            losses[test, j] = crps(members[:, :, j], weights, y[test, j])
            losses_of_rows[test, j] = crps(members_of_rows[:, :, j], equal, y[test, j])
            places[test, j] = pit(members[:, :, j], weights, y[test, j])
    worst = losses_of_rows.mean(axis=0)
    skill = 1.0 - losses.mean(axis=0) / np.where(worst > 0.0, worst, 1.0)
    return skill, ((places >= BAND[0]) & (places <= BAND[1])).mean(axis=0), places


def _members(runs: TrainingRuns, matrix: Array, test: NDArray[np.bool_], law: Law) -> Array:
    """Outputs that each row of a law gives at the runs under test, [case_count, row_count, modelled_count]."""
    location, scale = law.at(matrix[test])
    return runs.outputs_of(
        location[:, None] + scale[:, None] * law.rows, runs.lower[test][:, None], runs.upper[test][:, None]
    )
