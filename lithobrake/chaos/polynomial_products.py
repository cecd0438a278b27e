"""Third and fourth moments of an expansion from the products of its terms, exact for any number of inputs."""

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.multi_index import Indices
from lithobrake.vocabulary.arrays import Array

Whole = NDArray[np.int64]

# Products of two terms that are worked on at once.
BLOCK_ROWS = 400_000
# With more terms even counting their products takes long.
TERM_LIMIT = 2500
LARGEST_KEY = float(2**62)
# Entries of a product below this times the largest are rounding: of even measures every second one is zero.
ROUNDING = 1e-13


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


def _varying(
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
    indices, _, entries = _varying(inputs, indices, coefficients)
    degrees = indices.max(axis=0, initial=0)
    known = all(2 * int(degree) <= entry.highest_degree for entry, degree in zip(entries, degrees, strict=True))
    # A multi-index of the square is kept as one whole number.
    if len(indices) > TERM_LIMIT or not known or float(np.prod(2.0 * degrees + 1.0)) > LARGEST_KEY:
        return np.inf
    tables = [Linearisation(entry, int(degree)) for entry, degree in zip(entries, degrees, strict=True)]
    return float(np.sum(_pair_counts(indices, tables)))


def _pair_counts(indices: Indices, tables: list[Linearisation]) -> Whole:
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
    indices, coefficients, entries = _varying(inputs, indices, coefficients)
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


def _blocks(counts: Whole) -> Iterator[tuple[int, int]]:
    """Ranges of first terms whose products fit into memory together."""
    first = 0
    while first < len(counts):
        last = first + max(1, int(np.searchsorted(np.cumsum(counts[first:]), BLOCK_ROWS)))
        yield first, min(last, len(counts))
        first = last


def _block_products(
    indices: Indices, coefficients: Array, tables: list[Linearisation], first: int, last: int
) -> tuple[Whole, Array]:
    """Keys (a number for each multi-index) and coefficients of products of terms first to last with all later ones."""
    pairs = [np.arange(i, len(indices)) for i in range(first, last)]
    left, right = np.repeat(np.arange(first, last), [len(one) for one in pairs]), np.concatenate(pairs)
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


def _summed(keys: Whole, contributions: Array) -> tuple[Whole, Array]:
    """Distinct keys in order, and the sums of their contributions [key_count, output_count]."""
    distinct, group = np.unique(keys, return_inverse=True)
    columns = [np.bincount(group, weights=column, minlength=len(distinct)) for column in contributions.T]
    return distinct, np.stack(columns, axis=1)
