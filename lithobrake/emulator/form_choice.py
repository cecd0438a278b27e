"""The form of a law, and what belongs to it, by the scores of groups that it has not seen."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.basis import Indices
from lithobrake.emulator.latent_variable import HeldOut, best_terms
from lithobrake.emulator.law import Choices, Law, best_choices, fit_law, kernels, row_weights, rows_alone
from lithobrake.emulator.ridge_ladder import TermTable
from lithobrake.emulator.stochastic_expansion import StochasticExpansion
from lithobrake.emulator.training_runs import TrainingRuns
from lithobrake.emulator.validation import (
    Ensembles,
    Scores,
    crps,
    energy_scores,
    folds_of,
    mean_by_groups,
    scores_of,
)
from lithobrake.vocabulary.array_types import Array

# Groups beyond this many are left out several at a time: the time grows with the folds, the answer hardly changes.
MOST_FOLDS = 12
# Rows of an ensemble whose mutual distances are taken; of more than this every second, third, ... one.
MOST_MEMBERS = 300


@dataclass(frozen=True)
class _Fold:
    """Runs that are left out, test [output_run_count], and what is fitted to the others: a law, and rows alone."""

    test: NDArray[np.bool_]
    law: Law
    rows: Law


@dataclass(frozen=True)
class Chosen:
    """What groups left out choose: how rows are drawn, terms of an expansion where that is the form, and scores."""

    choices: Choices
    expansion: HeldOut | None
    scores: Scores


def chosen_by_groups(runs: TrainingRuns, indices: Indices, matrix: Array, form: str | None) -> Chosen:
    """Choose a form and all that belongs to it, leaving groups out; matrix [output_run_count, term_count].

    form: "rows" or "expansion", as in `fit`; None: the expansion where its score is the better one. Each fold of rows
    is scored by a law and a kernel that are chosen without it, so that the gain is what fresh runs would show. Where no
    form gains more than its standard error, rows alone are chosen.
    """
    group, design = runs.group[runs.has_outputs], TermTable(indices, matrix, np.ones(len(matrix)))
    folds = _folds(runs, design, folds_of(group, MOST_FOLDS))
    tried = kernels(len(runs.inputs))
    # Each kernel draws rows about location and scale, and, further down, whole runs.
    energies = np.empty((2 * len(tried), len(group)))
    for fold in folds:
        energies[:, fold.test] = np.concatenate(
            [_energies(runs, matrix, fold, law, tried) for law in (fold.law, fold.rows)]
        )
    energy_of_rows, energy = energies[len(tried)], np.empty(len(group))
    ensembles = []
    for fold in folds:
        # The kernel is chosen without the fold that it is scored on, or its luck would count as gain.
        own = _best_kernel(energies[:, ~fold.test], group[~fold.test])
        energy[fold.test] = energies[own, fold.test]
        ensembles.append((fold, fold.rows if own >= len(tried) else fold.law, tried[own % len(tried)]))
    alone = choices = rows_alone(runs.coordinates.shape[1], len(runs.inputs))
    of_rows = [(fold, fold.rows, alone.widths) for fold in folds]
    if _gains(energy_of_rows - energy, group):
        best = _best_kernel(energies, group)
        choices = replace(
            alone if best >= len(tried) else best_choices(design, runs.coordinates), widths=tried[best % len(tried)]
        )
    expansion = best_terms(runs) if form != "rows" and runs.y.shape[1] == 1 else None
    if expansion is not None:
        losses = _energies_of_expansion(runs, expansion)
        better = losses.mean() < energy.mean() and _gains(energy_of_rows - losses, group)
        if form == "expansion" or (better and expansion.terms.follows_inputs):
            members = _members_of_expansion(runs, expansion)
            scores = scores_of(runs, members, _members(runs, matrix, of_rows), losses, energy_of_rows)
            return Chosen(choices, expansion, scores)
    if not choices.follows_inputs:
        energy, ensembles = energy_of_rows, of_rows
    members = _members(runs, matrix, ensembles)
    return Chosen(choices, None, scores_of(runs, members, _members(runs, matrix, of_rows), energy, energy_of_rows))


def _gains(gain: Array, group: NDArray[np.int64]) -> bool:
    """Whether gains [run_count] are more than their standard error."""
    mean, error = mean_by_groups(gain, group)
    return mean > error


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


def _members(runs: TrainingRuns, matrix: Array, folds: Sequence[tuple[_Fold, Law, Sequence[float]]]) -> Ensembles:
    """Ensembles of rows: a law for each fold, and the widths of its kernel."""
    inputs = len(runs.inputs)
    for fold, law, widths in folds:
        location, scale = law.at(matrix[fold.test])
        weights = row_weights(matrix[fold.test, :inputs], matrix[~fold.test, :inputs], law.weights, widths)
        yield fold.test, location[:, None] + scale[:, None] * law.rows, weights


def _members_of_expansion(runs: TrainingRuns, held_out: HeldOut) -> Ensembles:
    for test, law, points in _laws_of_expansion(runs, held_out):
        values, weights = law.members(points)
        yield test, values[:, :, None], weights


def _energies_of_expansion(runs: TrainingRuns, held_out: HeldOut) -> Array:
    """Energy scores [output_run_count] of runs left out, in units of the spread."""
    spread, energies = float(runs.coordinates.std()), np.empty(len(runs.y))
    for test, law, points in _laws_of_expansion(runs, held_out):
        energies[test] = law.normals(points).crps(runs.coordinates[test, 0]) / spread
    return energies


def _laws_of_expansion(
    runs: TrainingRuns, held_out: HeldOut
) -> Iterator[tuple[NDArray[np.bool_], StochasticExpansion, Array]]:
    """Runs left out [output_run_count], the law without them, and their points [case_count, input_count]."""
    points = runs.x[runs.has_outputs]
    for test, noise, parameters in held_out.folds:
        yield test, StochasticExpansion(held_out.terms, parameters, noise), points[test]
