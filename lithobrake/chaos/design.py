"""Designs by count or by grid: full tensor of Gauss nodes, scrambled Sobol sequence, Latin hypercube, random points."""

import warnings
from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.distribution_registry import checked_inputs
from lithobrake.vocabulary.arrays import Array
from lithobrake.vocabulary.given_numbers import random_numbers, sample_count, whole_number

# Points of one scrambled Sobol sequence: its digits have no more places.
MOST_SOBOL = 2**30


def checked_count(count: int, input_count: int = 1) -> int:
    """Check a number of points, which memory must hold with all their inputs."""
    return sample_count("count", count, input_count)


def tensor_count(input_count: int, level: int) -> int:
    """Number of nodes of the full tensor grid, (level + 1)**input_count. Source: [Landings-PCE], Fig 3."""
    return (whole_number("level", level, 0) + 1) ** whole_number("input_count", input_count, 1)


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


def sobol_sequence(inputs: Mapping[str, Distribution], count: int, seed: int = 0, *, skip: int = 0) -> Array:
    """First `count` points of a scrambled Sobol sequence after `skip`, physical units, [count, input_count].

    With the same seed a longer sequence starts with the shorter one, so a design can be extended.
    Raises ValueError for more than 2**30 points or numbers.
    Source: [Owen-1998], as in scipy.stats.qmc.
    """
    from scipy.stats import qmc

    distributions = checked_inputs(inputs)
    size = checked_count(count, len(distributions))
    passed = whole_number("skip", skip, 0, MOST_SOBOL - size)
    engine = qmc.Sobol(len(distributions), scramble=True, rng=random_numbers(seed))
    if passed:
        engine.fast_forward(passed)
    # Powers of two are advised for quadrature; a regression design needs no balance, so no warning either.
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="The balance properties of Sobol")
        uniforms = engine.random(size)
    return _physical(distributions, uniforms)


def latin_hypercube(inputs: Mapping[str, Distribution], count: int, seed: int = 0) -> Array:
    """Latin hypercube in probability, physical units, shape [count, input_count]. Source: [McKay-1979]."""
    distributions = checked_inputs(inputs)
    generator, size = random_numbers(seed), checked_count(count, len(distributions))
    columns = [(generator.permutation(size) + generator.random(size)) / size for _ in distributions]
    return _physical(distributions, np.column_stack(columns))


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


def _physical(distributions: Mapping[str, Distribution], uniforms: Array) -> Array:
    # A probability of exactly 0 or 1 would be infinite for an unbounded input.
    inner = np.clip(uniforms, 2.0**-54, 1.0 - 2.0**-53)
    return np.column_stack([entry.ppf(inner[:, k]) for k, entry in enumerate(distributions.values())])
