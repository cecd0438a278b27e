"""Bounds that no coordinate need know of: a law that was fitted without them does better, and hardly crosses them."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import special

from lithobrake.chaos.multi_index import Indices
from lithobrake.emulator.coordinates import with_slope
from lithobrake.emulator.law import best_choices, fit_law
from lithobrake.emulator.ridge_ladder import TermTable
from lithobrake.emulator.scores import folds_of, mean_by_groups
from lithobrake.emulator.training import TrainingRuns
from lithobrake.vocabulary.arrays import Array

# Of a normal law without bounds, the share that may lie beyond them.
MOST_BEYOND = 0.02
# Deviations of the scatter from the nearer bound.
DISTANT = 3.0
FOLDS = 5


def with_distant_bounds(runs: TrainingRuns, indices: Indices, matrix: Array) -> TrainingRuns:
    """The runs with the outputs named whose bounds bend no coordinate; matrix: terms [output_run_count, term_count].

    A logarithm or logit bends a law that may need no bound. Folds are left out: where a law of the output itself keeps
    the median run far from its bounds, puts next to nothing beyond them, and has a logarithmic score that is not worse
    by more than a standard error, its draws are only kept inside.
    """
    design, group = TermTable(indices, matrix, np.ones(len(matrix))), runs.group[runs.has_outputs]
    bounded = [k for k in runs.modelled if (np.isfinite(runs.lower[:, k]) | np.isfinite(runs.upper[:, k])).any()]
    return replace(runs, distant=tuple(k for k in bounded if _is_distant(runs, k, design, group)))


def _is_distant(runs: TrainingRuns, column: int, design: TermTable, group: NDArray[np.int64]) -> bool:
    y, lower, upper = (table[:, column] for table in (runs.y, runs.lower, runs.upper))
    coordinate, slope = with_slope(y, lower, upper)
    fold, (gain, beyond, away) = folds_of(group, FOLDS), np.empty((3, len(y)))
    for number in range(int(fold.max()) + 1):
        test = fold == number
        bent, straight = (_law(design, one, test) for one in (coordinate, y))
        scores = [_log_normal_density(one[test], *law) for one, law in ((coordinate, bent), (y, straight))]
        gain[test] = scores[1] - scores[0] - np.log(slope[test])
        location, scale = straight
        sides = np.array([location - lower[test], upper[test] - location]) / scale
        beyond[test], away[test] = special.ndtr(-sides).sum(axis=0), sides.min(axis=0)
    mean, error = mean_by_groups(gain, group)
    return bool(mean > -error and beyond.mean() < MOST_BEYOND and np.median(away) > DISTANT)


def _law(design: TermTable, coordinate: Array, test: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Location and scale of a coordinate [run_count] at runs that they have not seen, each [count]."""
    rest, kept = design.of(~test), coordinate[~test, None]
    location, scale = fit_law(rest, kept, best_choices(rest, kept, fades=False)).at(design.matrix[test])
    return location[:, 0], scale[:, 0]


def _log_normal_density(y: Array, location: Array, scale: Array) -> Array:
    return np.asarray(-0.5 * ((y - location) / scale) ** 2 - np.log(scale))
