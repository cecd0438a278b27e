"""The one entry: from the runs of a stochastic model to an emulator of it."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.multi_index import Indices
from lithobrake.chaos.threads import one_thread
from lithobrake.emulator.distant_bounds import with_distant_bounds
from lithobrake.emulator.law import Choices, fit_law
from lithobrake.emulator.model import Emulator
from lithobrake.emulator.outcome_classes import ClassChoice, best_class_choice, fit_classes
from lithobrake.emulator.ridge_ladder import TermTable
from lithobrake.emulator.scores import folds_of
from lithobrake.emulator.terms import Terms, candidate_terms
from lithobrake.emulator.training import checked_runs
from lithobrake.emulator.validation import choices_by_groups

OUTCOME_FOLDS = 5
# A term of which a ridge leaves less than this is left out: it would cost time at every draw.
TRACE = 1e-3


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
    terms = candidate_terms(runs.inputs)
    matrix = terms.matrix(runs.x)
    runs = with_distant_bounds(runs, terms.indices, matrix[runs.has_outputs])
    choices, scores = choices_by_groups(runs, terms.indices, matrix[runs.has_outputs])
    fold, class_count = folds_of(runs.group, OUTCOME_FOLDS), len(runs.outcome_names)
    class_choice = best_class_choice(
        terms.indices, matrix, runs.outcome, runs.output_outcome, class_count, fold
    )  # fmt: skip
    used = used_terms(terms.indices, choices, class_choice)
    terms, matrix, ones = Terms(terms.inputs, terms.indices[used]), matrix[:, used], np.ones(len(runs.x))
    law = fit_law(TermTable(terms.indices, matrix[runs.has_outputs], ones[runs.has_outputs]), runs.coordinates, choices)
    factors = class_choice.factors(terms.indices)
    classes = fit_classes(matrix, factors, runs.outcome, class_count, class_choice.inverse_penalty, ones)
    return Emulator(runs, terms, choices, class_choice, ones, law, classes, scores)


def used_terms(indices: Indices, choices: Choices, class_choice: ClassChoice) -> NDArray[np.bool_]:
    """Which terms [term_count] any of the ladders leaves more than a trace of, and all linear ones."""
    used = (indices.sum(axis=1) == 1) | (class_choice.factors(indices) ** 2 > TRACE * class_choice.inverse_penalty)
    for rung in (rung for ladder in (*choices.location, *choices.scale) for rung in ladder):
        used |= rung.factors(indices) ** 2 > TRACE * rung.penalty
    return np.asarray(used)
