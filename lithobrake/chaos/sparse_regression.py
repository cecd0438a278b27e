"""Sparse fits: least angle regression and orthogonal matching pursuit choose terms, least squares their coefficients.

Error estimates come from folds over the whole selection path: leave-one-out after a greedy choice is far too low.
"""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import solve_triangular

from lithobrake.chaos.basis import Indices, basis_matrix, multi_index_set
from lithobrake.chaos.degree_selection import Solution, solve_ols, terms_to_try
from lithobrake.chaos.training_data import Training
from lithobrake.vocabulary.array_types import Array, Integers

FOLDS = 10
NORMS = (1.0, 0.75, 0.5)
CANDIDATE_LIMIT = 1500
HIGHEST_SPARSE_DEGREE = 14
# Degrees in a row that may fail to help before higher ones are given up.
PATIENCE = 2


def is_structured(x: Array) -> bool:
    """Whether points [count, input_count] are a grid: most values of an input occur several times.

    Folds of a grid leave out whole faces, so their error is that of extrapolation.
    """
    distinct = np.unique(x, axis=0)
    fractions = [len(np.unique(column)) / len(column) for column in distinct.T]
    return len(x) > 4 and float(np.median(fractions)) < 1.0 / 3.0


@dataclass(frozen=True)
class Candidates:
    degree: int
    q_norm: float
    indices: Indices


def solve_sparse(training: Training, output: int, method: str, *, degree: int | None, q_norm: float | None) -> Solution:
    """Fit one output by "lars" or "omp"; degree and q_norm None are chosen by the same folds.

    Source: [Blatman-2011] (hybrid LARS); [Pati-1993] (OMP).
    """
    y = training.y[:, output]
    ladders = _candidate_ladders(training, degree, q_norm)
    if degree is not None and not any(ladders):
        raise ValueError(f"degree {degree} has more than {CANDIDATE_LIMIT} candidate terms: lower it or q_norm")
    if not any(ladders) or len(np.unique(training.x, axis=0)) < 2:
        # Too few distinct points to tell any term from another.
        constant = solve_ols(training, multi_index_set(len(training.inputs), 0))[output]
        return replace(constant, method=method)
    folds = [] if is_structured(training.x) else _folds(training)
    error, length, candidates = _best_candidates(training, y, method, ladders, folds)
    matrix = basis_matrix(training.inputs, candidates.indices, training.x)
    kept = np.concatenate([[0], np.sort(_order(matrix, y, method)[:length])]).astype(np.int64)
    used = matrix[:, kept]
    coefficients: Array = np.linalg.lstsq(used, y, rcond=None)[0].astype(float)
    # As for least squares: folds do not see the tails where no run stands.
    residual = float(np.sum((y - used @ coefficients) ** 2)) / max(len(y) - len(kept), 1)
    values = np.linalg.svd(used, compute_uv=False)
    values = values[values > values[0] * max(used.shape) * np.finfo(float).eps]
    error = max(error, residual * (1.0 + float(np.sum(values**-2.0))))
    estimate = f"{len(folds)}-fold over the selection path" if folds else "leave-one-out on a grid"
    facts = {
        "candidate_degree": candidates.degree,
        "candidate_q_norm": candidates.q_norm,
        "condition_number": float(values[0] / values[-1]),
    }
    return Solution(method, candidates.indices[kept], coefficients, float(np.sqrt(error)), estimate, facts)


def _best_candidates(
    training: Training, y: Array, method: str, ladders: list[list[Candidates]], folds: list[Integers]
) -> tuple[float, int, Candidates]:
    """Smallest mean squared error, the number of terms that has it, and the candidates they are chosen from."""
    best = np.inf, 0, next(one for ladder in ladders for one in ladder)
    for ladder in ladders:
        idle, lowest = 0, np.inf
        for candidates in ladder:
            matrix = basis_matrix(training.inputs, candidates.indices, training.x)
            errors = _fold_errors(matrix, y, method, folds) if folds else _grid_errors(matrix, y, method)
            length = int(np.argmin(errors))
            # A larger set must be clearly better, or rounding decides between equal fits.
            if errors[length] < best[0] * (1.0 - 1e-6):
                best = float(errors[length]), length, candidates
            idle, lowest = (0, errors[length]) if errors[length] < 0.99 * lowest else (idle + 1, lowest)
            if idle == PATIENCE:
                break
    return best


def _candidate_ladders(training: Training, degree: int | None, q_norm: float | None) -> list[list[Candidates]]:
    """For each norm the index sets of rising degree."""
    input_count = len(training.inputs)
    degrees = range(1, HIGHEST_SPARSE_DEGREE + 1) if degree is None else [degree]
    norms = NORMS if q_norm is None else (q_norm,)
    # Far more candidates than points cannot be told apart.
    limit = CANDIDATE_LIMIT if degree is not None else min(CANDIDATE_LIMIT, 6 * training.count)
    ladders: list[list[Candidates]] = []
    for norm in norms if input_count > 1 else norms[:1]:
        ladder: list[Candidates] = []
        for one in degrees:
            if degree is None:
                indices = terms_to_try(training, one, norm)
            else:
                indices = multi_index_set(input_count, one, q_norm=norm)
            # Sets of higher degrees hold those of lower ones, so after the first that is too large none is made.
            if len(indices) > limit:
                break
            ladder.append(Candidates(one, norm, indices))
        ladders.append(ladder)
    return ladders


def _folds(training: Training) -> list[Integers]:
    """Rows left out in each fold: the same for every candidate, random but fixed, equal runs together."""
    groups = training.groups or [np.array([row]) for row in range(training.count)]
    order = np.random.default_rng(0).permutation(len(groups))
    parts = np.array_split(order, min(FOLDS, len(groups)))
    return [np.sort(np.concatenate([groups[k] for k in part])) for part in parts]


def _order(matrix: Array, y: Array, method: str) -> Integers:
    """Columns in the order in which the method takes them up; the constant (column 0) is always in and not listed."""
    columns = matrix[:, 1:] - matrix[:, 1:].mean(axis=0)
    lengths = np.linalg.norm(columns, axis=0)
    usable = np.nonzero(lengths > 1e-12 * lengths.max(initial=1.0))[0]
    centred = y - y.mean()
    limit = max(1, min(len(usable), len(y) // 2 if method == "omp" else len(y) - 2))
    if not len(usable) or not np.any(centred):
        return np.zeros(0, dtype=np.int64)
    scaled = columns[:, usable] / lengths[usable]
    active = _pursued(scaled, centred, limit) if method == "omp" else _least_angles(scaled, centred, limit)
    return (usable[np.asarray(active, dtype=np.int64)] + 1).astype(np.int64)


def _least_angles(columns: Array, y: Array, limit: int) -> list[int]:
    """Columns [count, column_count] of length 1 in the order of least angle regression, at most so many."""
    from sklearn.linear_model import lars_path

    with warnings.catch_warnings():
        # The path may reach the data exactly, or columns that depend on others, before the limit; up to there is all
        # that is wanted.
        warnings.filterwarnings("ignore", message="(?s).*(Regressors in active set degenerate|Early stopping the lars)")
        return list(lars_path(columns, y, method="lar", max_iter=limit)[1])


def _pursued(columns: Array, y: Array, limit: int) -> list[int]:
    """Columns [count, column_count] of length 1 in the order of orthogonal matching pursuit, at most so many: each is
    the one that has most of what those before leave of y.
    """
    chosen: list[int] = []
    basis = np.empty((limit, len(y)))
    products, rounding = y @ columns, np.finfo(float).eps
    least = rounding * float(np.linalg.norm(y))
    for count in range(limit):
        place = int(np.argmax(np.abs(products)))
        rest = columns[:, place].copy()
        for _ in range(2):
            # Once more, as rounding leaves some of a column that nearly depends on those before.
            rest -= (basis[:count] @ rest) @ basis[:count]
        square = float(rest @ rest)
        # All of y is explained, or the best column depends on those before.
        if abs(products[place]) <= least or place in chosen or square <= rounding:
            break
        basis[count] = rest / np.sqrt(square)
        chosen.append(place)
        products -= (basis[count] @ y) * (basis[count] @ columns)
    return chosen


def _path(matrix: Array, y: Array, order: Integers) -> tuple[Array, Array, Array]:
    """Orthogonal factor, triangle and projected outputs for the constant and the columns in their order."""
    orthogonal, triangle = np.linalg.qr(matrix[:, np.concatenate([[0], order]).astype(np.int64)])
    # Later columns that are combinations of earlier ones would divide by rounding.
    diagonal = np.abs(np.diag(triangle))
    good = np.cumprod(diagonal > 1e-8 * diagonal[0]).sum()
    return orthogonal[:, :good], triangle[:good, :good], orthogonal[:, :good].T @ y


def _fold_errors(matrix: Array, y: Array, method: str, folds: Sequence[Integers]) -> Array:
    """Mean squared error at left-out points for each number of chosen terms, [length + 1]."""
    total: Array | None = None
    for rows in folds:
        rest = np.delete(np.arange(len(y)), rows)
        order = _order(matrix[rest], y[rest], method)
        _, triangle, projected = _path(matrix[rest], y[rest], order)
        columns = np.concatenate([[0], order]).astype(np.int64)[: len(triangle)]
        left_out = solve_triangular(triangle, matrix[np.ix_(rows, columns)].T, trans="T").T
        squares = ((np.cumsum(left_out * projected, axis=1) - y[rows, None]) ** 2).sum(axis=0)
        # Only lengths that every fold reaches can be compared.
        total = squares if total is None else total[: len(squares)] + squares[: len(total)]
    return np.zeros(1) if total is None else total / len(y)


def _grid_errors(matrix: Array, y: Array, method: str) -> Array:
    """Mean squared leave-one-out error along the path on all points, at most half as many terms as points."""
    orthogonal, _, projected = _path(matrix, y, _order(matrix, y, method))
    orthogonal, projected = orthogonal[:, : len(y) // 2], projected[: len(y) // 2]
    residuals = y[:, None] - np.cumsum(orthogonal * projected, axis=1)
    leverage = np.cumsum(orthogonal**2, axis=1)
    return np.mean((residuals / np.maximum(1.0 - leverage, np.finfo(float).eps)) ** 2, axis=0)
