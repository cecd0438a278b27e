"""Random points of uncertain inputs."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.vocabulary.given_numbers import sample_count, whole_number

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution


def sample_inputs(inputs: Mapping[str, "Distribution"], count: int, seed: int) -> np.ndarray:
    """Draw independent points, shape [count, input_count], in the physical units of the inputs.

    Each input has a random stream of its own, so neither another input nor a larger count changes earlier draws.
    """
    count, seed = sample_count("count", count, len(inputs), at_least=0), whole_number("seed", seed, 0)
    columns = [
        distribution.ppf(open_uniforms(np.random.Generator(np.random.PCG64([seed, *name.encode()])), count))
        for name, distribution in inputs.items()
    ]
    return np.column_stack(columns) if columns else np.empty((count, 0))


def open_uniforms(generator: np.random.Generator, count: int) -> np.ndarray:
    """Uniform numbers strictly between 0 and 1, so that an unbounded distribution gives a finite value."""
    return (generator.integers(0, 2**52, size=count) + 0.5) / 2**52
