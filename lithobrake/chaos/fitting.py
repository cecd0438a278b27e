"""The one entry: from runs to an expansion."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.chaos.basis import basis_matrix
from lithobrake.chaos.evaluation import evaluate, make_plan
from lithobrake.chaos.germ import Distribution
from lithobrake.chaos.least_squares import least_squares
from lithobrake.chaos.polynomials import Array
from lithobrake.chaos.storage import data_hash
from lithobrake.chaos.surrogate import Surrogate
from lithobrake.chaos.terms import Indices, multi_index_set, term_count
from lithobrake.chaos.training import Training, checked_training

METHODS = ("ols",)
HIGHEST_DEGREE = 12


def fit(
    inputs: Mapping[str, Distribution],
    x: ArrayLike,
    y: ArrayLike,
    degree: int | None = None,
    method: str | None = None,
    *,
    q_norm: float = 1.0,
    weights: ArrayLike | None = None,
    output_names: Sequence[str] | None = None,
) -> Surrogate:
    """Fit an expansion to runs: x [count, input_count] physical units, y [count] or [count, output_count].

    degree: total degree; None chooses it by cross-validation. method: one of METHODS; None with a degree is "ols",
    None without a degree compares methods. q_norm: hyperbolic index set. weights: least-squares weights [count].
    Rows of y that are all NaN are dropped and counted. Raises ValueError for fewer points than terms, rank deficiency
    and data that `checked_training` refuses.
    Source: the paper, Eqs 13 to 17.
    """
    if method is not None and method not in METHODS:
        raise ValueError(f"method is {method!r}, but must be one of {', '.join(METHODS)}")
    training = checked_training(inputs, x, y, output_names=output_names, weights=weights)
    chosen = _degree_by_leave_one_out(training, q_norm) if degree is None else degree
    indices = multi_index_set(len(training.inputs), chosen, q_norm=q_norm)
    return _ols(training, indices)


def _ols(training: Training, indices: Indices) -> Surrogate:
    matrix = basis_matrix(training.inputs, indices, training.x)
    solved = least_squares(matrix, training.y, indices=indices, names=list(training.inputs), weights=training.weights)
    error = _relative(solved.leave_one_out, training.y)
    report = {"method": "ols", "condition_number": solved.condition, "error_estimate": "leave-one-out"}
    return assemble(training, indices, solved.coefficients, {**report, "rrmse_estimate": error})


def _relative(error: Array, y: Array) -> list[float | None]:
    """Root-mean-square error over the spread of each output; None where an output does not vary."""
    rmse, std = np.sqrt(np.mean(error**2, axis=0)), np.where(np.ptp(y, axis=0) > 0.0, np.std(y, axis=0), 0.0)
    return [float(e / s) if s > 0.0 else None for e, s in zip(rmse, std, strict=True)]


def assemble(training: Training, indices: Indices, coefficients: Array, report: dict[str, Any]) -> Surrogate:
    """Join coefficients and data facts into the result."""
    # Rounding would give a constant output a variance of 1e-32, and with it meaningless shares.
    constant = np.ptp(training.y, axis=0) == 0.0
    coefficients[:, constant] = np.where(indices.sum(axis=1) == 0, 1.0, 0.0)[:, None] * training.y[0, constant]
    plan = make_plan(training.inputs, indices, coefficients)
    facts = {
        "degree": int(indices.sum(axis=1).max()),
        "train_count": training.count,
        "dropped_count": training.dropped_count,
        "data_hash": data_hash(training.x, training.y),
    }
    return Surrogate(
        training.inputs,
        indices,
        coefficients,
        output_names=training.output_names,
        one_dimensional=training.one_dimensional,
        residuals=training.y - evaluate(training.inputs, plan, training.x),
        report={**report, **facts},
    )


def _degree_by_leave_one_out(training: Training, q_norm: float) -> int:
    """Degree whose least squares has the smallest leave-one-out error, averaged over outputs."""
    best, best_error = 0, np.inf
    for degree in range(HIGHEST_DEGREE + 1):
        if degree > 0 and term_count(len(training.inputs), degree) > training.count - 1 and q_norm == 1.0:
            break
        indices = multi_index_set(len(training.inputs), degree, q_norm=q_norm)
        if len(indices) > training.count:
            break
        try:
            estimate = _ols(training, indices).report["rrmse_estimate"]
        except ValueError:
            break  # The design does not determine this degree, so no higher one either.
        error = float(np.mean([e or 0.0 for e in estimate]))
        if error < best_error:
            best, best_error = degree, error
    return best
