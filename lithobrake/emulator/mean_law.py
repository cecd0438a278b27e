"""Mean law E[y | x] as an expansion, its terms, and which inputs change the outputs at all."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from lithobrake.chaos.basis import Indices, basis_matrix, multi_index_set
from lithobrake.chaos.counts import term_count
from lithobrake.chaos.distributions import Distribution
from lithobrake.emulator.ridge_ladder import Ladder
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import finite_number, random_numbers

# Of few inputs the total degree is as high as this many terms allow, of many it is two; powers of one input alone go to
# the fifth degree at least.
MOST_TERMS = 220
HIGHEST_DEGREE, OWN_DEGREE, LEAST_DEGREE = 12, 5, 2
# Polynomials grow where an input has no end, and runs are few.
OF_UNBOUNDED = 3
# With more inputs than this there are no products: of thirty inputs there are 435, which tell more than runs do.
MOST_OF_SECOND_DEGREE = 20
# Least squares with fewer runs to a term has standard errors that are themselves hardly known.
RUNS_PER_TERM = 4
MEAN_LAW_DEGREE = 5
PERMUTATIONS = 399


@dataclass(frozen=True)
class Terms:
    """Multi-indices [term_count, input_count] by total degree, the constant left out: linear terms come first, in the
    order of the inputs, and each has variance 1 over the law of its input.
    """

    inputs: dict[str, Distribution]
    indices: Indices

    @property
    def degrees(self) -> NDArray[np.int64]:
        """Total degree of each term [term_count]."""
        return self.indices.sum(axis=1)

    def matrix(self, points: Array) -> Array:
        """Terms at points in physical units [count, input_count], shape [count, term_count]."""
        return np.ascontiguousarray(basis_matrix(self.inputs, self.indices, points))


def candidate_terms(inputs: Mapping[str, Distribution]) -> Terms:
    """All terms that an emulator looks at, as far as the inputs determine them."""
    count = len(inputs)
    least = LEAST_DEGREE if count <= MOST_OF_SECOND_DEGREE else 1
    degrees = range(least, HIGHEST_DEGREE + 1)
    degree = max((one for one in degrees if term_count(count, one) <= MOST_TERMS), default=least)
    limits = [min(HIGHEST_DEGREE if one.bounded else OF_UNBOUNDED, one.highest_degree) for one in inputs.values()]
    together = multi_index_set(count, degree, max_degrees=[int(min(degree, one)) for one in limits])[1:]
    own = np.eye(count, dtype=np.int64)
    alone = [power * own[[power <= one for one in limits]] for power in range(degree + 1, OWN_DEGREE + 1)]
    return Terms(dict(inputs), np.vstack([together, *alone]))


def terms_up_to(inputs: Mapping[str, Distribution], degree: int) -> Terms:
    """All terms up to a total degree, as far as the inputs determine them."""
    highest = [int(min(degree, entry.highest_degree)) for entry in inputs.values()]
    return Terms(dict(inputs), multi_index_set(len(inputs), degree, max_degrees=highest)[1:])


@dataclass(frozen=True)
class MeanLaw:
    """mean [output_count] of the output; variance [output_count] of E[y | x] over the inputs, and share, what that is
    of the variance of the output. sobol_first, sobol_total [input_count, output_count]: shares of the variance of
    E[y | x]; 0 where there is none.
    """

    mean: Array
    variance: Array
    share: Array
    sobol_first: Array
    sobol_total: Array


def mean_law(
    inputs: Mapping[str, Distribution], x: Array, target: Array, ladders: Sequence[Ladder], weights: Array
) -> MeanLaw:
    """Fit the mean law of targets [run_count, output_count] with these ladders [output_count].

    x: [run_count, input_count] in physical units; weights: how often each run counts [run_count].
    """
    terms = terms_up_to(inputs, max(_degree(ladder, len(inputs), weights) for ladder in ladders))
    matrix = terms.matrix(x)
    columns = [
        _one_output(terms, matrix, y, _degree(ladder, len(inputs), weights), weights)
        for y, ladder in zip(target.T, ladders, strict=True)
    ]
    mean, variance, share, first, total = zip(*columns, strict=True)
    return MeanLaw(np.array(mean), np.array(variance), np.array(share), np.column_stack(first), np.column_stack(total))


def _degree(ladder: Ladder, input_count: int, weights: Array) -> int:
    """Highest degree that most of a ladder's weight stands on and the runs support, at least 1."""
    degrees = [d for d in range(2, MEAN_LAW_DEGREE + 1) if sum(one.weight for one in ladder if one.degree >= d) > 0.5]
    runs = RUNS_PER_TERM * np.array([term_count(input_count, d) - 1 for d in degrees])
    return max([d for d, needed in zip(degrees, runs, strict=True) if needed <= weights.sum()], default=1)


def _one_output(
    terms: Terms, matrix: Array, y: Array, degree: int, weights: Array
) -> tuple[float, float, float, Array, Array]:
    """Mean, variance, share, first-order and total indices [input_count] of one output [run_count]."""
    used = terms.degrees <= degree
    indices = terms.indices[used]
    squares, mean = noise_freed_squares(matrix[:, used], y, weights)
    variance = max(0.0, float(squares.sum()))
    spread = float(weights @ (y - weights @ y / weights.sum()) ** 2 / weights.sum())
    active = indices > 0
    alone = active & (active.sum(axis=1) == 1)[:, None]
    shares = [np.clip(group.T @ squares, 0.0, None) for group in (alone.astype(float), active.astype(float))]
    scaled = [np.minimum(share / variance, 1.0) if variance > 0.0 else 0.0 * share for share in shares]
    return mean, variance, variance / spread if spread > 0.0 else 0.0, scaled[0], scaled[1]


def noise_freed_squares(matrix: Array, y: Array, weights: Array) -> tuple[Array, float]:
    """Squares of least-squares coefficients less their variances [term_count], and the constant.

    The variances hold whatever the scatter does with the inputs. Source: [MacKinnon-1985], HC2.
    """
    full = np.column_stack([np.ones(len(matrix)), matrix])
    inverse = np.linalg.pinv(full.T @ (weights[:, None] * full))
    coefficients = inverse @ (full.T @ (weights * y))
    influence = full @ inverse
    # A run of nearly full leverage has next to no residual, by which its variance cannot be told.
    leverage = np.minimum((influence * full).sum(axis=1), 0.95)
    residual = (y - full @ coefficients) ** 2 / (1.0 - leverage)
    variances = (weights * residual) @ influence**2
    return (coefficients**2 - variances)[1:], float(coefficients[0])


def found_inputs(
    inputs: Mapping[str, Distribution], x: Array, targets: Array, level: float, seed: int
) -> NDArray[np.bool_]:
    """Say for each input [input_count] whether it changes the mean of any target [run_count, target_count].

    x: [run_count, input_count] in physical units. level: chance that no input is found where none has an effect.
    """
    terms = terms_up_to(inputs, 2)
    matrix = terms.matrix(x)
    finite_number("level", level, above=0.0, below=1.0)
    random = random_numbers(seed)
    varying = targets[:, np.ptp(targets, axis=0) > 0.0]
    if varying.shape[1] == 0:
        return np.zeros(len(terms.inputs), dtype=bool)
    orders = [random.permutation(len(targets)) for _ in range(PERMUTATIONS)]
    # All permutations are columns of one table: the terms, and so their factorisation, stay the same.
    table = np.concatenate([varying, *(varying[order] for order in orders)], axis=1)
    evidence = _evidence(terms, matrix, table).reshape(len(terms.inputs), 1 + PERMUTATIONS, -1).max(axis=2)
    limit = np.quantile(evidence[:, 1:].max(axis=0), level, method="higher")
    return np.asarray(evidence[:, 0] > limit)


def _evidence(terms: Terms, matrix: Array, table: Array) -> Array:
    """Evidence for each input and column, [input_count, column_count]: the larger of that of its linear term and that
    of all its terms up to the second degree, as the negative logarithm of the chance of as large an F by luck.
    """
    degrees = [1, 2] if RUNS_PER_TERM * (terms.degrees <= 2).sum() <= len(matrix) else [1]
    centred = table - table.mean(axis=0)
    evidence = np.full((len(terms.inputs), table.shape[1]), -np.inf)
    for degree in degrees:
        used = terms.degrees <= degree
        columns, active = matrix[:, used] - matrix[:, used].mean(axis=0), terms.indices[used] > 0
        freedom = len(matrix) - 1 - columns.shape[1]
        if freedom < 1:
            # As many terms as runs explain whatever there is.
            continue
        left = _unexplained(columns, centred)
        for k in range(len(terms.inputs)):
            without = _unexplained(columns[:, ~active[:, k]], centred)
            count = int(active[:, k].sum())
            # What rounding leaves of outputs without scatter is no scatter.
            ratio = (without - left) / count / (np.maximum(left, 1e-12 * (centred**2).sum(axis=0)) / freedom)
            evidence[k] = np.maximum(evidence[k], -stats.f.logsf(ratio, count, freedom))
    return evidence


def _unexplained(columns: Array, table: Array) -> Array:
    """Sum of squares of each column of a table that least squares on these columns leaves."""
    basis = np.linalg.qr(columns)[0]
    return (table**2).sum(axis=0) - ((basis.T @ table) ** 2).sum(axis=0)
