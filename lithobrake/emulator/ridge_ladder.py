"""Location and scale: ridges that walk from no inputs to a linear, a quadratic and, with many runs, a cubic law.

A rung says which inputs a ridge uses, by what factor products and squares (and cubes) count beside the linear terms of
an orthonormal basis, and under what penalty. Rungs are averaged by their evidence, the marginal likelihood of the data
with the terms' coefficients as normal: one rung alone would follow the luck of its choice. The average is a polynomial
chaos expansion again. Source: [Hoerl-1970] (ridge); [Hoeting-1999] (averaging).
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import groupby, product

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.basis import basis_matrix
from lithobrake.chaos.multi_index import Indices, multi_index_set
from lithobrake.vocabulary.arrays import Array

# Finer steps of factors and penalties gave the same errors.
SECOND_FACTORS = (0.0, 0.4)
THIRD_FACTORS = (0.0, 0.15)
# Cubic terms of five inputs are 35: with fewer runs than this they are mostly noise.
CUBIC_FROM = 500
# With more inputs than this a ridge has no products and squares, and no ladder cubes: of thirty inputs there are 465,
# for each of as many sets of inputs, which takes minutes and tells more than any runs do.
MOST_OF_SECOND_DEGREE = 12
# Penalties in units of the number of runs: of a term of an orthonormal basis 1 / (1 + penalty) is left.
PENALTIES = (1e-5, 1e-4, 1e-3, 1e-2, 3e-2, 0.1, 0.3, 1.0)
# Rungs of less weight are left out of the average.
LEAST_WEIGHT = 0.005


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


def terms_up_to(inputs: Mapping[str, Distribution], degree: int) -> Terms:
    """All terms up to a total degree, as far as the inputs determine them."""
    highest = [int(min(degree, entry.highest_degree)) for entry in inputs.values()]
    return Terms(dict(inputs), multi_index_set(len(inputs), degree, max_degrees=highest)[1:])


@dataclass(frozen=True)
class Rung:
    """A ridge on these inputs: factors of second and third block, penalty, and weight in the average of a ladder."""

    inputs: tuple[int, ...]
    second: float
    third: float
    penalty: float
    weight: float = 1.0

    def factors(self, indices: Indices) -> Array:
        """Factor of each term [term_count]; 0 leaves it out."""
        others = [k for k in range(indices.shape[1]) if k not in self.inputs]
        inside = (indices[:, others] == 0).all(axis=1)
        return np.array([0.0, 1.0, self.second, self.third])[indices.sum(axis=1)] * inside


# What of an average is not there is no inputs at all.
Ladder = tuple[Rung, ...]


def highest_degree(run_count: int, input_count: int) -> int:
    """Total degree of the terms that a ladder looks at."""
    return 3 if run_count > CUBIC_FROM and input_count <= MOST_OF_SECOND_DEGREE else 2


def best_ladder(indices: Indices, matrix: Array, target: Array) -> Ladder:
    """Rungs and their weights for a target [count]; matrix: terms without the constant [count, term_count].

    Inputs are added one at a time, the one of most evidence first; all rungs on the way enter the average.
    """
    centred, y = matrix - matrix.mean(axis=0), target - target.mean()
    gram, moments, total, count = centred.T @ centred, centred.T @ y, float(y @ y), len(y)
    if total <= 1e-24 * count * float(np.abs(target).max()) ** 2:
        return ()
    # No inputs have the evidence 0, from which the others are counted.
    rungs: list[tuple[float, Rung]] = []
    used: tuple[int, ...] = ()
    left = set(range(indices.shape[1]))
    while left:
        best, added = -np.inf, 0
        for one in sorted(left):
            found = list(_rungs(indices, tuple(sorted((*used, one))), gram, moments, total, count))
            rungs += found
            most = max(evidence for evidence, _ in found)
            best, added = (most, one) if most > best else (best, added)
        used, left = (*used, added), left - {added}
    return _averaged(rungs)


def _rungs(
    indices: Indices, inputs: tuple[int, ...], gram: Array, moments: Array, total: float, count: int
) -> Iterator[tuple[float, Rung]]:
    """Rungs on these inputs with their evidence, the logarithm of their marginal likelihood over that of no inputs."""
    degree = int(indices.sum(axis=1).max()) if len(inputs) <= MOST_OF_SECOND_DEGREE else 1
    seconds, thirds = SECOND_FACTORS if degree > 1 else (0.0,), THIRD_FACTORS if degree > 2 else (0.0,)
    for second, third in product(seconds, thirds):
        factors = Rung(inputs, second, third, 0.0).factors(indices)
        kept = factors > 0.0
        scaled = factors[kept]
        values, vectors = np.linalg.eigh(scaled[:, None] * gram[np.ix_(kept, kept)] * scaled)
        squares = (vectors.T @ (scaled * moments[kept])) ** 2
        values = np.maximum(values, 0.0)
        ridges = count * np.array(PENALTIES)[:, None]
        unexplained = np.maximum(1.0 - (squares / (values + ridges)).sum(axis=1) / total, 1e-12)
        evidences = -0.5 * ((count - 1.0) * np.log(unexplained) + np.log1p(values / ridges).sum(axis=1))
        for penalty, evidence in zip(PENALTIES, evidences.tolist(), strict=True):
            yield evidence, Rung(inputs, second, third, penalty)


def _averaged(rungs: list[tuple[float, Rung]]) -> Ladder:
    """Rungs weighted by their evidence; those of little weight and no inputs at all take part in the sum alone."""
    evidences = np.array([evidence for evidence, _ in rungs])
    most = max(0.0, float(evidences.max()))
    weights = np.exp(evidences - most)
    weights /= weights.sum() + np.exp(-most)
    kept = weights >= LEAST_WEIGHT
    share = weights.sum() / weights[kept].sum() if kept.any() else 1.0
    return tuple(
        Rung(rung.inputs, rung.second, rung.third, rung.penalty, float(weight * share))
        for (_, rung), weight, keep in zip(rungs, weights, kept, strict=True)
        if keep
    )


def averaged_ridge(
    indices: Indices, matrix: Array, target: Array, ladder: Ladder, weights: Array
) -> tuple[Array, Array]:
    """Coefficients [1 + term_count], the constant first, and leave-one-out residuals [count] of one target [count].

    weights: how often each run counts [count]. The residual of a run leaves out one of its copies.
    """
    total = weights.sum()
    mean, centre = weights @ target / total, weights @ matrix / total
    centred = matrix - centre
    gram = centred.T @ (weights[:, None] * centred)
    # The average of ridges is one linear smoother, of which this is the inverse that ridges have in common.
    inverse = np.zeros_like(gram)
    # Rungs that differ in their penalty alone have their eigenvectors in common.
    for _, alike in groupby(ladder, key=lambda rung: (rung.inputs, rung.second, rung.third)):
        rungs = list(alike)
        factors = rungs[0].factors(indices)
        kept = np.nonzero(factors)[0]
        scaled = factors[kept]
        values, vectors = np.linalg.eigh(scaled[:, None] * gram[np.ix_(kept, kept)] * scaled)
        damped = sum(rung.weight / (np.maximum(values, 0.0) + rung.penalty * total) for rung in rungs)
        inverse[np.ix_(kept, kept)] += scaled[:, None] * ((vectors * damped) @ vectors.T) * scaled
    slopes = inverse @ (centred.T @ (weights * (target - mean)))
    leverage = 1.0 / total + ((centred @ inverse) * centred).sum(axis=1)
    # A run that its fit passes through has no residual to inflate.
    residual = (target - mean - centred @ slopes) / np.maximum(1.0 - leverage, 0.05)
    return np.append(mean - centre @ slopes, slopes), residual


def degree_of(ladder: Ladder) -> int:
    """Total degree that most of a ladder's weight stands on, at least 1."""
    if sum(rung.weight for rung in ladder if rung.third > 0.0) > 0.5:
        return 3
    return 2 if sum(rung.weight for rung in ladder if rung.second > 0.0) > 0.5 else 1
