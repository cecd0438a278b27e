"""Grids of nodes: tensors of Gauss nodes, and the sparse grid of [Landings-PCE] of nested Clenshaw-Curtis nodes."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from lithobrake.chaos.counts import check_level, smolyak_count
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.numerical_distributions import checked_inputs
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import whole_number

MOST_NODES = 10_000_000


def new_nodes(level: int) -> Array:
    """Clenshaw-Curtis nodes on [-1, 1] that a level adds to the one below: m(0) = 1, m(l) = 2**l + 1.

    A node is computed at the level where it first appears and nowhere else: nested to the last bit by construction.
    Source: [Clenshaw-1960]; extrema of Chebyshev polynomials.
    """
    if level == 0:
        return np.zeros(1)
    if level == 1:
        return np.array([-1.0, 1.0])
    half = 2 ** (level - 1)
    steps = np.arange(1 - half, half, 2)
    # The sine of an angle counted from the middle is odd to the last bit, so the nodes are symmetric; a cosine is not.
    return np.sin(np.pi * steps / (2.0 * half))


def _levels_of(input_count: int, total: int) -> list[tuple[int, ...]]:
    """All vectors of one-dimensional levels that sum to a total, in falling lexicographic order."""
    if input_count == 1:
        return [(total,)]
    return [(first, *rest) for first in range(total, -1, -1) for rest in _levels_of(input_count - 1, total - first)]


def smolyak(inputs: Mapping[str, Distribution], level: int) -> Array:
    """Sparse-grid nodes in physical units, shape [node_count, input_count].

    The order is by total level, so the nodes of a lower level are the first rows, bit for bit, of a higher one.
    Raises ValueError for an unbounded input (limit it, or choose another design), for a level out of range, and
    for more than ten million nodes.
    Source: [Smolyak-1963]; [Landings-PCE], "Polynomial chaos expansion" and Fig 3.
    """
    check_level(level)
    distributions = checked_inputs(inputs)
    for name, entry in distributions.items():
        if not entry.bounded:
            raise ValueError(
                f"input {name!r} is {entry.kind} with support {entry.support}, but a Smolyak grid needs finite limits: "
                "use TruncatedNormal, Uniform or Beta, or the designs sobol_sequence, latin_hypercube, fekete"
            )
    count = smolyak_count(len(distributions), int(level))
    if count > MOST_NODES:
        raise ValueError(
            f"level is {level}, of which a Smolyak grid in {len(distributions)} inputs has {count} nodes, but at most "
            f"{MOST_NODES} are made: lower it"
        )
    germ_rows: list[Array] = []
    for total in range(int(level) + 1):
        for levels in _levels_of(len(distributions), total):
            germ_rows.append(np.array(list(product(*(new_nodes(one) for one in levels)))))
    germs = np.concatenate(germ_rows)
    return np.column_stack([entry.physical(germs[:, k]) for k, entry in enumerate(distributions.values())])


def tensor_grid(inputs: Mapping[str, Distribution], level: int | Sequence[int]) -> Array:
    """Full tensor of the Gauss nodes of each input, level + 1 in each, physical units, [node_count, input_count].

    level: one number, or one for each input. The grid determines all polynomials of degree level in each input.
    Raises ValueError for a level below 0 or more than ten million nodes.
    """
    distributions = checked_inputs(inputs)
    given = list(level) if isinstance(level, Sequence | np.ndarray) else [level] * len(distributions)
    levels = [whole_number("level", one, 0) for one in given]
    if len(levels) != len(distributions):
        raise ValueError(f"level has {len(levels)} entries, but must be one number or one for each input")
    if np.prod([one + 1.0 for one in levels]) > 1e7:
        raise ValueError(f"a tensor grid of level {level} in {len(levels)} inputs has over 1e7 nodes: use smolyak")
    nodes = []
    for entry, one in zip(distributions.values(), levels, strict=True):
        nodes.append(entry.physical(entry.recurrence(int(one) + 1).gauss_rule()[0]))
    return np.array(list(product(*nodes)), dtype=float)
