"""Dependent inputs: points whose rank correlations are those of a Gaussian copula."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.design import sobol_sequence
from lithobrake.chaos.distribution_registry import checked_inputs
from lithobrake.chaos.distributions import Normal
from lithobrake.chaos.threads import one_thread
from lithobrake.vocabulary.arrays import Array
from lithobrake.vocabulary.given_numbers import numbers

# Probability as near to 0, or to 1, as a point comes.
LEAST = 2.0**-53


class GaussianCopula:
    """Inputs with given distributions and Spearman rank correlations [input_count, input_count].

    `fit` takes its points like any others. The expansion's own moments and indices are those of independent inputs;
    those of dependent ones are moments of its values at many dependent points.
    Raises ValueError unless the matrix is symmetric with ones on its diagonal and can be that of a Gaussian copula.
    Source: [Nataf-1962]; [Lebrun-2009]; r = 2 sin(pi rho / 6), [Kruskal-1958], for the normal correlation.
    """

    def __init__(self, inputs: Mapping[str, Distribution], rank_correlation: ArrayLike) -> None:
        self.inputs = checked_inputs(inputs)
        matrix = numbers("rank_correlation", rank_correlation)
        size = len(self.inputs)
        if matrix.shape != (size, size) or not np.allclose(matrix, matrix.T, rtol=0.0, atol=1e-12):
            raise ValueError(f"rank_correlation has shape {matrix.shape}, but must be symmetric, [{size}, {size}]")
        if not np.all(np.diag(matrix) == 1.0) or np.abs(matrix).max() > 1.0:
            raise ValueError("rank_correlation must have ones on its diagonal and nothing outside -1 to 1")
        normal = 2.0 * np.sin(np.pi * matrix / 6.0)
        np.fill_diagonal(normal, 1.0)
        smallest = float(np.linalg.eigvalsh(normal)[0])
        if smallest <= 1e-10:
            raise ValueError(
                f"rank_correlation gives normals whose correlation matrix has the eigenvalue {smallest:.3g}, but all "
                "must be above 0: weaken the correlations that contradict each other"
            )
        self._factor = np.linalg.cholesky(normal)

    @one_thread()
    def sobol_sequence(self, count: int, *, seed: int = 0) -> Array:
        """Dependent points from a scrambled Sobol sequence, physical units, [count, input_count]."""
        independent = {name: Normal(0.0, 1.0) for name in self.inputs}
        uniforms = special.ndtr(sobol_sequence(independent, count, seed=seed) @ self._factor.T)
        return self._physical(uniforms)

    def dependent(self, points: ArrayLike) -> Array:
        """Dependent points from independent ones of the same inputs, both physical, [count, input_count].

        Each column follows from those up to it, the first stays as it is, and a row from that row alone.
        """
        independent = numbers("points", points)
        uniforms = [entry.cdf(independent[:, k]) for k, entry in enumerate(self.inputs.values())]
        normal = special.ndtri(np.clip(np.column_stack(uniforms), LEAST, 1.0 - LEAST))
        # Not by a matrix product, whose rounding depends on how many rows there are.
        together = np.stack([(normal * row).sum(axis=1) for row in self._factor], axis=1)
        found = self._physical(special.ndtr(together))
        found[:, 0] = independent[:, 0]
        return found

    def _physical(self, uniforms: Array) -> Array:
        return np.column_stack([entry.ppf(uniforms[:, k]) for k, entry in enumerate(self.inputs.values())])
