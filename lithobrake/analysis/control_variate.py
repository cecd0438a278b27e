"""What the inputs alone explain of a run, and what auxiliary runs say of chaos and soil."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.analysis.confidence import LEVEL, answers
from lithobrake.chaos.basis import basis_matrix, multi_index_set, points_of
from lithobrake.chaos.distributions import Distribution
from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.estimate import Estimate

# Beds are dealt to so many folds; more folds cost time and change nothing that was measured.
FOLD_COUNT = 10
# With fewer runs there is nothing to learn from.
FEWEST_RUNS = 20
# How much terms of second degree count beside linear ones, from not at all; the penalties of the ridge, over the runs.
SECOND_DEGREE = (0.0, 0.15, 0.4, 1.0)
PENALTIES = np.logspace(-3.0, 2.0, 22)
# So few squares miss the rare large ones, which carry much of the effect: their own scatter says too little of it.
# Measured on normal, Ishigami's and synthetic landings: bounds hold 0.83 to 0.93 with it, 0.76 to 0.86 without.
SKEWNESS_FACTOR = 1.5


def regression_terms(inputs: Mapping[str, Distribution], x: ArrayLike) -> tuple[Array, Labels]:
    """Terms of first and second degree at x [run_count, input_count], and the multi-index of each.

    An input of two values has no term of second degree of its own.

    Result: terms [run_count, term_count], indices [term_count, input_count]. Each term has mean 0 and variance 1 over
    the law of the inputs, so the mean over the law of any sum of them is 0, without sampling.
    Source: [Xiu-2002], section 3 (orthonormal polynomials of the Askey scheme).
    """
    indices = multi_index_set(len(inputs), 2)[1:]
    indices = indices[(indices <= [law.highest_degree for law in inputs.values()]).all(axis=1)]
    return basis_matrix(inputs, indices, points_of(inputs, x)), indices


def control_variate(terms: Array, degrees: Labels, y: Array, bed: Labels) -> Array:
    """What a ridge regression on the runs of other beds says of each run, less its mean over the law, [run_count].

    terms [run_count, term_count] of mean 0 over the law of the inputs, with their degrees (1 or 2); y [run_count], NaN
    where a run has no answer; bed [run_count], from 0. A run is never told by itself or its bed, so taking this off
    y leaves the mean over runs unbiased, however poor the regression.
    Source: [Chernozhukov-2018] (cross-fitting).
    """
    answered, told = np.isfinite(y), np.zeros(len(y))
    # On one bed the runs themselves are dealt out.
    fold = (bed if np.ptp(bed) > 0 else np.arange(len(y))) % FOLD_COUNT
    for number in np.unique(fold):
        own = fold == number
        others = answered & ~own
        if others.sum() >= FEWEST_RUNS:
            told[own] = terms[own] @ ridge(terms[others], degrees, y[others])
    return told


def control_factor(predicted: Array, y: Array, bed: Labels) -> Array:
    """How much of a prediction to take off each run, 0 to 1, by least squares on the runs of other beds, [run_count].

    predicted [run_count]: of each run by what has not seen its bed, less the mean over the law; y [run_count]; bed
    [run_count], from 0. Taking factor times prediction off y leaves the mean over runs unbiased.
    Source: [Chernozhukov-2018] (cross-fitting).
    """
    fold, factor = bed % FOLD_COUNT, np.zeros(len(y))
    for number in np.unique(fold):
        others = fold != number
        centred = predicted[others] - predicted[others].mean() if others.any() else predicted[others]
        square = float(centred @ centred)
        if others.sum() >= FEWEST_RUNS and square > 0.0:
            factor[~others] = min(max(float(centred @ y[others]) / square, 0.0), 1.0)
    return factor


def ridge(terms: Array, degrees: Labels, y: Array) -> Array:
    """Coefficients [term_count] of y [count] on terms [count, term_count]: from no inputs over linear to quadratic.

    The weight of the second degree and the penalty are those of the smallest leave-one-out error.
    Source: [Allen-1974] (leave one out); [Hoerl-1970] (ridge).
    """
    count, centred = len(y), y - y.mean()
    best, coefficients = np.inf, np.zeros(terms.shape[1])
    for weight in SECOND_DEGREE:
        scale = np.where(degrees == 1, 1.0, weight)
        used = scale > 0.0
        columns = (terms[:, used] - terms[:, used].mean(axis=0)) * scale[used]
        left, values, right = np.linalg.svd(columns, full_matrices=False)
        kept = values[:, None] ** 2 / (values[:, None] ** 2 + count * PENALTIES)
        fitted, leverage = left @ (kept * (left.T @ centred)[:, None]), left**2 @ kept
        errors = (((centred[:, None] - fitted) / (1.0 - 1.0 / count - leverage)) ** 2).mean(axis=0)
        chosen = int(np.argmin(errors))
        if errors[chosen] < best:
            best, coefficients = errors[chosen], np.zeros(terms.shape[1])
            share = np.divide(kept[:, chosen], values, out=np.zeros_like(values), where=values > 0.0)
            coefficients[used] = scale[used] * (right.T @ (share * (left.T @ centred)))
    return coefficients


def chaos_variance(differences: ArrayLike) -> Estimate:
    """Variance of an output due to chaos, from differences [pair_count] of runs 0.1 mm apart [unit of the output].

    Such runs differ in nothing that can be measured, so half the mean square of their difference is the variance.
    NaN: not known. Raises ValueError where no difference is known, or one is infinite.
    Source: [Searle-1992], section 3.5 (chi-square interval).
    """
    squares = _squares(differences)
    total, count = 0.5 * float(squares.sum()), len(squares)
    lower, upper = (total / float(special.chdtri(count, 0.5 - side * LEVEL)) for side in (0.5, -0.5))
    return Estimate(total / count, lower, upper)


def soil_total_effect(differences: ArrayLike, y: ArrayLike) -> Estimate:
    """Total effect of the soil as a share of an output's variance, interactions included.

    differences [pair_count] between two soils of their own on the same bed, place and attitude; y [run_count]: the
    output over the input distributions, NaN where a run has none. The interval is that of a chi-square number which
    scatters as the squares of both do. Few pairs may show more than the whole variance: value and bounds are cut at 1,
    and an interval that reaches from near 0 to 1 says that so many pairs cannot tell. Raises ValueError where fewer
    than two differences or runs are known, or all runs are alike.
    Source: [Jansen-1999]; [Searle-1992] (Satterthwaite's degrees of freedom).
    """
    halves, known = 0.5 * _squares(differences), answers("y", y)
    known = known[np.isfinite(known)]
    if len(halves) < 2 or len(known) < 2 or np.ptp(known) == 0.0:
        raise ValueError(f"{len(halves)} pairs and {len(known)} runs, or runs all alike; give two or more that differ")
    deviations = (known - known.mean()) ** 2
    effect = min(float(halves.mean() * len(known) / ((len(known) - 1) * deviations.mean())), 1.0)
    if effect == 0.0:
        return Estimate(0.0, 0.0, 0.0)
    error = sum(float(one.var(ddof=1) / (len(one) * one.mean() ** 2)) for one in (halves, deviations))
    freedom = 2.0 / (SKEWNESS_FACTOR * error)
    lower, upper = (effect * freedom / float(special.chdtri(freedom, 0.5 - side * LEVEL)) for side in (0.5, -0.5))
    return Estimate(effect, lower, min(upper, 1.0))


def _squares(differences: ArrayLike) -> Array:
    known = answers("differences", differences)
    known = known[np.isfinite(known)]
    if len(known) == 0:
        raise ValueError("no difference is known; give those of at least one pair in which both runs have the output")
    return known**2
