"""The terms of a stochastic expansion: orthonormal in the inputs and in one latent variable, the scatter's own input.

Source: [Zhu-2023].
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.basis import basis_matrix
from lithobrake.chaos.distributions import Normal, Uniform
from lithobrake.chaos.multi_index import Indices, multi_index_set
from lithobrake.vocabulary.arrays import Array

# Distributions that the latent variable may have, and nodes of the Gauss rule that integrates over it: as fine as the
# noise asks for, which else would show single nodes as peaks of the density.
LATENTS: dict[str, tuple[Distribution, int]] = {"normal": (Normal(0.0, 1.0), 100), "uniform": (Uniform(-1.0, 1.0), 50)}
# Nodes of less weight than this cost time and change no digit that counts.
LEAST_NODE_WEIGHT = 1e-9
# Cubic in the latent variable: enough for skewness and two branches.
LATENT_DEGREE = 3


@dataclass(frozen=True)
class LatentTerms:
    """Multi-indices [term_count, input_count + 1], the powers of the latent variable last; latent: its distribution."""

    inputs: dict[str, Distribution]
    latent: str
    indices: Indices

    @property
    def degree(self) -> int:
        """Total degree in the inputs."""
        return int(self.indices[:, :-1].sum(axis=1).max())

    def factors(self, points: Array) -> Array:
        """What each term has of the inputs at points in physical units, shape [point_count, term_count]."""
        return np.ascontiguousarray(basis_matrix(self.inputs, self.indices[:, :-1], points))

    @cached_property
    def of_power(self) -> Array:
        """Which power of the latent variable each term has, 1 at its place [term_count, power_count]."""
        return np.eye(LATENT_DEGREE + 1)[self.indices[:, -1]]

    @cached_property
    def rule(self) -> tuple[Array, Array]:
        """Polynomials of the latent variable at the nodes [power_count, node_count], and their weights [node_count]."""
        distribution, count = LATENTS[self.latent]
        nodes, weights = distribution.gauss(count)
        kept = weights > LEAST_NODE_WEIGHT
        return self.polynomials(nodes[kept]), weights[kept] / weights[kept].sum()

    def polynomials(self, germs: Array) -> Array:
        """Polynomials of the latent variable at its values [value_count], shape [power_count, value_count]."""
        return LATENTS[self.latent][0].recurrence(LATENT_DEGREE).values(germs)

    def drawn(self, count: int, random: np.random.Generator) -> Array:
        """Polynomials at so many values of the latent variable that are drawn, [power_count, count]."""
        distribution = LATENTS[self.latent][0]
        return self.polynomials(distribution.germ(distribution.ppf(random.random(count))))


def latent_terms(inputs: Mapping[str, Distribution], degree: int, latent: str) -> LatentTerms:
    """Terms of the inputs up to a total degree, of the latent variable up to the third, and their products.

    Products have the same total degree, but at least two: else the scatter could not change with the inputs. Of degree
    0 are no inputs at all.
    """
    highest = [int(min(degree, entry.highest_degree)) for entry in inputs.values()]
    largest = max(degree, LATENT_DEGREE)
    indices = multi_index_set(len(inputs) + 1, largest, max_degrees=[*highest, LATENT_DEGREE])
    of_inputs, power = indices[:, :-1].sum(axis=1), indices[:, -1]
    mixed = (of_inputs > 0) & (power > 0)
    kept = (of_inputs <= degree) & (~mixed | (of_inputs + power <= max(degree, 2)))
    return LatentTerms(dict(inputs), latent, indices[kept])
