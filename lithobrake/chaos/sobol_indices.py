"""Sobol indices, skewness and kurtosis of an expansion, from its coefficients and the products of its terms."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.basis import Indices
from lithobrake.chaos.design import sobol_sequence
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.evaluation import evaluate, make_plan
from lithobrake.chaos.training_data import one_thread
from lithobrake.vocabulary.array_types import Array, Integers

# Products of two terms that are worked on at once.
BLOCK_ROWS = 400_000
# With more terms even counting their products takes long.
TERM_LIMIT = 2500
LARGEST_KEY = float(2**62)
# Entries of a product below this times the largest are rounding: of even measures every second one is zero.
ROUNDING = 1e-13
# Nodes times outputs of the full grid, and entries of products, beyond which sampling takes over: seconds of work.
NODE_LIMIT = 30_000_000
PRODUCT_LIMIT = 20_000_000
# An entry of a product costs about as much as so many nodes.
NODES_PER_PRODUCT = 50
# Points of the Sobol sequence that stands in where both exact ways are too long.
SAMPLE_COUNT = 100_000


class Linearisation:
    """p_a p_b = sum_k L_abk p_k for one input, the zeros left out.

    first, count [degree + 1, degree + 1]: where the entries of a pair (a, b) begin, and how many there are;
    power, value [entry_count]: k and L_abk; base: number of powers that a product can have.
    Source: [Xiu-2010], section 6.1 (triple products).
    """

    def __init__(self, entry: Distribution, degree: int) -> None:
        self.base = 2 * degree + 1
        nodes, weights = entry.gauss(2 * degree + 1)
        table = entry.recurrence(2 * degree).values(nodes)
        product = np.einsum("aq,bq,kq->abk", table[: degree + 1], table[: degree + 1], table * weights, optimize=True)
        largest = np.abs(product).max(axis=2, keepdims=True)
        a, b, self.power = np.nonzero(np.abs(product) > ROUNDING * largest)
        self.value = product[a, b, self.power]
        self.count = np.bincount(a * (degree + 1) + b, minlength=(degree + 1) ** 2).astype(np.int64)
        self.first = (np.cumsum(self.count) - self.count).reshape(degree + 1, degree + 1)
        self.count = self.count.reshape(degree + 1, degree + 1)


def _varying_inputs(
    inputs: Mapping[str, Distribution], indices: Indices, coefficients: Array
) -> tuple[Indices, Array, list[Distribution]]:
    """Terms other than the constant, their coefficients, and inputs that occur: what the moments are made of."""
    entries = list(inputs.values())
    active = np.nonzero(indices.max(axis=0) > 0)[0]
    kept = indices.sum(axis=1) > 0
    return indices[kept][:, active], coefficients[kept], [entries[k] for k in active]


def product_count(inputs: Mapping[str, Distribution], indices: Indices, coefficients: Array) -> float:
    """Entries of products that `central_moments` adds up; infinite where it cannot be used.

    Samples may not determine polynomials of twice the degree, in which products are written.
    """
    indices, _, entries = _varying_inputs(inputs, indices, coefficients)
    degrees = indices.max(axis=0, initial=0)
    known = all(2 * int(degree) <= entry.highest_degree for entry, degree in zip(entries, degrees, strict=True))
    # A multi-index of the square is kept as one whole number.
    if len(indices) > TERM_LIMIT or not known or float(np.prod(2.0 * degrees + 1.0)) > LARGEST_KEY:
        return np.inf
    tables = [Linearisation(entry, int(degree)) for entry, degree in zip(entries, degrees, strict=True)]
    return float(np.sum(_pair_counts(indices, tables)))


def _pair_counts(indices: Indices, tables: list[Linearisation]) -> Integers:
    """Number of entries of the products of each term with itself and later ones, [term_count]."""
    counts = np.empty(len(indices), dtype=np.int64)
    for i, row in enumerate(indices):
        entries = np.ones(len(indices) - i, dtype=np.int64)
        for table, power, column in zip(tables, row, indices[i:].T, strict=True):
            entries *= table.count[power, column]
        counts[i] = entries.sum()
    return counts


def central_moments(inputs: Mapping[str, Distribution], indices: Indices, coefficients: Array) -> tuple[Array, Array]:
    """Third and fourth central moments of each output, [output_count] each.

    indices [term_count, input_count]; coefficients [term_count, output_count] of the orthonormal terms.

    The square of the expansion without its mean is expanded itself; its product with the expansion and its own square
    have the means that are wanted, since the polynomials are orthonormal.
    """
    indices, coefficients, entries = _varying_inputs(inputs, indices, coefficients)
    if not len(indices):
        return np.zeros(coefficients.shape[1]), np.zeros(coefficients.shape[1])
    tables = [Linearisation(entry, int(degree)) for entry, degree in zip(entries, indices.max(axis=0), strict=True)]
    keys, square = np.zeros(0, dtype=np.int64), np.zeros((0, coefficients.shape[1]))
    for first, last in _blocks(_pair_counts(indices, tables)):
        more_keys, more = _block_products(indices, coefficients, tables, first, last)
        keys, square = _summed(np.concatenate([keys, more_keys]), np.concatenate([square, more]))
    own = np.zeros(len(indices), dtype=np.int64)
    for table, column in zip(tables, indices.T, strict=True):
        own = own * table.base + column
    place = np.minimum(np.searchsorted(keys, own), len(keys) - 1)
    found = keys[place] == own
    third = np.einsum("ij,ij->j", square[place[found]], coefficients[found])
    return third, np.einsum("ij,ij->j", square, square)


def _blocks(counts: Integers) -> Iterator[tuple[int, int]]:
    """Ranges of first terms whose products fit into memory together."""
    first = 0
    while first < len(counts):
        last = first + max(1, int(np.searchsorted(np.cumsum(counts[first:]), BLOCK_ROWS)))
        yield first, min(last, len(counts))
        first = last


def _block_products(
    indices: Indices, coefficients: Array, tables: list[Linearisation], first: int, last: int
) -> tuple[Integers, Array]:
    """Keys (a number for each multi-index) and coefficients of products of terms first to last with all later ones."""
    pairs = [np.arange(i, len(indices)) for i in range(first, last)]
    left, right = np.repeat(np.arange(first, last), [len(one) for one in pairs]), np.concatenate(pairs)
    # In the square each product of two different terms occurs twice.
    contributions = coefficients[left] * coefficients[right] * np.where(left == right, 1.0, 2.0)[:, None]
    keys = np.zeros(len(left), dtype=np.int64)
    for table, column in zip(tables, indices.T, strict=True):
        count = table.count[column[left], column[right]]
        start = table.first[column[left], column[right]]
        rows = np.repeat(np.arange(len(left)), count)
        entry = np.arange(len(rows)) + np.repeat(start - np.cumsum(count) + count, count)
        keys = keys[rows] * table.base + table.power[entry]
        contributions = contributions[rows] * table.value[entry][:, None]
        left, right = left[rows], right[rows]
    return _summed(keys, contributions)


def _summed(keys: Integers, contributions: Array) -> tuple[Integers, Array]:
    """Distinct keys in order, and the sums of their contributions [key_count, output_count]."""
    distinct, group = np.unique(keys, return_inverse=True)
    columns = [np.bincount(group, weights=column, minlength=len(distinct)) for column in contributions.T]
    return distinct, np.stack(columns, axis=1)


def _shares(indices: Indices, coefficients: Array, chosen: NDArray[np.bool_]) -> Array:
    """Share of the variance in groups of terms, chosen [group_count, term_count]; 0 where an output does not vary."""
    squares = coefficients**2 * _varying(indices)[:, None]
    variance = squares.sum(axis=0)
    shares = np.zeros((len(chosen), len(variance)))
    return np.divide(chosen.astype(float) @ squares, variance, out=shares, where=variance > 0)


def _varying(indices: Indices) -> NDArray[np.bool_]:
    return indices.sum(axis=1) > 0


def mean_of(indices: Indices, coefficients: Array) -> Array:
    """Mean of each output [output_count]: the constant term. Source: [Landings-PCE], Eq 18."""
    return coefficients[~_varying(indices)].sum(axis=0)


def variance_of(indices: Indices, coefficients: Array) -> Array:
    """Variance of each output [output_count]. Source: [Landings-PCE], Eq 21, with orthonormal polynomials."""
    return (coefficients[_varying(indices)] ** 2).sum(axis=0)


def first_order(indices: Indices, coefficients: Array) -> Array:
    """First-order Sobol indices [input_count, output_count]. Source: [Landings-PCE], Eq 23; [Sudret-2008]."""
    active = indices > 0
    return _shares(indices, coefficients, (active & (active.sum(axis=1) == 1)[:, None]).T)


def total_order(indices: Indices, coefficients: Array) -> Array:
    """Total Sobol indices [input_count, output_count]. Source: [Sudret-2008], Eq 36."""
    return _shares(indices, coefficients, (indices > 0).T)


def group_share(indices: Indices, coefficients: Array, members: Sequence[int]) -> Array:
    """Share of the variance in all terms of these inputs only (closed index), [output_count]. Source: [Sobol-2001]."""
    others = [k for k in range(indices.shape[1]) if k not in set(members)]
    inside = (indices[:, others].sum(axis=1) == 0) & _varying(indices)
    return _shares(indices, coefficients, inside[None, :])[0]


def interaction(indices: Indices, coefficients: Array, members: Sequence[int]) -> Array:
    """Sobol index of exactly this set of inputs, [output_count]. Source: [Sudret-2008], Eq 35."""
    wanted = np.isin(np.arange(indices.shape[1]), list(members))
    return _shares(indices, coefficients, ((indices > 0) == wanted).all(axis=1)[None, :])[0]


@one_thread()
def skewness_and_kurtosis(
    inputs: Mapping[str, Distribution],
    indices: Indices,
    coefficients: Array,
    *,
    count: int = SAMPLE_COUNT,
    seed: int = 0,
) -> tuple[Array, Array, bool]:
    """Skewness and kurtosis (3 for a normal) of each output [output_count], 0 where nothing varies; whether exact.

    Of the expansion with these terms [term_count, input_count] and coefficients [term_count, output_count].
    Two ways are exact, and the cheaper is taken: the square of the expansion written as an expansion, and a full grid
    of Gauss nodes, of which 2 d + 1 an input integrate a fourth power without error. Beyond twenty million entries of
    products and thirty million nodes, `count` points of a scrambled Sobol sequence stand in.
    Source: [Xiu-2010], section 5.3 (moments from an expansion).
    """
    degrees = indices.max(axis=0)
    rules = [entry.gauss(2 * int(d) + 1) for entry, d in zip(inputs.values(), degrees, strict=True) if d > 0]
    nodes = float(np.prod([float(len(one)) for one, _ in rules])) * coefficients.shape[1]
    products = product_count(inputs, indices, coefficients)
    exact = nodes <= NODE_LIMIT or products <= PRODUCT_LIMIT
    if not exact:
        third, fourth = _by_sampling(inputs, indices, coefficients, count, seed)
    elif products <= PRODUCT_LIMIT and NODES_PER_PRODUCT * products < nodes:
        third, fourth = central_moments(inputs, indices, coefficients)
    else:
        third, fourth = _by_grid(inputs, indices, coefficients, rules)
    variance = variance_of(indices, coefficients)
    scale = np.where(variance > 0.0, variance, 1.0)
    skewness, kurtosis = third / scale**1.5, fourth / scale**2
    return np.where(variance > 0.0, skewness, 0.0), np.where(variance > 0.0, kurtosis, 0.0), bool(exact)


def _by_grid(
    inputs: Mapping[str, Distribution], indices: Indices, coefficients: Array, rules: list[tuple[Array, Array]]
) -> tuple[Array, Array]:
    """Third and fourth central moments [output_count] on the full grid, one slice of the first input at a time.

    The sum over terms is taken input by input, so a node costs about as much as one input has degrees, not terms.
    """
    degrees = indices.max(axis=0)
    active = [k for k, degree in enumerate(degrees) if degree > 0]
    central = coefficients * (indices.sum(axis=1) > 0)[:, None]
    dense = np.zeros((*(degrees[active] + 1), coefficients.shape[1]))
    np.add.at(dense, tuple(indices[:, active].T), central)
    if not active:
        return np.zeros(coefficients.shape[1]), np.zeros(coefficients.shape[1])
    entries = list(inputs.values())
    tables = [entries[k].recurrence(int(degrees[k])).values(nodes) for k, (nodes, _) in zip(active, rules, strict=True)]
    weights = np.ones(1)
    for _, one in rules[1:]:
        weights = np.multiply.outer(weights, one).ravel()
    third, fourth = np.zeros(coefficients.shape[1]), np.zeros(coefficients.shape[1])
    for node, weight in zip(tables[0].T, rules[0][1], strict=True):
        part = np.tensordot(node, dense, axes=(0, 0))
        for table in tables[1:]:
            # The axis of the next input is always the first; that of its nodes goes to the end.
            part = np.tensordot(part, table, axes=(0, 0))
        values = part.reshape(coefficients.shape[1], -1)
        cubes = values * values * values
        third += weight * (cubes @ weights)
        fourth += weight * ((cubes * values) @ weights)
    return third, fourth


def _by_sampling(
    inputs: Mapping[str, Distribution], indices: Indices, coefficients: Array, count: int, seed: int
) -> tuple[Array, Array]:
    """Third and fourth central moments [output_count] over a Sobol sequence."""
    points = sobol_sequence(inputs, count, seed=seed)
    central = evaluate(inputs, make_plan(inputs, indices, coefficients), points) - mean_of(indices, coefficients)
    return np.mean(central**3, axis=0), np.mean(central**4, axis=0)
