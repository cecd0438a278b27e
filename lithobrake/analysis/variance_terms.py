"""Terms of the inputs and of the attitude that runs can bear, and what missing runs may change of their shares."""

from collections.abc import Collection, Iterator, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis import confidence
from lithobrake.analysis.control_variate import regression_terms
from lithobrake.chaos.distributions import Distribution
from lithobrake.vocabulary.array_types import Array, Labels

# More terms than this for each run leave too little of the runs to tell scatter by.
TERMS_PER_RUN = 1 / 3
# A scatter within beds that is less than this part of the whole is rounding.
ROUNDING = 1e-12
BOTH = "terms of first and second degree"


class VarianceTerms(NamedTuple):
    """Terms to regress on: matrix [run_count, term_count], by part which of them make it up [term_count], in words."""

    matrix: Array
    groups: dict[str, np.ndarray]
    words: str


class Regression(NamedTuple):
    """Least squares on terms: squares [term_count] of coefficients freed of scatter, and the variance of residuals."""

    squares: Array
    scatter: float


def checked_attitude(attitude: ArrayLike | None, known: np.ndarray) -> Array:
    """Terms of the attitude of the runs that are known, [known_count, term_count]. Raises ValueError for others."""
    if attitude is None:
        return np.empty((int(known.sum()), 0))
    terms = np.asarray(attitude, dtype=float)
    if terms.ndim != 2 or len(terms) != len(known) or not np.isfinite(terms).all():
        raise ValueError(
            f"attitude has shape {terms.shape}; allowed: finite numbers [run_count, term_count], a row for each of the "
            f"{len(known)} runs of x"
        )
    return terms[known]


def affordable_terms(
    inputs: Mapping[str, Distribution], points: Array, soil: Collection[str], attitude: Array
) -> VarianceTerms | None:
    """The terms that the runs can bear; None where not even linear ones.

    Of second degree all, or squares alone, or none; where there are still too many, the attitude goes unseen.
    """
    terms, indices = regression_terms(inputs, points)
    degree, squares = indices.sum(axis=1), (indices > 0).sum(axis=1) == 1
    choices = ((degree > 0, BOTH), (squares, f"{BOTH}, without products"), (degree == 1, "terms of first degree"))
    for extra in (attitude, attitude[:, :0]):
        for used, words in choices:
            count = int(used.sum()) + extra.shape[1]
            if count <= TERMS_PER_RUN * len(points):
                groups = _groups(inputs, indices[used], soil, extra.shape[1])
                return VarianceTerms(np.hstack([terms[:, used], extra]), groups, words)
    return None


def _groups(
    inputs: Mapping[str, Distribution], indices: Labels, soil: Collection[str], attitude_count: int
) -> dict[str, np.ndarray]:
    """Which terms make up each part: soil, each soil input by its name, arrival and attitude where there are any.

    [term_count], those of the attitude last.
    """
    is_soil = np.array([name in soil for name in inputs])
    of_soil = (indices[:, ~is_soil] == 0).all(axis=1)
    alone = (indices > 0).sum(axis=1) == 1
    groups = {"soil": of_soil}
    groups |= {name: alone & (indices[:, k] > 0) for k, name in enumerate(inputs) if is_soil[k]}
    groups |= {} if is_soil.all() else {"arrival": ~of_soil}
    groups = {name: np.append(group, np.zeros(attitude_count, dtype=bool)) for name, group in groups.items()}
    if attitude_count:
        groups["attitude"] = np.arange(len(indices) + attitude_count) >= len(indices)
    return groups


def regression(terms: Array, y: Array) -> Regression:
    """Scatter adds its variance to each squared coefficient; it is taken off. Source: [Searle-1992], section 3.5."""
    orthogonal, triangle = np.linalg.qr(np.column_stack([np.ones(len(y)), terms]))
    inverse = np.linalg.inv(triangle)
    projected = orthogonal.T @ y
    residuals = y - orthogonal @ projected
    scatter = float(residuals @ residuals) / (len(y) - len(projected))
    squares = (inverse @ projected) ** 2 - scatter * np.sum(inverse**2, axis=1)
    return Regression(squares[1:], scatter)


def filled_shares(
    inputs: Mapping[str, Distribution], points: Array, y: Array, bed: ArrayLike, soil: Collection[str],
    attitude: ArrayLike | None, ends: tuple[Array, Array],
) -> Iterator[tuple[float, dict[str, float]] | None]:  # fmt: skip
    """Variance and shares, not cut, by part, with missing runs at the least or the most that they may have.

    Of each part once where what the others show of it is raised, and once where it is lowered.
    """
    known, used = np.isfinite(y), np.isfinite(ends[0])
    number = confidence.numbered_beds(np.asarray(bed)[used], int(used.sum()))
    told = known[used]
    terms = affordable_terms(inputs, points[used], soil, checked_attitude(attitude, used))
    if terms is None:
        return
    fit = np.linalg.lstsq(np.column_stack([np.ones(told.sum()), terms.matrix[told]]), y[used][told], rcond=None)[0]
    raised = {name: terms.matrix[:, group] @ fit[1:][group] for name, group in terms.groups.items()}
    left = y[used] - fit[0] - terms.matrix @ fit[1:]
    of_beds = np.bincount(number[told], left[told], int(number.max()) + 1)
    directions = [*raised.values(), of_beds[number], np.zeros(len(told))]
    for direction in directions:
        for sign in (1.0, -1.0):
            up = sign * direction > 0.0 if direction.any() else np.full(len(told), sign > 0.0)
            yield _shares_of(terms, np.where(up, ends[1][used], ends[0][used]), number)


def _shares_of(terms: VarianceTerms, y: Array, beds: Labels) -> tuple[float, dict[str, float]] | None:
    """Variance and shares, not cut, by the names of the parts; None where nothing scatters within beds."""
    if len(y) - int(beds.max()) - 2 - terms.matrix.shape[1] < 1:
        return None
    found, components = regression(terms.matrix, y), confidence.bed_components(y, beds, terms.matrix)
    total = float(found.squares.sum()) + components.bed_variance + components.within
    if components.within <= ROUNDING * float(np.var(y)):
        return None
    shares = {name: float(found.squares[group].sum()) / total for name, group in terms.groups.items()}
    return total, shares | {"bed": components.bed_variance / total}
