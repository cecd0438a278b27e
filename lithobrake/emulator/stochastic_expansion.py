"""A stochastic polynomial chaos expansion of one output in the inputs and a latent variable, and its fit."""

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.chaos.basis import checked_points
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.polynomials import hermite
from lithobrake.chaos.storage import indices_from_json, read, write
from lithobrake.chaos.training_data import one_thread
from lithobrake.emulator.fitting import with_distant_bounds
from lithobrake.emulator.latent_variable import LATENT_DEGREE, LATENTS, LatentProblem, LatentTerms, most_likely
from lithobrake.emulator.mean_law import candidate_terms
from lithobrake.emulator.storage import column_from_json, runs_from_json, runs_to_json
from lithobrake.emulator.training_runs import TrainingRuns, checked_runs, with_slope
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import numbers, random_numbers, sample_count

FORMAT = "lithobrake stochastic expansion"
# Halvings after which an interval of quantiles is no wider than rounding.
HALVINGS = 60
# Nodes of the noise in a mean of bounded outputs.
NOISE_NODES = 16


@dataclass(frozen=True)
class StochasticExpansion:
    """The law of one output at given inputs; `fit_stochastic_expansion` makes one.

    coefficients: of the terms [term_count]. noise: standard deviation beside the expansion. Both are of the output's
    coordinate: itself, or its logit or logarithm where it has bounds. held_out: mean logarithm of the density of a run
    of groups left out [per coordinate]. weights: how often each run counts [run_count], 1 but for refits.
    Bounds that were the same in all runs are known; others have to be given at x, as in `fit_stochastic_expansion`.
    """

    runs: TrainingRuns
    terms: LatentTerms
    coefficients: Array
    noise: float
    held_out: float
    weights: Array

    def __repr__(self) -> str:
        """Say of what it is the law, at which inputs, and from how many runs."""
        return (
            f"StochasticExpansion of {self.runs.output_names[0]} at {', '.join(self.runs.inputs)}: degree "
            f"{self.degree}, latent variable {self.latent}, from {len(self.runs.y)} runs."
        )

    @property
    def degree(self) -> int:
        """Total degree of the terms of the inputs; 0 where the inputs did no good on groups left out."""
        return self.terms.degree

    @property
    def latent(self) -> str:
        """Distribution of the latent variable: normal or uniform."""
        return self.terms.latent

    @property
    def log_likelihood(self) -> float:
        """Sum over the runs of the logarithm of the density of the output that they had [1 / unit of the output]."""
        slopes = with_slope(self.runs.y, *self.runs.bending(self.runs.lower, self.runs.upper))[1][:, 0]
        logarithms = self._problem.log_densities(self.coefficients, self.noise)[0]
        return float(self._problem.weights @ (logarithms + np.log(slopes)))

    @one_thread()
    def sample(
        self, x: ArrayLike, count: int, seed: int = 0, *, lower: ArrayLike | None = None, upper: ArrayLike | None = None
    ) -> Array:
        """Draw `count` outputs at each x [point_count, input_count], shape [point_count, count]."""
        by_power = self._branches(x)
        shape = len(by_power), sample_count("count", count, len(by_power))
        random = random_numbers(seed)
        polynomials = self.terms.drawn(shape[0] * shape[1], random).reshape(-1, *shape)
        coordinates = np.einsum("pk,kpc->pc", by_power, polynomials) + self.noise * random.standard_normal(shape)
        return self._outputs(coordinates, lower, upper)

    def density(
        self, x: ArrayLike, y: ArrayLike, *, lower: ArrayLike | None = None, upper: ArrayLike | None = None
    ) -> Array:
        """Density [1 / unit of the output] at each x [point_count, input_count] of outputs y [value_count] or
        [point_count, value_count], shape [point_count, value_count]; 0 beyond bounds.
        """
        means, coordinates, slopes = self._at(x, y, lower, upper)
        bells = self._averaged(lambda away: np.exp(-0.5 * away**2), coordinates, means)
        return bells * slopes / (self.noise * np.sqrt(2.0 * np.pi))

    def cdf(
        self, x: ArrayLike, y: ArrayLike, *, lower: ArrayLike | None = None, upper: ArrayLike | None = None
    ) -> Array:
        """Probability of not exceeding y at each x; shapes as in `density`."""
        means, coordinates, _ = self._at(x, y, lower, upper)
        return self._averaged(special.ndtr, coordinates, means)

    def quantile(
        self, x: ArrayLike, levels: ArrayLike, *, lower: ArrayLike | None = None, upper: ArrayLike | None = None
    ) -> Array:
        """Outputs that are not exceeded with probabilities levels [level_count], at each x; [point_count, level_count].

        Raises ValueError for levels outside 0 to 1, and for 0 and 1 themselves.
        """
        wanted = np.atleast_1d(numbers("levels", levels))
        if wanted.ndim != 1 or not ((wanted > 0.0) & (wanted < 1.0)).all():
            raise ValueError(f"levels are {wanted.tolist()}, but must be a list of numbers above 0 and below 1")
        means = self._means(x)
        # At the least mean's own quantile no part of the mixture has reached its level, at the greatest's all have.
        own = self.noise * special.ndtri(wanted)
        low, high = means.min(axis=1)[:, None] + own, means.max(axis=1)[:, None] + own
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            below = self._averaged(special.ndtr, middle, means) < wanted
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return self._outputs(0.5 * (low + high), lower, upper)

    def mean(self, x: ArrayLike, *, lower: ArrayLike | None = None, upper: ArrayLike | None = None) -> Array:
        """Mean output at each x [point_count, input_count], shape [point_count]."""
        means, weights = self._means(x), self.terms.rule[1]
        mean = np.zeros(len(means))
        for node, share in zip(*hermite(NOISE_NODES).gauss_rule(), strict=True):
            mean += share * (self._outputs(means + self.noise * node, lower, upper) @ weights)
        return mean

    @one_thread()
    def reweighted(self, weights: ArrayLike) -> "StochasticExpansion":
        """Fit the coefficients anew with each run counted as often as weights say [run_count]; choices are kept."""
        counted = self.runs.checked_weights(weights)
        # From where the fit stands, at its noise: going down from a large noise again would repeat the whole path in
        # every refit.
        coefficients = LatentProblem.of_runs(self.runs, self.terms, counted).climbed(self.coefficients, self.noise)
        return replace(self, coefficients=coefficients, weights=counted)

    def refits(self, count: int = 200, seed: int = 0) -> list["StochasticExpansion"]:
        """Fit anew to groups drawn with replacement, `count` times: how far the law itself is uncertain."""
        return [self.reweighted(weights) for weights in self.runs.weights_of_refits(count, seed)]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything into one readable JSON file, from which `load_stochastic_expansion` gives the same draws."""
        content = {
            "latent": self.latent,
            "noise": self.noise,
            "held_out": self.held_out,
            "multi_indices": self.terms.indices.tolist(),
            "coefficients": self.coefficients.tolist(),
            "weights": self.weights.tolist(),
        }
        write(FORMAT, {**content, **runs_to_json(self.runs)}, path)

    @cached_property
    def _problem(self) -> LatentProblem:
        return LatentProblem.of_runs(self.runs, self.terms, self.weights)

    def _branches(self, x: ArrayLike) -> Array:
        """Coefficients of the powers of the latent variable at x, [point_count, power_count]."""
        return self.terms.branches(self.terms.factors(checked_points(self.runs.inputs, x)), self.coefficients)

    def _means(self, x: ArrayLike) -> Array:
        """The expansion at x and at the nodes of the latent variable, [point_count, node_count]."""
        return np.asarray(self._branches(x) @ self.terms.rule[0])

    def _at(
        self, x: ArrayLike, y: ArrayLike, lower: ArrayLike | None, upper: ArrayLike | None
    ) -> tuple[Array, Array, Array]:
        """The expansion at x, and coordinates of y with their slopes [point_count, value_count]."""
        means, values = self._means(x), np.atleast_1d(numbers("y", y))
        if values.ndim > 2 or (values.ndim == 2 and len(values) != len(means)) or np.isnan(values).any():
            raise ValueError(
                f"y has shape {values.shape}, but must be [value_count] or [{len(means)}, value_count], without NaN"
            )
        low, high = self.runs.bounds_at(lower, upper, len(means))
        table = np.broadcast_to(values, (len(means), values.shape[-1]))
        coordinate, slope = with_slope(table, *self.runs.bending(low, high))
        # Beyond a bound that bends nothing there is as little as beyond another one.
        coordinate = np.where(table <= low, -np.inf, np.where(table >= high, np.inf, coordinate))
        return means, coordinate, np.where(np.isinf(coordinate), 0.0, slope)

    def _outputs(self, coordinates: Array, lower: ArrayLike | None, upper: ArrayLike | None) -> Array:
        """Outputs of coordinates [point_count, any] at points with these bounds."""
        low, high = self.runs.bounds_at(lower, upper, len(coordinates))
        return self.runs.outputs_of(coordinates[:, :, None], low[:, None], high[:, None])[:, :, 0]

    def _averaged(self, function: Callable[[Array], Array], coordinates: Array, means: Array) -> Array:
        """Average over the latent variable of a function of distances from the expansion in units of the noise."""
        average = np.zeros(coordinates.shape)
        for weight, mean in zip(self.terms.rule[1], means.T, strict=True):
            average += weight * function((coordinates - mean[:, None]) / self.noise)
        return average


def load_stochastic_expansion(path: str | os.PathLike[str]) -> StochasticExpansion:
    """Read what `StochasticExpansion.save` wrote. Raises ValueError if the file is of another kind, or damaged."""

    def build(content: dict[str, Any]) -> StochasticExpansion:
        runs = runs_from_json(content)
        indices = indices_from_json(content["multi_indices"], len(runs.inputs) + 1)
        latent, noise = content["latent"], float(content["noise"])
        if latent not in LATENTS or indices[:, -1].max() > LATENT_DEGREE or not 0.0 < noise < np.inf:
            raise ValueError(f"latent must be one of {', '.join(LATENTS)}, its powers up to 3, noise above 0")
        if len(runs.modelled) != 1 or runs.y.shape[1] != 1:
            raise ValueError("output_names must hold one output, which is no rider")
        coefficients = column_from_json("coefficients", content["coefficients"], len(indices))
        weights = column_from_json("weights", content["weights"], len(runs.x))
        terms = LatentTerms(runs.inputs, latent, indices)
        return StochasticExpansion(runs, terms, coefficients, noise, float(content["held_out"]), weights)

    return read(FORMAT, build, path)


@one_thread()
def fit_stochastic_expansion(
    inputs: Mapping[str, Distribution],
    x: ArrayLike,
    y: ArrayLike,
    *,
    groups: ArrayLike | None = None,
    lower: ArrayLike | None = None,
    upper: ArrayLike | None = None,
    degree: int | None = None,
    latent: str | None = None,
    output_name: str = "y",
) -> StochasticExpansion:
    """Fit the density of one output at given inputs to runs, drawn from the law of the inputs.

    x: [run_count, input_count] in physical units.
    y: [run_count]; NaN where a run has no output: the law is that of runs with one.
    groups, lower, upper: as in `fit`.
    degree: of the terms of the inputs, from 0, no inputs, to 5; None chooses by groups left out.
    latent: distribution of the latent variable, "normal" or "uniform"; None chooses likewise.
    Raises ValueError for shapes and values that do not fit together, too few runs, and an output without scatter.
    """
    if np.ndim(y) != 1 and np.shape(y)[1:] != (1,):
        raise ValueError(f"y has shape {np.shape(y)}, but must be [run_count]: fit one expansion for each output")
    runs = checked_runs(inputs, x, y, groups, None, None, lower, upper, (), (output_name,))
    candidate = candidate_terms(runs.inputs)
    runs = with_distant_bounds(runs, candidate.indices, candidate.matrix(runs.x[runs.has_outputs]))
    terms, noise, coefficients, logarithm = most_likely(runs, degree, latent)
    return StochasticExpansion(runs, terms, coefficients, noise, logarithm, np.ones(len(runs.x)))
