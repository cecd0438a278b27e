"""Confidence intervals by resampling: for Sobol indices, and for scores on a test set."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.chaos import sensitivity
from lithobrake.chaos.basis import basis_matrix
from lithobrake.chaos.polynomials import Array
from lithobrake.chaos.regression import best_terms
from lithobrake.chaos.scores import score_of
from lithobrake.chaos.surrogate import Surrogate
from lithobrake.chaos.terms import Indices
from lithobrake.chaos.threads import one_thread
from lithobrake.chaos.training import Training, checked_training

# With more terms than this share of the points the residuals say too little about the error.
TERM_SHARE = 0.7


@one_thread()
def sobol_intervals(
    surrogate: Surrogate, x: ArrayLike, y: ArrayLike, *, count: int = 500, level: float = 0.95, seed: int = 0
) -> dict[str, Any]:
    """Confidence intervals of the Sobol indices by resampling the residuals of the training runs x, y.

    Result: "first" and "total", each [2 (lower, upper), input_count, output_count] (last axis dropped for a
    one-dimensional y); "degree" of the least squares that was resampled, or None if it has the terms of the surrogate.
    Terms of least squares are kept; where the data chose the terms (sparse fits, processes) the least squares of the
    best degree on the same runs stands in. Rows of residuals are drawn jointly for all outputs and scaled by leverage;
    intervals are of the basic kind, which takes off the bias that scatter gives to squared coefficients.
    Source: Davison and Hinkley, 1997, sections 5.2 and 6.2; MacKinnon and White, 1985 (residuals, HC3);
    Dubreuil and others, 2014 (indices from expansions).
    """
    _check(count, level)
    training = checked_training(surrogate.inputs, x, y, output_names=surrogate.output_names)
    indices, degree = _terms_to_resample(surrogate, training)
    matrix = basis_matrix(training.inputs, indices, training.x)
    orthogonal, triangle = np.linalg.qr(matrix)
    fitted = orthogonal @ (orthogonal.T @ training.y)
    leverage = np.einsum("ij,ij->i", orthogonal, orthogonal)
    # The full leverage, not its root: the intervals must also hold what the choice of terms and their cut leave out.
    residuals = (training.y - fitted) / np.maximum(1.0 - leverage, 0.05)[:, None]
    residuals -= residuals.mean(axis=0)
    generator = np.random.default_rng(seed)

    def indices_of(values: Array) -> Array:
        coefficients = np.linalg.solve(triangle, orthogonal.T @ values)
        return np.stack(
            [sensitivity.first_order(indices, coefficients), sensitivity.total_order(indices, coefficients)]
        )

    estimate = indices_of(training.y)
    draws = [
        indices_of(fitted + residuals[generator.integers(training.count, size=training.count)]) for _ in range(count)
    ]
    tails = np.quantile(np.array(draws), [0.5 + 0.5 * level, 0.5 - 0.5 * level], axis=0)
    bounds = np.clip(2.0 * estimate - tails, 0.0, 1.0)
    first, total = surrogate.shaped(bounds[:, 0]), surrogate.shaped(bounds[:, 1])
    return {"first": first, "total": total, "degree": degree}


def _check(count: int, level: float) -> None:
    if count < 20:
        raise ValueError(f"count is {count}, but at least 20 resamplings are needed for an interval")
    if not 0.0 < level < 1.0:
        raise ValueError(f"level is {level}, but must be between 0 and 1, for instance 0.95")


def _terms_to_resample(surrogate: Surrogate, training: Training) -> tuple[Indices, int | None]:
    methods = {entry.get("method") for entry in surrogate.report.get("outputs", {}).values()}
    if methods == {"ols"} and surrogate.term_count <= TERM_SHARE * training.count:
        return surrogate.multi_indices, None
    indices = best_terms(training, term_limit=TERM_SHARE * training.count)
    return indices, int(indices.sum(axis=1).max())


def score_intervals(
    surrogate: Surrogate, x: ArrayLike, y: ArrayLike, *, count: int = 1000, level: float = 0.95, seed: int = 0
) -> dict[str, dict[str, tuple[float, float]]]:
    """Confidence intervals of mape [%], q2, rrmse and rmse on test runs x, y, by output name, resampling the runs.

    Source: Davison and Hinkley, 1997, section 5.3 (percentile intervals).
    """
    _check(count, level)
    training = checked_training(surrogate.inputs, x, y, output_names=surrogate.output_names)
    predicted = np.asarray(surrogate(training.x)).reshape(training.y.shape)
    rows = np.random.default_rng(seed).integers(training.count, size=(count, training.count))
    tails = [0.5 - 0.5 * level, 0.5 + 0.5 * level]
    result: dict[str, dict[str, tuple[float, float]]] = {}
    for k, name in enumerate(surrogate.output_names):
        scores = [score_of(predicted[draw, k], training.y[draw, k]) for draw in rows]
        result[name] = {}
        for key in ("mape", "q2", "rrmse", "rmse"):
            low, high = np.quantile([score[key] for score in scores], tails)
            result[name][key] = (float(low), float(high))
    return result
