"""A stochastic polynomial chaos expansion of one output in the inputs and a latent variable."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy import special

from lithobrake.emulator.latent_variable import NOISE_SHARES, HeldOut, LatentProblem, LatentTerms
from lithobrake.emulator.training_runs import TrainingRuns
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.normal_law import mean_distance

# Values of the noise in an ensemble, of equal probability: so many that two branches are no set of single values.
NOISE_VALUES = 50


@dataclass(frozen=True)
class Normals:
    """A mixture of normals at points: weights, means [point_count, part_count], deviation [point_count, 1] of each."""

    weights: Array
    means: Array
    deviation: Array

    def log_density(self, coordinates: Array) -> Array:
        """Logarithm of the density of a coordinate at each point [point_count]."""
        exponents = np.log(self.weights) - 0.5 * ((coordinates[:, None] - self.means) / self.deviation) ** 2
        found = special.logsumexp(exponents, axis=1) - np.log(self.deviation[:, 0])
        return np.asarray(found - 0.5 * np.log(2.0 * np.pi))

    def crps(self, coordinates: Array) -> Array:
        """Continuous ranked probability score of a coordinate at each point [point_count]. Source: [Grimit-2006]."""
        away = mean_distance(coordinates[:, None] - self.means, self.deviation)
        apart = mean_distance(self.means[:, :, None] - self.means[:, None], np.sqrt(2.0) * self.deviation[:, None])
        return np.asarray((self.weights * (away - 0.5 * (apart @ self.weights[:, :, None])[:, :, 0])).sum(axis=1))

    def averaged(self, function: Callable[[Array], Array], coordinates: Array) -> Array:
        """Average over the normals of a function of distances from them over their deviation; coordinates
        [point_count, value_count].
        """
        average = np.zeros(coordinates.shape)
        for weight, mean in zip(self.weights.T, self.means.T, strict=True):
            average += weight[:, None] * function((coordinates - mean[:, None]) / self.deviation)
        return average


@dataclass(frozen=True)
class StochasticExpansion:
    """The law of the coordinate of one output: parameters [parameter_count] of terms of the inputs and a latent
    variable, and noise, a standard deviation beside them. Source: [Zhu-2023].
    """

    terms: LatentTerms
    parameters: Array
    noise: float

    @classmethod
    def of_runs(cls, runs: TrainingRuns, chosen: HeldOut) -> "StochasticExpansion":
        """That of most likelihood with terms and a noise that groups left out have chosen."""
        problem = LatentProblem.of_runs(runs, chosen.terms, np.ones(len(runs.x)))
        noise, parameters = list(problem.path(NOISE_SHARES[: chosen.share_count]))[-1]
        return cls(chosen.terms, parameters, noise)

    def reweighted(self, runs: TrainingRuns, weights: Array) -> "StochasticExpansion":
        """Fitted anew with each run counted as often as weights say [run_count]; terms and noise are kept."""
        # From where the fit stands: going down from a large noise again would repeat the whole path in every refit.
        problem = LatentProblem.of_runs(runs, self.terms, weights)
        return replace(self, parameters=problem.climbed(self.parameters, self.noise))

    def draws(self, points: Array, count: int, random: np.random.Generator) -> Array:
        """Draw coordinates at points in physical units [point_count, input_count], shape [point_count, count]."""
        coordinates = self.terms.drawn(self.terms.factors(points), self.parameters, count, random)
        return coordinates + self.noise * random.standard_normal(coordinates.shape)

    def normals(self, points: Array) -> Normals:
        """The law at points in physical units [point_count, input_count]."""
        factors = self.terms.factors(points)
        means = self.terms.by_power(factors, self.parameters) @ self.terms.rule()[0]
        weights = np.exp(self.terms.log_weights(factors, self.parameters))
        return Normals(np.broadcast_to(weights, means.shape), means, np.full((len(points), 1), self.noise))

    def members(self, points: Array) -> tuple[Array, Array]:
        """An ensemble at points, coordinates and their weights [point_count, member_count]."""
        normals = self.normals(points)
        noise = self.noise * special.ndtri((np.arange(NOISE_VALUES) + 0.5) / NOISE_VALUES)
        weights = np.repeat(normals.weights / NOISE_VALUES, NOISE_VALUES, axis=1)
        return (normals.means[:, :, None] + noise).reshape(len(points), -1), weights
