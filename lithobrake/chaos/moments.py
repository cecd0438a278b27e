"""Skewness and kurtosis of an expansion: exact by products of terms or Gauss nodes, by sampling beyond."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.design import sobol_sequence
from lithobrake.chaos.evaluation import evaluate, make_plan
from lithobrake.chaos.multi_index import Indices
from lithobrake.chaos.polynomial_products import central_moments, product_count
from lithobrake.chaos.sensitivity import mean_of, variance_of
from lithobrake.chaos.threads import one_thread
from lithobrake.vocabulary.arrays import Array

# Nodes times outputs of the full grid, and entries of products, beyond which sampling takes over: seconds of work.
NODE_LIMIT = 30_000_000
PRODUCT_LIMIT = 20_000_000
# An entry of a product costs about as much as so many nodes.
NODES_PER_PRODUCT = 50
# Points of the Sobol sequence that stands in where both exact ways are too long.
SAMPLE_COUNT = 100_000


@dataclass(frozen=True)
class ShapeMoments:
    """Skewness and kurtosis (3 for a normal) of each output, [output_count]; 0 where nothing varies."""

    skewness: Array
    kurtosis: Array
    exact: bool


@one_thread()
def skewness_and_kurtosis(
    inputs: Mapping[str, Distribution],
    indices: Indices,
    coefficients: Array,
    *,
    count: int = SAMPLE_COUNT,
    seed: int = 0,
) -> ShapeMoments:
    """Moments of the expansion with these terms [term_count, input_count] and coefficients [term_count, output_count].

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
    return ShapeMoments(
        np.where(variance > 0.0, third / scale**1.5, 0.0), np.where(variance > 0.0, fourth / scale**2, 0.0), bool(exact)
    )


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
