"""The one entry: from the runs of a stochastic model to an emulator, with the bounds that its coordinates need."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special

from lithobrake.chaos.basis import Indices
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.training_data import one_thread
from lithobrake.emulator.form_choice import chosen_by_groups
from lithobrake.emulator.law import Choices, ClassChoice, best_choices, best_class_choice, fit_classes, fit_law
from lithobrake.emulator.mean_law import Terms, candidate_terms
from lithobrake.emulator.model import Emulator
from lithobrake.emulator.ridge_ladder import TermTable
from lithobrake.emulator.stochastic_expansion import StochasticExpansion
from lithobrake.emulator.training_runs import TrainingRuns, checked_runs, with_slope
from lithobrake.emulator.validation import folds_of, mean_by_groups
from lithobrake.vocabulary.array_types import Array

# Of a normal law without bounds, the share that may lie beyond them.
MOST_BEYOND = 0.02
# Deviations of the scatter from the nearer bound.
DISTANT = 3.0
FOLDS = 5
OUTCOME_FOLDS = 5
# A term of which a ridge leaves less than this is left out: it would cost time at every draw.
TRACE = 1e-3


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
    fold = folds_of(group, FOLDS)
    location, scale = _held_out(design, y, fold)
    sides = np.array([location - lower, upper - location]) / scale
    # Most outputs end here, after half of the fits.
    if not (special.ndtr(-sides).sum(axis=0).mean() < MOST_BEYOND and np.median(sides.min(axis=0)) > DISTANT):
        return False
    coordinate, slope = with_slope(y, lower, upper)
    bent = _held_out(design, coordinate, fold)
    # Densities of the output and of its coordinate are compared in one unit, to which the slope leads.
    gain = _log_normal_density(y, location, scale) - _log_normal_density(coordinate, *bent) - np.log(slope)
    mean, error = mean_by_groups(gain, group)
    return bool(mean > -error)


def _held_out(design: TermTable, coordinate: Array, fold: NDArray[np.int64]) -> Array:
    """Location and scale of a coordinate [run_count] at each run, of fits that have not seen its fold, [2, count]."""
    found = np.empty((2, len(coordinate)))
    for number in range(int(fold.max()) + 1):
        found[:, fold == number] = _law(design, coordinate, fold == number)
    return found


def _law(design: TermTable, coordinate: Array, test: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Location and scale of a coordinate [run_count] at runs that they have not seen, each [count]."""
    rest, kept = design.of(~test), coordinate[~test, None]
    location, scale = fit_law(rest, kept, best_choices(rest, kept, fades=False)).at(design.matrix[test])
    return location[:, 0], scale[:, 0]


def _log_normal_density(y: Array, location: Array, scale: Array) -> Array:
    return np.asarray(-0.5 * ((y - location) / scale) ** 2 - np.log(scale))


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
    form: str | None = None,
) -> Emulator:
    """Fit the distribution of outputs at given inputs to runs, drawn from the law of the inputs.

    Of these forms that of the best score on groups left out is chosen, and `Emulator.statement` says which:
    rows about a location and a scale that follow the inputs; whole runs, the nearer the likelier; a stochastic
    expansion in a latent variable, of one output without riders, whose draws come from no run; and any run, where no
    form beats it by more than a standard error.

    x: [run_count, input_count] in physical units.
    y: [run_count, output_count]; a row of NaN where the outcome has no outputs.
    groups: what runs share beside their inputs (the bed, the batch), [run_count]; they are left out, and drawn in
        refits, together. None makes each run its own.
    outcome: label of each run [run_count]; None tells runs with outputs from those without.
    lower, upper: bounds that outputs never reach: a number, one for each output, or one for each run and output;
        -inf, inf or None for none. One that follows the inputs has to be given to `sample` too.
    riders: outputs that are drawn with their row unchanged, as columns or names: directions, times.
    outcomes: all outcomes there may be, where some may not have happened.
    form: "rows" leaves the expansion out, and "expansion" takes it whatever its score; None chooses.
    Raises ValueError for shapes, values and labels that do not fit together.
    """
    runs = checked_runs(inputs, x, y, groups, outcome, outcomes, lower, upper, riders, output_names)
    _check_form(form, runs)
    terms = candidate_terms(runs.inputs)
    matrix = terms.matrix(runs.x)
    runs = with_distant_bounds(runs, terms.indices, matrix[runs.has_outputs])
    chosen = chosen_by_groups(runs, terms.indices, matrix[runs.has_outputs], form)
    choices = chosen.choices
    fold, class_count = folds_of(runs.group, OUTCOME_FOLDS), len(runs.outcome_names)
    class_choice = best_class_choice(
        terms.indices, matrix, runs.outcome, runs.output_outcome, class_count, fold
    )  # fmt: skip
    used = used_terms(terms.indices, choices, class_choice)
    terms, matrix, ones = Terms(terms.inputs, terms.indices[used]), matrix[:, used], np.ones(len(runs.x))
    law = fit_law(TermTable(terms.indices, matrix[runs.has_outputs], ones[runs.has_outputs]), runs.coordinates, choices)
    factors = class_choice.factors(terms.indices)
    classes = fit_classes(matrix, factors, runs.outcome, class_count, class_choice.inverse_penalty, ones)
    if form == "expansion" and chosen.expansion is None:
        raise ValueError("y does not scatter about its mean, so it has no expansion: leave form out")
    expansion = None if chosen.expansion is None else StochasticExpansion.of_runs(runs, chosen.expansion)
    return Emulator(runs, terms, choices, class_choice, ones, law, classes, chosen.scores, expansion)


def _check_form(form: str | None, runs: TrainingRuns) -> None:
    if form not in (None, "rows", "expansion"):
        raise ValueError(f"form is {form!r}; allowed: rows, expansion, or None to choose")
    if form == "expansion" and runs.y.shape[1] > 1:
        raise ValueError(
            f"form is 'expansion', which has one output and no riders, but outputs are {', '.join(runs.output_names)}: "
            "fit each output apart, or leave form out"
        )


def used_terms(indices: Indices, choices: Choices, class_choice: ClassChoice) -> NDArray[np.bool_]:
    """Which terms [term_count] any of the ladders leaves more than a trace of, and all linear ones."""
    # Linear terms always stay: they come first, and are the standardised inputs by which rows are drawn.
    used = (indices.sum(axis=1) == 1) | (class_choice.factors(indices) ** 2 > TRACE * class_choice.inverse_penalty)
    for rung in (rung for ladder in (*choices.location, *choices.scale) for rung in ladder):
        used |= rung.factors(indices) ** 2 > TRACE * rung.penalty
    return np.asarray(used)
