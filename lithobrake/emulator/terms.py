"""The terms of an emulator: orthonormal products of polynomials of the inputs, as many as runs can tell apart."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.basis import basis_matrix
from lithobrake.chaos.counts import term_count
from lithobrake.chaos.multi_index import Indices, multi_index_set
from lithobrake.vocabulary.arrays import Array

# Of few inputs the total degree is as high as this many terms allow, of many it is two; powers of one input alone go to
# the fifth degree at least.
MOST_TERMS = 220
HIGHEST_DEGREE, OWN_DEGREE, LEAST_DEGREE = 12, 5, 2
# Polynomials grow where an input has no end, and runs are few.
OF_UNBOUNDED = 3
# With more inputs than this there are no products: of thirty inputs there are 435, which tell more than runs do.
MOST_OF_SECOND_DEGREE = 20


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


def candidate_terms(inputs: Mapping[str, Distribution]) -> Terms:
    """All terms that an emulator looks at, as far as the inputs determine them."""
    count = len(inputs)
    least = LEAST_DEGREE if count <= MOST_OF_SECOND_DEGREE else 1
    degrees = range(least, HIGHEST_DEGREE + 1)
    degree = max((one for one in degrees if term_count(count, one) <= MOST_TERMS), default=least)
    limits = [min(HIGHEST_DEGREE if one.bounded else OF_UNBOUNDED, one.highest_degree) for one in inputs.values()]
    together = multi_index_set(count, degree, max_degrees=[int(min(degree, one)) for one in limits])[1:]
    own = np.eye(count, dtype=np.int64)
    alone = [power * own[[power <= one for one in limits]] for power in range(degree + 1, OWN_DEGREE + 1)]
    return Terms(dict(inputs), np.vstack([together, *alone]))


def terms_up_to(inputs: Mapping[str, Distribution], degree: int) -> Terms:
    """All terms up to a total degree, as far as the inputs determine them."""
    highest = [int(min(degree, entry.highest_degree)) for entry in inputs.values()]
    return Terms(dict(inputs), multi_index_set(len(inputs), degree, max_degrees=highest)[1:])
