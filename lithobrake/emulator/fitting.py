"""The one entry: from the runs of a stochastic model to an emulator of it."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.threads import one_thread
from lithobrake.emulator.law import fit_law
from lithobrake.emulator.model import Emulator
from lithobrake.emulator.outcome_classes import best_inverse_penalty, fit_classes
from lithobrake.emulator.ridge_ladder import highest_degree, terms_up_to
from lithobrake.emulator.training import checked_runs
from lithobrake.emulator.validation import choices_by_groups, folds_of

OUTCOME_FOLDS = 5


@one_thread()
def fit(
    inputs: Mapping[str, Distribution],
    x: ArrayLike,
    y: ArrayLike,
    *,
    groups: ArrayLike | None = None,
    outcome: ArrayLike | None = None,
    lower: ArrayLike | None = None,
    upper: ArrayLike | None = None,
    riders: Sequence[int | str] = (),
    outcomes: Sequence[str] | None = None,
    output_names: Sequence[str] | None = None,
) -> Emulator:
    """Fit the distribution of outputs at given inputs to runs, drawn from the law of the inputs.

    x: [run_count, input_count] in physical units.
    y: [run_count, output_count]; a row of NaN where the outcome has no outputs.
    groups: what runs share beside their inputs (the bed, the batch), [run_count]; they are left out, and drawn in
        refits, together. None makes each run its own.
    outcome: label of each run [run_count]; None tells runs with outputs from those without.
    lower, upper: bounds that outputs never reach: a number, one for each output, or one for each run and output;
        -inf, inf or None for none. One that follows the inputs has to be given to `sample` too.
    riders: outputs that are drawn with their row unchanged, as columns or names: directions, times.
    outcomes: all outcomes there may be, where some may not have happened.
    Raises ValueError for shapes, values and labels that do not fit together.
    """
    runs = checked_runs(inputs, x, y, groups, outcome, outcomes, lower, upper, riders, output_names)
    terms = terms_up_to(runs.inputs, highest_degree(len(runs.y), len(runs.inputs)))
    matrix = terms.matrix(runs.x)
    of_outputs = matrix[runs.has_outputs]
    choices, scores = choices_by_groups(runs, terms.indices, of_outputs)
    law = fit_law(terms.indices, of_outputs, runs.coordinates, choices, np.ones(len(runs.y)))
    linear, class_count = matrix[:, : len(runs.inputs)], len(runs.outcome_names)
    fold = folds_of(runs.group, OUTCOME_FOLDS)
    inverse_penalty = best_inverse_penalty(linear, runs.outcome, class_count, fold)
    ones = np.ones(len(runs.x))
    classes = fit_classes(linear, runs.outcome, class_count, inverse_penalty, ones)
    return Emulator(runs, terms, choices, inverse_penalty, ones, law, classes, scores)
