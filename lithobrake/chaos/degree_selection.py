"""Least squares on a given index set, and the choice of its degree by leave-one-out."""

from collections.abc import Sequence

import numpy as np

from lithobrake.chaos.basis import basis_matrix, condition_number
from lithobrake.chaos.least_squares import RANK_TOLERANCE, solve_least_squares
from lithobrake.chaos.multi_index import Indices, multi_index_set
from lithobrake.chaos.solution import Solution
from lithobrake.chaos.training import Training

HIGHEST_DEGREE = 15


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
    matrix = basis_matrix(training.inputs, indices, training.x)
    names = list(training.inputs)
    solved = solve_least_squares(matrix, training.y, indices=indices, names=names, weights=training.weights)
    squares = np.mean(solved.left_out(training.groups) ** 2, axis=0)
    # Leave-one-out does not see the tails where no run stands; the residuals carried through the basis do.
    residual = np.sum(solved.residuals**2, axis=0) / max(training.count - len(indices), 1)
    errors = np.sqrt(np.maximum(squares, residual * (1.0 + solved.predicted_variance)))
    facts = {"condition_number": solved.condition}
    # As many terms as points leave no point to judge by: the spread of the output is then the honest guess.
    if len(indices) == training.count:
        errors = np.std(training.y, axis=0)
    estimate = (
        "leave-one-out and predicted variance" if len(indices) < training.count else "none (as many terms as points)"
    )
    columns = range(training.y.shape[1])
    return [
        Solution("ols", indices, solved.coefficients[:, k], float(errors[k]), estimate, facts, solved.residuals[:, k])
        for k in columns
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
    training: Training,
    q_norm: float = 1.0,
    max_degrees: Sequence[int] | None = None,
    *,
    term_limit: float = np.inf,
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
