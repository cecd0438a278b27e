"""Least squares on a set of multi-indices, and the choice of the degree by leave-one-out."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import qr, solve_triangular

from lithobrake.chaos.basis import Indices, basis_matrix, by_degree, condition_number, multi_index_set
from lithobrake.chaos.training_data import Training
from lithobrake.vocabulary.array_types import Array

# Singular values below this times the largest are rank loss: far below any usable condition number,
# far above the rounding of an exactly deficient system.
RANK_TOLERANCE = 1e-10
# Lost terms that a refusal names.
LOST_LISTED = 20
HIGHEST_DEGREE = 15


def _lost_terms(triangle: Array, values: Array, indices: Indices, names: Sequence[str], count: int) -> str:
    """The sentence that refuses a rank-deficient fit; pivoting finds terms that the others determine."""
    _, _, order = qr(triangle, mode="economic", pivoting=True)
    rank = int(np.sum(values > RANK_TOLERANCE * values[0]))
    lost = [_term_name(indices[k], names) for k in sorted(order[rank:])]
    more = f" and {len(lost) - LOST_LISTED} more" if len(lost) > LOST_LISTED else ""
    return (
        f"the {count} points determine only {rank} of {len(indices)} terms "
        f"(lost: {', '.join(lost[:LOST_LISTED])}{more}, which the others cannot be told from): "
        "lower the degree, raise the level of the design or add points"
    )


def _term_name(index: Sequence[int], names: Sequence[str]) -> str:
    """A term in words, for instance "friction^2 speed"."""
    parts = [f"{name}^{power}" if power > 1 else name for name, power in zip(names, index, strict=True) if power]
    return " ".join(parts) or "constant"


def _least_squares(training: Training, indices: Indices) -> tuple[Array, Array, Array, Array]:
    """Minimise sum w_k (y_k - H_k c)**2 by QR of H, the terms at the points.

    Coefficients [term_count, output_count], residuals [count, output_count], orthogonal factor [count, term_count] and
    singular values [term_count]. Raises ValueError for rank deficiency, naming terms that cannot be told apart.
    Source: [Landings-PCE], Eqs 15 and 16; [Golub-2013], section 5.5.
    """
    matrix = basis_matrix(training.inputs, indices, training.x)
    root = 1.0 if training.weights is None else np.sqrt(training.weights)[:, None]
    orthogonal, triangle = np.linalg.qr(matrix * root)
    values = np.linalg.svd(triangle, compute_uv=False)
    if values[-1] <= RANK_TOLERANCE * values[0]:
        raise ValueError(_lost_terms(triangle, values, indices, list(training.inputs), training.count))
    coefficients = solve_triangular(triangle, orthogonal.T @ (training.y * root), check_finite=False)
    return coefficients, training.y - matrix @ coefficients, orthogonal, values


def _left_out(residuals: Array, orthogonal: Array, groups: Sequence[NDArray[np.int64]]) -> Array:
    """Error at each point of the fit without it (or without its group of rows), [count, output_count].

    Source: [Allen-1974] (PRESS); [Cook-1982], section 3.6 (groups).
    """
    if not groups:
        leverage = np.einsum("ij,ij->i", orthogonal, orthogonal)
        return residuals / np.maximum(1.0 - leverage, np.finfo(float).eps)[:, None]
    errors = np.empty_like(residuals)
    for rows in groups:
        part = orthogonal[rows]
        # A group that alone determines a direction leaves nothing to predict it by: the pseudo-inverse says 0 there, as
        # far as rounding lets it.
        own = np.eye(len(rows)) - part @ part.T
        errors[rows] = np.linalg.pinv(own, rcond=1e-12, hermitian=True) @ residuals[rows]
    return errors


@dataclass(frozen=True)
class Solution:
    """One output: terms [term_count, input_count], coefficients [term_count], and the error expected at new points.

    expected_error: root-mean-square [unit of the output], run-to-run scatter included; error_estimate: how it was
    found; facts: further plain JSON values for the report; residuals [count] if they are at hand.
    """

    method: str
    indices: Indices
    coefficients: Array
    expected_error: float
    error_estimate: str
    facts: dict[str, Any] = field(default_factory=dict)
    residuals: Array | None = None


def with_progress(outputs: range, progress: Callable[[int, int], None]) -> Iterator[int]:
    """The outputs one by one, with how many are done told before each and at the end."""
    for output in outputs:
        progress(output, len(outputs))
        yield output
    progress(len(outputs), len(outputs))


def joined(solutions: Sequence[Solution]) -> tuple[Indices, Array]:
    """Terms that any output uses, ordered by total degree, and coefficients [term_count, output_count]."""
    if all(one.indices is solutions[0].indices for one in solutions):
        return solutions[0].indices, np.column_stack([one.coefficients for one in solutions])
    stacked = np.concatenate([one.indices for one in solutions])
    indices = by_degree(np.unique(stacked, axis=0))
    place = {tuple(row): k for k, row in enumerate(indices.tolist())}
    coefficients = np.zeros((len(indices), len(solutions)))
    for output, one in enumerate(solutions):
        rows = [place[tuple(row)] for row in one.indices.tolist()]
        coefficients[rows, output] = one.coefficients
    return indices, coefficients


def summary(solutions: Sequence[Solution], names: Sequence[str], y: Array) -> dict[str, Any]:
    """The report of a fit: per output its method and expected error, in its unit and relative to its spread."""
    outputs = {}
    for name, one, column in zip(names, solutions, y.T, strict=True):
        spread = float(np.std(column)) if np.ptp(column) > 0.0 else 0.0
        outputs[name] = {
            "method": one.method,
            "term_count": len(one.indices),
            "rmse_estimate": one.expected_error,
            "rrmse_estimate": one.expected_error / spread if spread > 0.0 else None,
            "error_estimate": one.error_estimate,
            **one.facts,
        }
    methods = sorted({one.method for one in solutions})
    return {
        "method": methods[0] if len(methods) == 1 else "best of each output",
        "rrmse_estimate": [entry["rrmse_estimate"] for entry in outputs.values()],
        "outputs": outputs,
    }


def solve_ols(training: Training, indices: Indices) -> list[Solution]:
    """Least squares for all outputs at once; the error is that of leave-one-out, exact for a fixed set of terms.

    Raises ValueError for fewer points than terms, and for rank deficiency.
    """
    # Looked at before the matrix is made, which for a high degree would fill the memory.
    if training.count < len(indices):
        raise ValueError(
            f"{training.count} points cannot determine {len(indices)} terms: give at least {len(indices)} points or "
            "lower the degree"
        )
    coefficients, residuals, orthogonal, values = _least_squares(training, indices)
    squares = np.mean(_left_out(residuals, orthogonal, training.groups) ** 2, axis=0)
    # Leave-one-out does not see the tails where no run stands; the residuals carried through the basis do: in an
    # orthonormal basis the mean of psi (H'H)**-1 psi over the inputs is the trace of the inverse.
    carried = float(np.sum(values**-2.0)) if training.weights is None else 0.0
    residual = np.sum(residuals**2, axis=0) / max(training.count - len(indices), 1)
    errors = np.sqrt(np.maximum(squares, residual * (1.0 + carried)))
    facts = {"condition_number": float(values[0] / values[-1])}
    # As many terms as points leave no point to judge by: the spread of the output is then the honest guess.
    if len(indices) == training.count:
        errors = np.std(training.y, axis=0)
    estimate = (
        "leave-one-out and predicted variance" if len(indices) < training.count else "none (as many terms as points)"
    )
    return [
        Solution("ols", indices, coefficients[:, k], float(errors[k]), estimate, facts, residuals[:, k])
        for k in range(training.y.shape[1])
    ]


def terms_to_try(
    training: Training, degree: int, q_norm: float = 1.0, max_degrees: Sequence[int] | None = None
) -> Indices:
    """Terms up to a total degree, no input beyond the degree that its distribution determines."""
    limits = [int(min(degree, entry.highest_degree)) for entry in training.inputs.values()]
    indices = multi_index_set(len(limits), degree, q_norm=q_norm, max_degrees=max_degrees)
    return np.ascontiguousarray(indices[(indices <= limits).all(axis=1)])


def ols_by_degree(
    training: Training, q_norm: float = 1.0, max_degrees: Sequence[int] | None = None
) -> list[list[Solution]]:
    """Solutions of all degrees that the points determine with at least one to spare, [degree][output]."""
    ladder: list[list[Solution]] = []
    for degree in range(HIGHEST_DEGREE + 1):
        indices = terms_to_try(training, degree, q_norm, max_degrees)
        if degree > 0 and (len(indices) >= training.count or len(indices) == len(ladder[-1][0].indices)):
            break
        try:
            ladder.append(solve_ols(training, indices))
        except ValueError:
            # The design does not determine this degree, so no higher one either; degree 0 is always determined.
            break
    return ladder


def best_terms(
    training: Training, q_norm: float = 1.0, max_degrees: Sequence[int] | None = None, *, term_limit: float = np.inf
) -> Indices:
    """Terms of the degree with the smallest leave-one-out error relative to the spread, averaged over outputs.

    term_limit: sets with more terms are not looked at.
    """
    spread = np.std(training.y, axis=0)
    spread[spread == 0.0] = 1.0
    ladder = ols_by_degree(training, q_norm, max_degrees)
    ladder = [row for row in ladder if len(row[0].indices) <= max(term_limit, 1)]
    best = int(np.argmin([np.mean([one.expected_error for one in row] / spread) for row in ladder]))
    return ladder[best][0].indices


def with_low_degrees(kept: Indices, training: Training) -> Indices:
    """The kept terms and those of the highest total degree with which the points still determine them twice over."""
    union, degree = kept, 1
    while True:
        more = np.unique(np.concatenate([kept, terms_to_try(training, degree)]), axis=0)
        if 2 * len(more) > training.count or len(more) == len(union):
            return union
        if condition_number(training.inputs, training.x, more) > 1.0 / RANK_TOLERANCE:
            return union
        union, degree = more, degree + 1
