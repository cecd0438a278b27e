"""The multivariate orthonormal basis: its multi-indices, their number, and its values at given points."""

from collections.abc import Mapping, Sequence
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.polynomials import Recurrence
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import numbers, whole_number

Indices = NDArray[np.int64]

# Terms that are looked at for one more input: with more, neither they nor any matrix of them would fit into memory.
LOOKED_AT = 20_000_000
# Limits computed by a user in another order of operations may differ from ours in the last digits.
ROUNDING = 1e-12
# Equal steps of probability between which the quantiles of an input may be taken as straight.
QUANTILE_STEPS = 512


def multi_index_set(
    input_count: int, degree: int, *, q_norm: float = 1.0, max_degrees: Sequence[int] | None = None
) -> Indices:
    """Multi-indices with `(sum i_r**q)**(1/q) <= degree`, shape [term_count, input_count], ordered by total degree.

    q_norm: 1 is the total degree; smaller drops interactions. max_degrees: highest degree of each input, [input_count].
    Raises ValueError for a negative degree or q_norm outside (0, 1], and for more terms than a fit could ever have.
    Source: [Landings-PCE], Eq 13; [Blatman-2011], Eq 22 (hyperbolic sets).
    """
    total = whole_number("degree", degree, 0, LOOKED_AT)
    if not isinstance(q_norm, Real) or not 0.0 < q_norm <= 1.0:
        raise ValueError(f"q_norm is {q_norm!r}, but must be above 0 and at most 1")
    highest = [total] * input_count
    if max_degrees is not None:
        highest = [min(whole_number("an entry of max_degrees", one, 0), total) for one in max_degrees]
    if len(highest) != input_count:
        raise ValueError(f"max_degrees has {len(highest)} entries, but must have one for each of {input_count} inputs")
    # Terms on the border of the set would otherwise be in or out by the rounding of their powers.
    budget = float(degree) ** q_norm * (1.0 + 1e-12)
    rows = np.zeros((1, 0), dtype=np.int64)
    used = np.zeros(1)
    # Inputs are added one at a time and hopeless rows dropped at once, so the full tensor is never formed.
    for limit in highest:
        if len(rows) * (limit + 1) > LOOKED_AT:
            raise ValueError(
                f"degree is {degree}, which for {input_count} inputs gives too many terms to look at: {len(rows)} by "
                f"{limit + 1} for one input more, of which {LOOKED_AT} fit into memory; lower it or q_norm"
            )
        powers = np.arange(limit + 1)
        spent = used[:, None] + powers[None, :].astype(float) ** q_norm
        row, power = np.nonzero(spent <= budget)
        rows = np.column_stack([rows[row], powers[power]])
        used = spent[row, power]
    return by_degree(rows)


def by_degree(rows: Indices) -> Indices:
    """Multi-indices [term_count, input_count] ordered by total degree, of one degree the first input's powers first."""
    keys = [-rows[:, column] for column in reversed(range(rows.shape[1]))]
    return np.ascontiguousarray(rows[np.lexsort([*keys, rows.sum(axis=1)])])


def points_of(inputs: Mapping[str, Distribution], x: ArrayLike) -> Array:
    """Bring points to shape [count, input_count]; one-dimensional x is many points of a single input."""
    points = numbers("x", x)
    if points.ndim == 1 and len(inputs) == 1:
        points = points[:, None]
    if points.ndim != 2 or points.shape[1] != len(inputs):
        raise ValueError(
            f"x has shape {points.shape}, but must be [count, {len(inputs)}]: one column for each of "
            f"{', '.join(inputs)}"
        )
    return points


def outside_count(inputs: Mapping[str, Distribution], points: Array) -> tuple[int, str]:
    """Number of points outside the support, and a sentence about the worst input (empty when none is outside)."""
    outside = np.zeros(len(points), dtype=bool)
    sentence = ""
    for k, (name, entry) in enumerate(inputs.items()):
        lower, upper = entry.support
        slack = ROUNDING * (upper - lower if entry.bounded else abs(lower) if np.isfinite(lower) else 0.0)
        column = points[:, k]
        wrong = ~((column >= lower - slack) & (column <= upper + slack) & np.isfinite(column))
        if entry.logarithmic:
            wrong |= column <= 0.0
        if wrong.any():
            outside |= wrong
            value = column[wrong][0]
            sentence = sentence or f"{name} is {value:g}, but its support is [{lower:g}, {upper:g}]"
    return int(outside.sum()), sentence


def checked_points(inputs: Mapping[str, Distribution], x: ArrayLike) -> Array:
    """Points [count, input_count] inside the support of all inputs; raises ValueError for others."""
    points = points_of(inputs, x)
    count, sentence = outside_count(inputs, points)
    if count:
        raise ValueError(f"x has {count} of {len(points)} points outside the inputs: {sentence}")
    return points


def checked_weights(weights: ArrayLike, count: int) -> Array:
    """Weights of points [count]; raises ValueError unless they are finite and above 0."""
    values = numbers("weights", weights)
    if values.shape != (count,) or not np.all(np.isfinite(values)) or not np.all(values > 0.0):
        raise ValueError(f"weights must be {count} finite numbers above 0, one for each point")
    return values


def germs_of(inputs: Mapping[str, Distribution], points: Array) -> Array:
    """Germs of points in physical units [count, input_count]; result [input_count, count]."""
    return np.stack([entry.germ(points[:, k]) for k, entry in enumerate(inputs.values())])


def recurrences_of(inputs: Mapping[str, Distribution], indices: Indices) -> list[Recurrence]:
    """Recurrence of each input up to the highest degree that the index set uses."""
    highest = indices.max(axis=0) if len(indices) else np.zeros(len(inputs), dtype=int)
    recurrences = []
    for (name, entry), degree in zip(inputs.items(), highest, strict=True):
        try:
            recurrences.append(entry.recurrence(int(degree)))
        except ValueError as error:
            raise ValueError(f"input {name!r}: {error}") from None
    return recurrences


def basis_matrix(inputs: Mapping[str, Distribution], indices: Indices, points: Array) -> Array:
    """All terms at points in physical units; result [count, term_count] (H of [Landings-PCE], Eq 17), column-major."""
    germs = germs_of(inputs, points)
    # Terms are rows while they are made, so that each product runs along memory; LAPACK takes the transpose.
    matrix = np.ones((len(indices), len(points)))
    for column, (recurrence, germ) in enumerate(zip(recurrences_of(inputs, indices), germs, strict=True)):
        if recurrence.degree == 0:
            continue
        table = recurrence.values(germ)
        used = np.nonzero(indices[:, column])[0]
        matrix[used] *= table[indices[used, column]]
    return matrix.T


def condition_number(
    inputs: Mapping[str, Distribution], x: ArrayLike, indices: Indices | int, *, weights: ArrayLike | None = None
) -> float:
    """Ratio of the largest to the smallest singular value of the basis at a design; infinite if rank deficient.

    indices: terms [term_count, input_count], or a total degree. weights: least-squares weights of the points [count].
    """
    terms = indices if isinstance(indices, np.ndarray) else multi_index_set(len(inputs), indices)
    matrix = basis_matrix(inputs, terms, points_of(inputs, x))
    if weights is not None:
        matrix = matrix * np.sqrt(checked_weights(weights, len(matrix)))[:, None]
    if matrix.shape[0] < matrix.shape[1]:
        return float("inf")
    values = np.linalg.svd(matrix, compute_uv=False)
    # The tolerance of numpy.linalg.matrix_rank: singular values below it are rounding.
    limit = values[0] * max(matrix.shape) * np.finfo(float).eps
    return float(values[0] / values[-1]) if values[-1] > limit else float("inf")


def input_tables(inputs: Mapping[str, Distribution], indices: Indices) -> dict[str, Array]:
    """Inputs as plain tables, what turns their values into polynomials, for programs in other languages.

    is_log, germ_zero, germ_slope [input_count]; center, spread [input_count, degree], 0 beyond an input's own;
    germ_quantiles [input_count, step_count + 1] at equal steps of probability, an infinite end half a step inside.
    """
    recurrences = recurrences_of(inputs, indices)
    shape = len(inputs), max(one.degree for one in recurrences)
    tables = {"center": np.zeros(shape), "spread": np.ones(shape)}
    for k, one in enumerate(recurrences):
        tables["center"][k, : one.degree], tables["spread"][k, : one.degree] = one.center, one.spread
    is_log = np.array([entry.logarithmic for entry in inputs.values()])
    probability = np.linspace(0.0, 1.0, QUANTILE_STEPS + 1)
    zero, slope, quantiles = np.empty(len(inputs)), np.empty(len(inputs)), np.empty((len(inputs), len(probability)))
    for k, entry in enumerate(inputs.values()):
        half = 0.5 / QUANTILE_STEPS
        # The logarithm of zero is as far away as no limit.
        inside = [np.isfinite(end) and not (is_log[k] and end == 0.0) for end in entry.support]
        x = entry.ppf(np.clip(probability, 0.0 if inside[0] else half, 1.0 if inside[1] else 1.0 - half))
        quantiles[k] = entry.germ(x)
        low, high = np.log(x[[0, -1]]) if is_log[k] else x[[0, -1]]
        slope[k] = (quantiles[k, -1] - quantiles[k, 0]) / (high - low)
        zero[k] = 0.5 * (low + high) - 0.5 * (quantiles[k, 0] + quantiles[k, -1]) / slope[k]
    return {
        "is_log": is_log.astype(float), "germ_zero": zero, "germ_slope": slope, "germ_quantiles": quantiles, **tables,
    }  # fmt: skip
