"""The orthonormal terms of all inputs that a ladder stands on."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.basis import basis_matrix
from lithobrake.chaos.multi_index import Indices, multi_index_set
from lithobrake.vocabulary.arrays import Array


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
