"""Skewness and kurtosis of an expansion: exact by products of terms or Gauss nodes, by sampling beyond."""

from typing import Any

import numpy as np

from lithobrake.chaos.design import sobol_sequence
from lithobrake.chaos.polynomial_products import central_moments, product_count
from lithobrake.chaos.polynomials import Array
from lithobrake.chaos.surrogate import Surrogate
from lithobrake.chaos.threads import one_thread

# Nodes times outputs of the full grid, and shares of products, beyond which sampling takes over: seconds of work.
NODE_LIMIT = 30_000_000
PRODUCT_LIMIT = 20_000_000
# A share of a product costs about as much as so many nodes.
NODES_PER_PRODUCT = 50


@one_thread()
def shape_moments(surrogate: Surrogate, *, count: int = 100_000, seed: int = 0) -> dict[str, Any]:
    """Skewness and kurtosis (3 for a normal) of each output, [output_count] or numbers; 0 where nothing varies.

    "exact" says whether they are. Two ways are, and the cheaper is taken: the square of the expansion written as an
    expansion, and a full grid of Gauss nodes, of which 2 d + 1 an input integrate a fourth power without error. Beyond
    twenty million shares of products and thirty million nodes, `count` points of a scrambled Sobol sequence stand in.
    Source: Xiu, 2010, "Numerical Methods for Stochastic Computations", section 5.3 (moments from an expansion).
    """
    degrees = surrogate.multi_indices.max(axis=0)
    rules = [entry.gauss(2 * int(d) + 1) for entry, d in zip(surrogate.inputs.values(), degrees, strict=True) if d > 0]
    nodes = float(np.prod([float(len(one)) for one, _ in rules])) * len(surrogate.output_names)
    products = product_count(surrogate)
    exact = nodes <= NODE_LIMIT or products <= PRODUCT_LIMIT
    if not exact:
        third, fourth = _by_sampling(surrogate, count, seed)
    elif products <= PRODUCT_LIMIT and NODES_PER_PRODUCT * products < nodes:
        third, fourth = central_moments(surrogate)
    else:
        third, fourth = _by_grid(surrogate, rules)
    variance = np.atleast_1d(surrogate.variance)
    scale = np.where(variance > 0.0, variance, 1.0)
    return {
        "skewness": surrogate.shaped(np.where(variance > 0.0, third / scale**1.5, 0.0)),
        "kurtosis": surrogate.shaped(np.where(variance > 0.0, fourth / scale**2, 0.0)),
        "exact": bool(exact),
    }


def _by_grid(surrogate: Surrogate, rules: list[tuple[Array, Array]]) -> tuple[Array, Array]:
    """Third and fourth central moments [output_count] on the full grid, one slice of the first input at a time.

    The sum over terms is taken input by input, so a node costs about as much as one input has degrees, not terms.
    """
    degrees = surrogate.multi_indices.max(axis=0)
    active = [k for k, degree in enumerate(degrees) if degree > 0]
    coefficients = surrogate.coefficients.reshape(surrogate.term_count, -1)
    central = coefficients * (surrogate.multi_indices.sum(axis=1) > 0)[:, None]
    dense = np.zeros((*(degrees[active] + 1), coefficients.shape[1]))
    np.add.at(dense, tuple(surrogate.multi_indices[:, active].T), central)
    if not active:
        return np.zeros(coefficients.shape[1]), np.zeros(coefficients.shape[1])
    entries = list(surrogate.inputs.values())
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


def _by_sampling(surrogate: Surrogate, count: int, seed: int) -> tuple[Array, Array]:
    """Third and fourth central moments [output_count] over a Sobol sequence."""
    points = sobol_sequence(surrogate.inputs, count, seed=seed)
    outputs = np.asarray(surrogate(points)).reshape(len(points), -1)
    central = outputs - np.atleast_1d(surrogate.mean)
    return np.mean(central**3, axis=0), np.mean(central**4, axis=0)
