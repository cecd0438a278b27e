"""What a law is worth on groups that it has not seen, beside drawing one of the runs whatever the inputs."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.polynomials import Array
from lithobrake.emulator.coordinates import from_coordinate
from lithobrake.emulator.law import Choices, best_choices, fit_law, rows_alone
from lithobrake.emulator.residual_rows import BANDWIDTHS, row_weights
from lithobrake.emulator.scores import crps, energy_scores, pit
from lithobrake.emulator.training import TrainingRuns

# Groups beyond this many are left out several at a time: the time grows with the folds, the answer hardly changes.
MOST_FOLDS = 24
# Rows of an ensemble whose mutual distances are taken; of more than this every second, third, ... one.
MOST_MEMBERS = 300
BAND = (0.05, 0.95)


@dataclass(frozen=True)
class Scores:
    """Of runs in groups left out, coordinates in units of their spread; the smaller a score, the better.

    energy, energy_of_rows: mean energy scores of the law and of drawing rows alone. gain: their mean difference, and
    gain_error its standard error over groups. crps_skill: 1 - CRPS / CRPS of rows alone, for each modelled output.
    band_90: share of runs inside the middle 90 % of what was foretold [modelled_count]. pit: where in its foretold
    distribution each run lay [output_run_count, modelled_count].
    """

    energy: float
    energy_of_rows: float
    gain: float
    gain_error: float
    crps_skill: Array
    band_90: Array
    pit: Array


@dataclass(frozen=True)
class _Ensembles:
    """Foretold distributions of the runs of one fold: members [case_count, member_count, coordinate_count]."""

    members: Array
    weights: Array


def folds_of(group: NDArray[np.int64], most: int) -> NDArray[np.int64]:
    """Fold of each run [run_count], whole groups together, numbered from 0."""
    numbers = np.unique(group, return_inverse=True)[1]
    # Neighbours in a sequence of runs fall into different folds.
    return np.asarray(numbers % min(most, int(numbers.max()) + 1), dtype=np.int64)


def choices_by_groups(runs: TrainingRuns, matrix: Array, degrees: NDArray[np.int64]) -> tuple[Choices, Scores]:
    """Choose law and width of the kernel, leaving groups out; matrix [output_run_count, term_count].

    Where the law does worse than rows alone by more than a standard error, rows alone are chosen.
    """
    group, fold = runs.group[runs.has_outputs], folds_of(runs.group[runs.has_outputs], MOST_FOLDS)
    spread = runs.coordinates.std(axis=0)
    unit = np.where(spread > 0.0, spread, 1.0)
    coordinates, count = runs.coordinates / unit, len(fold)
    energy, energy_of_rows = np.empty((len(BANDWIDTHS), count)), np.empty(count)
    for number in range(int(fold.max()) + 1):
        test, kept = fold == number, fold != number
        chosen = best_choices(matrix[kept], degrees, coordinates[kept])
        energy[:, test] = _energies(matrix, degrees, coordinates, test, chosen, BANDWIDTHS)
        alone = rows_alone(coordinates.shape[1])
        energy_of_rows[test] = _energies(matrix, degrees, coordinates, test, alone, BANDWIDTHS[:1])[0]
    best = int(np.argmin(energy.mean(axis=1)))
    gain, error = _mean_by_groups(energy_of_rows - energy[best], group)
    choices = replace(best_choices(matrix, degrees, coordinates), bandwidth=BANDWIDTHS[best])
    if gain < -error:
        choices, energy[best], gain, error = rows_alone(coordinates.shape[1]), energy_of_rows, 0.0, 0.0
    skill, held, places = _calibration(runs, matrix, degrees, fold, choices)
    return choices, Scores(float(energy[best].mean()), float(energy_of_rows.mean()), gain, error, skill, held, places)


def _energies(
    matrix: Array,
    degrees: NDArray[np.int64],
    coordinates: Array,
    test: NDArray[np.bool_],
    choices: Choices,
    bandwidths: tuple[float, ...],
) -> Array:
    """Energy scores [bandwidth_count, case_count] of the runs under test, fitted to all others."""
    inputs = int((degrees == 1).sum())
    law = fit_law(matrix[~test], degrees, coordinates[~test], choices, np.ones((~test).sum()))
    location, scale = law.at(matrix[test], inputs)
    thinned = slice(None, None, -(-len(law.rows) // MOST_MEMBERS))
    rows, points = law.rows[thinned], matrix[~test][thinned, :inputs]
    scores = []
    for bandwidth in bandwidths:
        weights = row_weights(matrix[test, :inputs], points, np.ones(len(rows)), bandwidth)
        scores.append(energy_scores(rows, weights, scale, coordinates[test] - location))
    return np.stack(scores)


def _calibration(
    runs: TrainingRuns, matrix: Array, degrees: NDArray[np.int64], fold: NDArray[np.int64], choices: Choices
) -> tuple[Array, Array, Array]:
    """CRPS skill and share in the 90 % band [modelled_count], and PIT [output_run_count, modelled_count]."""
    columns = list(runs.modelled)
    y, places = runs.y[:, columns], np.empty(runs.coordinates.shape)
    losses = np.empty((2, *y.shape))
    alone = rows_alone(len(columns))
    for number in range(int(fold.max()) + 1):
        test = fold == number
        for k, chosen in enumerate((choices, alone)):
            foretold = _foretold(runs, matrix, degrees, test, chosen)
            for j in range(len(columns)):
                losses[k, test, j] = crps(foretold.members[:, :, j], foretold.weights, y[test, j])
                if chosen is choices:
                    places[test, j] = pit(foretold.members[:, :, j], foretold.weights, y[test, j])
    losses_of_law, losses_of_rows = losses.mean(axis=1)
    skill = 1.0 - losses_of_law / np.where(losses_of_rows > 0.0, losses_of_rows, 1.0)
    return skill, ((places >= BAND[0]) & (places <= BAND[1])).mean(axis=0), places


def _foretold(
    runs: TrainingRuns, matrix: Array, degrees: NDArray[np.int64], test: NDArray[np.bool_], choices: Choices
) -> _Ensembles:
    """Foretold outputs of the runs under test, from all others."""
    inputs, columns = int((degrees == 1).sum()), list(runs.modelled)
    law = fit_law(matrix[~test], degrees, runs.coordinates[~test], choices, np.ones((~test).sum()))
    location, scale = law.at(matrix[test], inputs)
    members = location[:, None] + scale[:, None] * law.rows
    low, high = (bound[test][:, None, columns] for bound in (runs.lower, runs.upper))
    weights = row_weights(matrix[test, :inputs], matrix[~test, :inputs], law.weights, choices.bandwidth)
    return _Ensembles(from_coordinate(members, low, high), weights)


def _mean_by_groups(values: Array, group: NDArray[np.int64]) -> tuple[float, float]:
    """Mean of values [run_count] and its standard error, as groups and not runs are independent."""
    numbers = np.unique(group, return_inverse=True)[1]
    sums = np.bincount(numbers, weights=values - values.mean())
    count = len(sums)
    return float(values.mean()), float(np.sqrt(count / (count - 1.0) * (sums**2).sum()) / len(values))
