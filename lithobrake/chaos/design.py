"""Designs by count, by grid or for a basis."""

import warnings
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.chaos.basis import Indices, basis_matrix, checked_points, multi_index_set
from lithobrake.chaos.counts import term_count
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.numerical_distributions import checked_inputs
from lithobrake.chaos.training_data import one_thread
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import random_numbers, sample_count, whole_number

# Points of one scrambled Sobol sequence: its digits have no more places.
MOST_SOBOL = 2**30
# Gauss nodes that stand for the density of one input when points are drawn from it times a squared polynomial.
RULE_NODES = 200
CANDIDATES_PER_TERM = 15


def sobol_sequence(inputs: Mapping[str, Distribution], count: int, seed: int = 0, *, skip: int = 0) -> Array:
    """First `count` points of a scrambled Sobol sequence after `skip`, physical units, [count, input_count].

    With the same seed a longer sequence starts with the shorter one, so a design can be extended.
    Raises ValueError for more than 2**30 points or numbers.
    Source: [Owen-1998], as in scipy.stats.qmc.
    """
    from scipy.stats import qmc

    distributions = checked_inputs(inputs)
    size = sample_count("count", count, len(distributions))
    passed = whole_number("skip", skip, 0, MOST_SOBOL - size)
    engine = qmc.Sobol(len(distributions), scramble=True, rng=random_numbers(seed))
    if passed:
        engine.fast_forward(passed)
    # Powers of two are advised for quadrature; a regression design needs no balance, so no warning either.
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="The balance properties of Sobol")
        uniforms = engine.random(size)
    return from_uniforms(distributions, uniforms)


def latin_hypercube(inputs: Mapping[str, Distribution], count: int, seed: int = 0) -> Array:
    """Latin hypercube in probability, physical units, shape [count, input_count]. Source: [McKay-1979]."""
    distributions = checked_inputs(inputs)
    generator, size = random_numbers(seed), sample_count("count", count, len(distributions))
    columns = [(generator.permutation(size) + generator.random(size)) / size for _ in distributions]
    return from_uniforms(distributions, np.column_stack(columns))


def sample_inputs(inputs: Mapping[str, Distribution], count: int, seed: int) -> Array:
    """Draw independent points, shape [count, input_count], in the physical units of the inputs.

    Each input has a random stream of its own, so neither another input nor a larger count changes earlier draws.
    """
    count, seed = sample_count("count", count, len(inputs), at_least=0), whole_number("seed", seed, 0)
    columns = []
    for name, entry in inputs.items():
        generator = np.random.Generator(np.random.PCG64([seed, *name.encode()]))
        # Strictly between 0 and 1, so that an unbounded distribution gives a finite value.
        columns.append(entry.ppf((generator.integers(0, 2**52, size=count) + 0.5) / 2**52))
    return np.column_stack(columns) if columns else np.empty((count, 0))


def from_uniforms(distributions: Mapping[str, Distribution], uniforms: Array) -> Array:
    """Points in physical units from probabilities, each [count, input_count]."""
    # A probability of exactly 0 or 1 would be infinite for an unbounded input.
    inner = np.clip(uniforms, 2.0**-54, 1.0 - 2.0**-53)
    return np.column_stack([entry.ppf(inner[:, k]) for k, entry in enumerate(distributions.values())])


def christoffel_weights(inputs: Mapping[str, Distribution], x: Array, indices: Indices) -> Array:
    """Least-squares weights term_count / sum_i Psi_i(x)**2 at points x [count, input_count]; result [count].

    Source: [Narayan-2017], Eq 9.
    """
    matrix = basis_matrix(inputs, indices, checked_points(inputs, x))
    return len(indices) / np.einsum("ij,ij->i", matrix, matrix)


def christoffel(inputs: Mapping[str, Distribution], count: int, seed: int = 0, *, degree: int) -> Array:
    """Random points with density (mean of Psi_i**2) times that of the inputs, physical units, [count, input_count].

    Few of them suffice for weighted least squares; take the weights from `christoffel_weights`.
    Source: [Cohen-2017], section 5.
    """
    distributions = checked_inputs(inputs)
    size, generator = sample_count("count", count, len(distributions)), random_numbers(seed)
    indices = multi_index_set(len(distributions), degree)
    # The density is a mean over terms, so a term is drawn first, and then each input from the square of its polynomial.
    powers = indices[generator.integers(len(indices), size=size)]
    uniforms = generator.random((size, len(distributions)))
    columns = []
    for k, entry in enumerate(distributions.values()):
        germ = _squared_polynomial_samples(entry, powers[:, k], uniforms[:, k])
        columns.append(np.clip(entry.physical(germ), *entry.support))
    return np.column_stack(columns)


def _squared_polynomial_samples(entry: Distribution, powers: Indices, uniforms: Array) -> Array:
    """Germs with density p_j**2 times that of the input, j = powers [count], from uniforms [count]."""
    highest = int(powers.max(initial=0))
    nodes, weights = entry.rule(max(RULE_NODES, 4 * highest))
    table = entry.recurrence(highest).values(nodes)
    # Between nodes the distribution function is taken as linear, so points are spread, not piled on nodes.
    edges = np.concatenate([[nodes[0]], 0.5 * (nodes[1:] + nodes[:-1]), [nodes[-1]]])
    germ = np.empty(len(powers))
    for power in np.unique(powers):
        rows = powers == power
        steps = np.concatenate([[0.0], np.cumsum(weights * table[power] ** 2)])
        germ[rows] = np.interp(uniforms[rows] * steps[-1], steps, edges)
    return germ


@one_thread()
def fekete(
    inputs: Mapping[str, Distribution], count: int | None = None, seed: int = 0, *, degree: int | None = None
) -> Array:
    """Approximate Fekete points of the total-degree basis, physical units, [count, input_count].

    degree: None takes the highest whose terms the count determines. count: None takes one point a term. Points beyond
    the number of terms repeat the choice among the remaining candidates. All are chosen from Christoffel-weighted
    candidates by QR with column pivoting, which keeps the determinant of the weighted basis large; unbounded inputs
    are allowed. Raises ValueError for fewer points than terms.
    Source: [Sommariva-2009].
    """
    distributions = checked_inputs(inputs)
    if count is None and degree is None:
        raise ValueError("fekete needs a count, a degree, or both, but got neither")
    if degree is None:
        degree = 0
        while term_count(len(distributions), degree + 1) <= sample_count("count", count or 0, 1):
            degree += 1
    indices = multi_index_set(len(distributions), degree)
    wanted = len(indices) if count is None else sample_count("count", count, 1)
    if wanted < len(indices):
        raise ValueError(
            f"count is {wanted}, but degree {degree} has {len(indices)} terms: give at least as many points as terms"
        )
    candidate_count = CANDIDATES_PER_TERM * max(len(indices), wanted)
    candidates = christoffel(distributions, candidate_count, degree=max(degree, 1), seed=seed)
    matrix = basis_matrix(distributions, indices, candidates)
    weighted = matrix * np.sqrt(len(indices) / np.einsum("ij,ij->i", matrix, matrix))[:, None]
    return candidates[_pivoted_choice(weighted, wanted)]


def _pivoted_choice(matrix: Array, wanted: int) -> Array:
    """Rows of matrix [candidate_count, term_count] in the order of their choice, [wanted]."""
    from scipy.linalg import qr

    left = np.arange(len(matrix))
    chosen: list[int] = []
    while len(chosen) < wanted:
        _, order = qr(matrix[left].T, mode="r", pivoting=True)
        take = order[: min(matrix.shape[1], wanted - len(chosen))]
        chosen.extend(left[take].tolist())
        left = np.delete(left, take)
    return np.array(chosen)


@one_thread()
def d_optimal(
    inputs: Mapping[str, Distribution],
    count: int,
    *,
    degree: int,
    existing: ArrayLike | None = None,
    candidates: ArrayLike | None = None,
    seed: int = 0,
) -> Array:
    """Choose `count` new points for the total-degree basis greedily by D-optimality; physical units.

    existing: points already run [any, input_count], which the new ones extend. candidates: points to choose from
    (each at most once); None: random ones weighted by Christoffel. The determinant of the information matrix grows as
    fast as one point at a time can make it. Result [count, input_count]. Raises ValueError for too few candidates.
    Source: [Fedorov-1972] (greedy exchange of D-optimality).
    """
    distributions = checked_inputs(inputs)
    indices = multi_index_set(len(distributions), degree)
    wanted = sample_count("count", count, 1)
    if candidates is None:
        size = CANDIDATES_PER_TERM * max(len(indices), wanted)
        pool = christoffel(distributions, size, degree=max(degree, 1), seed=seed)
    else:
        pool = checked_points(distributions, candidates)
    if len(pool) < wanted:
        raise ValueError(f"{wanted} points are wanted, but there are only {len(pool)} candidates: give more")
    rows = basis_matrix(distributions, indices, pool)
    # A faint prior makes the first choices well defined before the basis is determined.
    inverse = 1e8 * np.eye(len(indices))
    if existing is not None:
        old = basis_matrix(distributions, indices, checked_points(distributions, existing))
        inverse = np.asarray(np.linalg.inv(1e-8 * np.eye(len(indices)) + old.T @ old), dtype=np.float64)
    return pool[_greedy_choice(rows, inverse, wanted)]


def _greedy_choice(rows: Array, inverse: Array, wanted: int) -> list[int]:
    """Rows [candidate_count, term_count] of largest variance one after another; inverse of the information matrix."""
    gain = np.einsum("ij,jk,ik->i", rows, inverse, rows, optimize=True)
    chosen: list[int] = []
    for _ in range(wanted):
        best = int(np.argmax(gain))
        chosen.append(best)
        # A point adds a matrix of rank one to the information matrix, whose inverse then needs no new inversion.
        step = inverse @ rows[best] / np.sqrt(1.0 + rows[best] @ inverse @ rows[best])
        inverse = inverse - np.outer(step, step)
        gain = gain - (rows @ step) ** 2
        gain[chosen] = -np.inf
    return chosen
