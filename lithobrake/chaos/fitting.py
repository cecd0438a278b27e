"""The one entry: from runs to an expansion."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.degree_selection import best_terms, solve_ols
from lithobrake.chaos.model_selection import best_solutions, process_solution
from lithobrake.chaos.multi_index import multi_index_set
from lithobrake.chaos.noise import replicates, with_noise
from lithobrake.chaos.solution import Solution, joined, summary, with_progress
from lithobrake.chaos.sparse_regression import solve_sparse
from lithobrake.chaos.storage import data_hash
from lithobrake.chaos.surrogate import Surrogate
from lithobrake.chaos.threads import one_thread
from lithobrake.chaos.training import Training, checked_training

METHODS = ("ols", "lars", "omp", "gaussian_process")


@one_thread()
def fit(
    inputs: Mapping[str, Distribution],
    x: ArrayLike,
    y: ArrayLike,
    degree: int | None = None,
    method: str | None = None,
    *,
    q_norm: float | None = None,
    max_degrees: Sequence[int] | None = None,
    weights: ArrayLike | None = None,
    output_names: Sequence[str] | None = None,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> Surrogate:
    """Fit an expansion to runs: x [count, input_count] physical units, y [count] or [count, output_count].

    degree: total degree; None chooses it by cross-validation. method: "ols" least squares; "lars", "omp" sparse;
    "gaussian_process" the projection of a process on the basis; None with a degree is "ols", None without a degree
    takes for each output whichever of least squares, pursuit and processes has the smallest estimated error.
    q_norm: hyperbolic index set, None is 1 (sparse methods without a degree choose). max_degrees: highest degree of
    each input, and weights: of the points [count], both for "ols". Rows of y that are all NaN are dropped and counted.
    progress: called with the number of outputs that are fitted, and that of all.
    Raises ValueError for fewer points than terms, rank deficiency and data that `checked_training` refuses.
    Source: [Landings-PCE], Eqs 13 to 17.
    """
    if method is None and any(one is not None for one in (degree, q_norm, max_degrees, weights)):
        method = "ols"
    _check_request(degree, method, max_degrees, weights)
    training = checked_training(inputs, x, y, output_names=output_names, weights=weights)
    outputs = with_progress(range(training.y.shape[1]), progress)
    extra: dict[str, Any] = {}
    if method is None:
        solutions, extra = best_solutions(training, progress)
    elif method == "ols":
        norm = 1.0 if q_norm is None else q_norm
        if degree is None:
            indices = best_terms(training, norm, max_degrees)
        else:
            indices = multi_index_set(len(inputs), degree, q_norm=norm, max_degrees=max_degrees)
        solutions = solve_ols(training, indices)
    elif method == "gaussian_process":
        solutions = [process_solution(training, k) for k in outputs]
    else:
        solutions = [solve_sparse(training, k, method, degree=degree, q_norm=q_norm) for k in outputs]
    return _assembled(training, solutions, extra)


def _check_request(degree: Any, method: str | None, max_degrees: Any, weights: Any) -> None:
    if method is not None and method not in METHODS:
        raise ValueError(f"method is {method!r}, but must be one of {', '.join(METHODS)}")
    if method == "gaussian_process" and degree is not None:
        raise ValueError(f"degree is {degree}, but the method gaussian_process chooses its terms: leave degree out")
    if method != "ols" and (weights is not None or max_degrees is not None):
        raise ValueError(f"weights and max_degrees are for the method ols, but the method is {method}: leave them out")


def _assembled(training: Training, solutions: list[Solution], extra: dict[str, Any]) -> Surrogate:
    """Join the solutions of all outputs and the facts about the data into the result."""
    indices, coefficients = joined(solutions)
    report = {**summary(solutions, training.output_names, training.y), **extra}
    # Rounding would give a constant output a variance of 1e-32, and with it meaningless shares.
    constant = np.ptp(training.y, axis=0) == 0.0
    coefficients[:, constant] = np.where(indices.sum(axis=1) == 0, 1.0, 0.0)[:, None] * training.y[0, constant]
    pooled = replicates(training.x, training.y) if training.groups else None
    facts = {
        "degree": int(indices.sum(axis=1).max()),
        "train_count": training.count,
        "dropped_count": training.dropped_count,
        "data_hash": data_hash(training.x, training.y),
    }
    surrogate = Surrogate(
        training.inputs,
        indices,
        coefficients,
        output_names=training.output_names,
        one_dimensional=training.one_dimensional,
        report={**with_noise(report, pooled), **facts},
    )
    known = [one.residuals for one in solutions if one.residuals is not None]
    if len(known) == len(solutions):
        surrogate.residuals = np.column_stack(known)
    else:
        surrogate.residuals = training.y - surrogate.evaluated(training.x)
    return surrogate
