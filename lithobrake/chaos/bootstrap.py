"""Confidence intervals by resampling: of Sobol indices from the residuals, of scores from the test runs."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.chaos.basis import Indices, basis_matrix
from lithobrake.chaos.degree_selection import best_terms, with_low_degrees
from lithobrake.chaos.gaussian_process import FAMILIES, fit_process
from lithobrake.chaos.scores import absolute_percentage_error
from lithobrake.chaos.sobol_indices import first_order, total_order
from lithobrake.chaos.surrogate import Surrogate
from lithobrake.chaos.training_data import Training, checked_training, one_thread
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import finite_number, random_numbers, sample_count, whole_number
from lithobrake.vocabulary.number_words import EXPANSION_LEVEL

# With more terms for each point than this the residuals say too little about the error.
TERMS_PER_POINT = 0.7
SMALLEST_FREEDOM = 0.05
# Above this share of scatter in the variance a process has settled what matters too firmly to be drawn from.
SCATTER_SHARE = 0.05
# Fewer test runs than this, drawn anew, repeat each other too often to tell a spread.
FEWEST_TEST_RUNS = 5
# Runs that are drawn at a time: more at a time are not faster.
BLOCK = 20_000


@dataclass(frozen=True)
class Refit:
    """A fit of one output that can be made again, and where draws of its runs come from.

    indices [term_count, input_count]; coefficients: of outputs [count, draw_count], result [term_count, draw_count].
    observed [count]: the outputs of the runs; fitted [count]: those that draws scatter about; truth [2, input_count]:
    first-order and total indices of what gave them; residuals [count], as large as errors at new points; shrinks:
    whether the fit pulls coefficients to 0.
    """

    indices: Indices
    coefficients: Callable[[Array], Array]
    observed: Array
    fitted: Array
    truth: Array
    residuals: Array
    shrinks: bool = False


@one_thread()
def sobol_estimates(
    surrogate: Surrogate, x: ArrayLike, y: ArrayLike, *, count: int = 500, level: float = EXPANSION_LEVEL, seed: int = 0
) -> dict[str, Any]:
    """Sobol indices, bias-corrected for scatter of the training runs x, y, with residual-bootstrap intervals.

    Result: "first" and "total", each [3 (estimate, lower, upper), input_count, output_count] (last axis dropped for a
    one-dimensional y): shares of the variance that the inputs give the expansion. An expansion's own indices are sums
    of squared coefficients, to which scatter adds: the less an output depends on its inputs, the more they say.
    Draws are fitted again: least squares with its terms, a sparse fit by least squares on its terms
    and all of low degree, a process with its parameters or, where scatter is more than a twentieth of the variance, by
    least squares on all terms of low degree: parameters learnt from much scatter rule out inputs that may matter.
    Rows of residuals are drawn jointly for all outputs and are as large as the error at new points, so that they hold
    what the fit left out. Intervals take the runs as independent: they hold for the bed and place of these runs.
    Source: [Davison-1997], sections 5.2 and 6.2; [Dubreuil-2014] (indices from expansions).
    """
    _check_resampling(count, level)
    training, rows = _drawn_runs(surrogate, x, y, count, seed)
    own, found = _indices_of(surrogate.multi_indices, surrogate.coefficient_table), []
    for output in range(len(surrogate.output_names)):
        if np.ptp(training.y[:, output]) == 0.0:
            found.append(np.stack([own[..., output]] * 3))
            continue
        refit = _refit_of(surrogate, training, output)
        coefficients = refit.coefficients(refit.fitted[:, None] + refit.residuals[rows].T)
        estimate, low, high = (_basic if refit.shrinks else _debiased)(refit, coefficients, level)
        # Distances that are turned round may miss the estimate, and leave the range of a share.
        found.append(np.clip([estimate, np.minimum(low, estimate), np.maximum(high, estimate)], 0.0, 1.0))
    table = np.stack(found, axis=-1)
    return {"first": surrogate.shaped(table[:, 0]), "total": surrogate.shaped(table[:, 1])}


@one_thread()
def coefficient_changes(
    surrogate: Surrogate, x: ArrayLike, y: ArrayLike, *, count: int, seed: int = 0
) -> tuple[Indices, Array]:
    """Changes of the coefficients when the residuals of the training runs x, y are resampled.

    Result: multi_indices [term_count, input_count], and changes [count, term_count, output_count] as `sobol_estimates`
    fits its draws; 0 for an output that does not vary.
    """
    training, rows = _drawn_runs(surrogate, x, y, count, seed)
    varying = np.flatnonzero(np.ptp(training.y, axis=0) > 0.0).tolist()
    refits = {output: _refit_of(surrogate, training, output) for output in varying}
    indices = np.unique(np.concatenate([surrogate.multi_indices, *(one.indices for one in refits.values())]), axis=0)
    place = {tuple(index): row for row, index in enumerate(indices.tolist())}
    changes = np.zeros((count, len(indices), training.y.shape[1]))
    for output, refit in refits.items():
        # A fit is linear in its outputs, so the change is the fit of the drawn residuals alone.
        own = [place[tuple(index)] for index in refit.indices.tolist()]
        changes[:, own, output] = refit.coefficients(refit.residuals[rows].T).T
    return indices, changes


def sobol_intervals(
    surrogate: Surrogate, x: ArrayLike, y: ArrayLike, *, count: int = 500, level: float = EXPANSION_LEVEL, seed: int = 0
) -> dict[str, Any]:
    """The intervals of `sobol_estimates`, widened where needed to hold the indices of the expansion itself.

    Result: "first" and "total", each [2 (lower, upper), input_count, output_count] (last axis dropped for a
    one-dimensional y).
    """
    found, result = sobol_estimates(surrogate, x, y, count=count, level=level, seed=seed), {}
    own_indices = _indices_of(surrogate.multi_indices, surrogate.coefficient_table)
    for own, key in zip(own_indices, ("first", "total"), strict=True):
        _, low, high = found[key].reshape(3, *own.shape)
        result[key] = surrogate.shaped(np.stack([np.minimum(low, own), np.maximum(high, own)]))
    return result


def _basic(refit: Refit, coefficients: Array, level: float) -> tuple[Array, Array, Array]:
    """Estimate and bounds [2, input_count] each, from coefficients [term_count, draw_count] of a fit that shrinks.

    Distances of the draws from what they were drawn about, turned round; up to the percentile of the draws without
    their mean distance, or small effects would be missed.
    """
    draws = _indices_of(refit.indices, coefficients)
    low, high = np.quantile(draws, [0.5 - 0.5 * level, 0.5 + 0.5 * level], axis=-1)
    bias = draws.mean(axis=-1) - refit.truth
    return refit.truth - bias, 2.0 * refit.truth - high, np.maximum(2.0 * refit.truth - low, high - bias)


def _debiased(refit: Refit, coefficients: Array, level: float) -> tuple[Array, Array, Array]:
    """Estimate and bounds [2, input_count] each, from coefficients [term_count, draw_count] of least squares.

    Scatter adds its variance to every squared coefficient; it is taken off, so that many small terms do not add up to
    an effect. Source: [Searle-1992], section 3.5 (analysis of variance).
    """
    noise = coefficients.var(axis=1, ddof=1, keepdims=True)
    parts, variance = _debiased_parts(refit.indices, coefficients, noise)
    # A draw that leaves no variance says nothing: every second one counts as none, the others as all of it.
    shares = np.broadcast_to(np.resize([0.0, 1.0], len(variance)), parts.shape).copy()
    np.divide(parts, variance, out=shares, where=variance > 0.0)
    low, high = np.quantile(shares, [0.5 - 0.5 * level, 0.5 + 0.5 * level], axis=-1)
    parts, variance = _debiased_parts(refit.indices, refit.coefficients(refit.observed[:, None]), noise)
    # Where interactions come out below nothing, inputs alone would explain more than there is.
    whole = max(float(variance[0]), float(np.maximum(parts[0], 0.0).sum()))
    return (parts[..., 0] / whole if whole > 0.0 else np.zeros_like(parts[..., 0])), low, high


def _debiased_parts(indices: Indices, coefficients: Array, noise: Array) -> tuple[Array, Array]:
    """Variance of each input alone and with all interactions, [2, input_count, draw_count], and in all, [draw_count].

    Sums of squared coefficients [term_count, draw_count], less the variance `noise` [term_count, 1] that scatter gives.
    """
    active = (indices > 0).T
    squares = coefficients**2 - noise
    squares[indices.sum(axis=1) == 0] = 0.0
    chosen = np.stack([active & (active.sum(axis=0) == 1), active]).astype(float)
    return chosen @ squares, squares.sum(axis=0)


def _indices_of(indices: Indices, coefficients: Array) -> Array:
    """First-order and total indices [2, input_count, any] of coefficients [term_count, any]."""
    return np.stack([first_order(indices, coefficients), total_order(indices, coefficients)])


def _check_resampling(count: int, level: float) -> None:
    """Check a number of resamplings and a level of confidence; raises ValueError."""
    # Of fewer resamplings an interval has no ends.
    whole_number("count", count, 20)
    finite_number("level", level, above=0.0, below=1.0)


def _drawn_runs(
    surrogate: Surrogate, x: ArrayLike, y: ArrayLike, count: int, seed: int
) -> tuple[Training, NDArray[np.int64]]:
    """The runs x, y, and as many of them drawn with replacement, [count, run_count]."""
    training = checked_training(surrogate.inputs, x, y, output_names=surrogate.output_names)
    sample_count("count", count, training.count)
    return training, random_numbers(seed).integers(training.count, size=(count, training.count))


def _refit_of(surrogate: Surrogate, training: Training, output: int) -> Refit:
    """How one output was fitted, as the report says; the least squares of the best degree where it does not say."""
    entry = surrogate.report.get("outputs", {}).get(surrogate.output_names[output], {})
    method = entry.get("method")
    coefficients = surrogate.coefficient_table[:, output]
    # The expansion holds the terms of all outputs together; those that this one does not have are 0.
    indices = surrogate.multi_indices[(coefficients != 0.0) | (surrogate.multi_indices.sum(axis=1) == 0)]
    if method in ("lars", "omp") and "candidate_degree" in entry:
        return _sparse_refit(training, output, entry["rmse_estimate"], indices)
    if method == "gaussian_process" and "covariance" in entry:
        if entry.get("noise_std", 0.0) ** 2 > SCATTER_SHARE * np.var(training.y[:, output]):
            constant = np.zeros((1, len(training.inputs)), dtype=np.int64)
            return _least_squares_refit(training, output, with_low_degrees(constant, training))
        return _process_refit(training, output, entry, indices)
    if method != "ols" or len(indices) > TERMS_PER_POINT * training.count:
        indices = best_terms(training, term_limit=TERMS_PER_POINT * training.count)
    return _least_squares_refit(training, output, indices)


def _least_squares_refit(training: Training, output: int, indices: Indices) -> Refit:
    """Source of the residuals: [MacKinnon-1985] (HC3: the full leverage, as for left-out points)."""
    orthogonal, triangle = np.linalg.qr(basis_matrix(training.inputs, indices, training.x))
    y = training.y[:, output]
    fitted = orthogonal @ (orthogonal.T @ y)
    freedom = 1.0 - np.einsum("ij,ij->i", orthogonal, orthogonal)
    residuals = (y - fitted) / np.maximum(freedom, SMALLEST_FREEDOM)

    def coefficients(values: Array) -> Array:
        return np.linalg.solve(triangle, orthogonal.T @ values)

    truth = _indices_of(indices, coefficients(y[:, None]))[..., 0]
    # Divided by their leverage residuals no longer add up to 0, and would shift every draw.
    return Refit(indices, coefficients, y, fitted, truth, residuals - residuals.mean())


def _sparse_refit(training: Training, output: int, expected_error: float, kept: Indices) -> Refit:
    """Least squares on the chosen terms and all of low degree, with residuals as large as the error of the folds.

    From the chosen terms alone no effect that the choice has overlooked could ever return, and their residuals are
    too small.
    """
    rich = _least_squares_refit(training, output, with_low_degrees(kept, training))
    return replace(rich, residuals=_grown(rich.residuals, expected_error))


def _grown(residuals: Array, size: float) -> Array:
    """Residuals [count] with at least this root mean square."""
    own = float(np.sqrt(np.mean(residuals**2)))
    return residuals * max(size / own, 1.0) if own > 0.0 else residuals


def _process_refit(training: Training, output: int, entry: dict[str, Any], indices: Indices) -> Refit:
    """The process with its parameters kept, which is linear in the outputs."""
    process = fit_process(training, output, next(one for one in FAMILIES if one.name == entry["covariance"]))
    errors = process.leave_one_out
    truth = _indices_of(indices, process.coefficients(indices)[:, None])[..., 0]
    residuals = _grown(errors - errors.mean(), entry["rmse_estimate"])
    observed, fitted = training.y[:, output], process.predict(process.germs)
    return Refit(indices, partial(process.refitted, indices), observed, fitted, truth, residuals, shrinks=True)


def score_intervals(
    surrogate: Surrogate,
    x: ArrayLike,
    y: ArrayLike,
    *,
    count: int = 1000,
    level: float = EXPANSION_LEVEL,
    seed: int = 0,
) -> dict[str, dict[str, tuple[float, float]]]:
    """Confidence intervals of mape [%], q2, rrmse and rmse on test runs x, y, by output name, resampling the runs.

    Studentised, in the logarithms of the errors: a mean of squares is skewed, and plain percentiles of it are too low
    and too narrow. Fewer than five runs tell nothing; a score of 0 or infinity is its own interval.
    Source: [Davison-1997], section 5.2 (studentised bootstrap).
    """
    _check_resampling(count, level)
    training, rows = _drawn_runs(surrogate, x, y, count, seed)
    predicted = np.asarray(surrogate(training.x)).reshape(training.y.shape)
    result: dict[str, dict[str, tuple[float, float]]] = {}
    for k, name in enumerate(surrogate.output_names):
        low, high = _studentised(predicted[:, k], training.y[:, k], rows, level)
        result[name] = {key: (float(low[j]), float(high[j])) for j, key in enumerate(("mape", "rmse", "rrmse"))}
        result[name]["q2"] = (1.0 - float(high[2]) ** 2, 1.0 - float(low[2]) ** 2)
    return result


def _studentised(predicted: Array, y: Array, rows: NDArray[np.int64], level: float) -> Array:
    """Bounds [2 (lower, upper), 3] of mape, rmse and rrmse of one output; rows [draw_count, count] drawn from it."""
    logarithms, errors = _log_scores(predicted, y)
    if len(y) < FEWEST_TEST_RUNS:
        return np.array([[0.0] * 3, [np.inf] * 3])
    blocks = np.array_split(rows, -(-rows.size // BLOCK))
    draws = np.concatenate([_log_scores(predicted[block], y[block]) for block in blocks], axis=1)
    # A bound that overflows is infinite: so few runs bound nothing.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        distance = (draws[0] - logarithms) / draws[1]
        # A draw of one and the same run has no standard error, so it is infinitely far.
        distance = np.where(np.isnan(distance), np.sign(draws[0] - logarithms) * np.inf, distance)
        # No interpolation between distances that may be infinite.
        high = np.quantile(distance, 0.5 + 0.5 * level, axis=0, method="higher")
        low = np.quantile(distance, 0.5 - 0.5 * level, axis=0, method="lower")
        bounds = np.exp(logarithms - np.stack([high, low]) * errors)
    return np.where(np.isfinite(logarithms) & (errors > 0.0), bounds, np.exp(logarithms))


def _log_scores(predicted: Array, y: Array) -> Array:
    """Logarithms of mape, rmse and rrmse of runs [..., count], with standard errors to first order, [2, ..., 3]."""
    square, deviation = (predicted - y) ** 2, (y - y.mean(axis=-1, keepdims=True)) ** 2
    percentage = absolute_percentage_error(predicted, y)
    mean_square, mean_deviation = (one.mean(axis=-1, keepdims=True) for one in (square, deviation))
    with np.errstate(divide="ignore", invalid="ignore"):
        mape, error, deviation = (
            percentage.mean(axis=-1, keepdims=True),
            square / mean_square,
            deviation / mean_deviation,
        )
        sizes = np.concatenate([mape, np.sqrt(mean_square), np.sqrt(mean_square / mean_deviation)], axis=-1)
        derivatives = (percentage / mape, 0.5 * error, 0.5 * (error - deviation))
        errors = np.stack([one.std(axis=-1) for one in derivatives], axis=-1)
        return np.stack([np.log(sizes), errors / np.sqrt(max(y.shape[-1] - 1, 1))])
