"""Dependent inputs: a Gaussian copula turns them into independent normal germs, in which the expansion lives."""

import os
from collections.abc import Mapping, Sequence
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.chaos.basis import outside_count, points_of
from lithobrake.chaos.design import sobol_sequence
from lithobrake.chaos.distribution_registry import checked_inputs
from lithobrake.chaos.distributions import Normal
from lithobrake.chaos.fitting import fit
from lithobrake.chaos.polynomials import Array
from lithobrake.chaos.storage import inputs_from_json, inputs_to_json, read, write
from lithobrake.chaos.surrogate import Surrogate
from lithobrake.chaos.threads import one_thread
from lithobrake.vocabulary.given_numbers import numbers

FORMAT = "lithobrake expansion of dependent inputs"


class GaussianCopula:
    """Inputs with given distributions and Spearman rank correlations [input_count, input_count].

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
        self.rank_correlation = matrix
        normal = 2.0 * np.sin(np.pi * matrix / 6.0)
        np.fill_diagonal(normal, 1.0)
        smallest = float(np.linalg.eigvalsh(normal)[0])
        if smallest <= 1e-10:
            raise ValueError(
                f"rank_correlation gives normals whose correlation matrix has the eigenvalue {smallest:.3g}, but all "
                "must be above 0: weaken the correlations that contradict each other"
            )
        self._factor = np.linalg.cholesky(normal)

    @property
    def germ_inputs(self) -> dict[str, Distribution]:
        """The independent standard normal germs, named "germ 1 of 3" and so on: they mix the inputs."""
        return {f"germ {k + 1} of {len(self.inputs)}": Normal(0.0, 1.0) for k in range(len(self.inputs))}

    @one_thread()
    def physical(self, germs: ArrayLike) -> Array:
        """Inputs in physical units of independent germs [count, input_count]; result [count, input_count]."""
        uniforms = special.ndtr(numbers("germs", germs) @ self._factor.T)
        return np.column_stack([entry.ppf(uniforms[:, k]) for k, entry in enumerate(self.inputs.values())])

    @one_thread()
    def germs(self, x: ArrayLike) -> Array:
        """Independent germs of inputs x in physical units [count, input_count]; inside the open support only."""
        points = points_of(self.inputs, x)
        outside, sentence = outside_count(self.inputs, points)
        uniforms = np.column_stack([entry.cdf(points[:, k]) for k, entry in enumerate(self.inputs.values())])
        at_edge = int(((uniforms <= 0.0) | (uniforms >= 1.0)).any(axis=1).sum())
        if outside or at_edge:
            reason = sentence or "an end of the support is infinitely far in a normal germ"
            raise ValueError(f"{max(outside, at_edge)} points are not inside the support of the inputs ({reason})")
        return np.linalg.solve(self._factor, special.ndtri(uniforms).T).T

    def sobol_sequence(self, count: int, *, seed: int = 0) -> Array:
        """Dependent points from a scrambled Sobol sequence of the germs, [count, input_count]."""
        return self.physical(sobol_sequence(self.germ_inputs, count, seed=seed))


class DependentSurrogate:
    """An expansion of dependent inputs; `independent` is the expansion in the germs of the copula."""

    def __init__(self, copula: GaussianCopula, independent: Surrogate) -> None:
        self.copula, self.independent = copula, independent

    def __call__(self, x: ArrayLike) -> Array:
        """Evaluate at points x in physical units [count, input_count]; result [count, output_count] or [count]."""
        return self.independent(self.copula.germs(x))

    @property
    def mean(self) -> Any:
        """Mean of each output under the dependent inputs."""
        return self.independent.mean

    @property
    def variance(self) -> Any:
        """Variance of each output under the dependent inputs."""
        return self.independent.variance

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything into one readable JSON file."""
        copula = {
            "dependent_inputs": inputs_to_json(self.copula.inputs),
            "rank_correlation": self.copula.rank_correlation.tolist(),
        }
        write(FORMAT, {**copula, "independent": self.independent.content()}, path)

    def _refuse(self) -> NoReturn:
        raise ValueError(
            "Sobol indices are not defined for dependent inputs: those of the independent germs, which mix the inputs, "
            "are independent.sobol_first and independent.sobol_total"
        )

    @property
    def sobol_first(self) -> NoReturn:
        """Raises ValueError: dependent inputs have no such shares."""
        self._refuse()

    @property
    def sobol_total(self) -> NoReturn:
        """Raises ValueError: dependent inputs have no such shares."""
        self._refuse()


def load_dependent(path: str | os.PathLike[str]) -> DependentSurrogate:
    """Read what `DependentSurrogate.save` wrote. Raises ValueError if the file is of another kind or damaged."""

    def build(content: dict[str, Any]) -> DependentSurrogate:
        copula = GaussianCopula(inputs_from_json(content["dependent_inputs"]), content["rank_correlation"])
        independent = Surrogate.from_content(content["independent"])
        if independent.inputs != copula.germ_inputs:
            raise ValueError("the inputs of independent are not the germs of dependent_inputs")
        return DependentSurrogate(copula, independent)

    return read(FORMAT, build, path)


def fit_dependent(
    inputs: Mapping[str, Distribution],
    rank_correlation: ArrayLike,
    x: ArrayLike,
    y: ArrayLike,
    degree: int | None = None,
    method: str | None = None,
    *,
    output_names: Sequence[str] | None = None,
) -> DependentSurrogate:
    """Fit an expansion of dependent inputs; arguments as in `fit`, with Spearman rank correlations between inputs."""
    copula = GaussianCopula(inputs, rank_correlation)
    germs = copula.germs(x)
    return DependentSurrogate(copula, fit(copula.germ_inputs, germs, y, degree, method, output_names=output_names))
