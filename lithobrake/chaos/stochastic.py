"""Outputs that scatter between equal runs: mean and logarithm of the variance, both as expansions of the inputs."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.fitting import PROCESS_FROM, PROCESS_LIMIT, fit
from lithobrake.chaos.scores import replicates
from lithobrake.chaos.storage import numbers_from_json, read, write
from lithobrake.chaos.surrogate import Surrogate
from lithobrake.chaos.training_data import checked_training
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import random_numbers

FORMAT = "lithobrake stochastic surrogate"


@dataclass(frozen=True)
class StochasticSurrogate:
    """mean and log_variance (of the scatter) as expansions; correlation of the scatter [output_count, output_count]."""

    mean: Surrogate
    log_variance: Surrogate
    correlation: Array

    def scatter_std(self, x: ArrayLike) -> Array:
        """Standard deviation between equal runs at points x, [count, output_count] or [count]."""
        return np.exp(0.5 * self.log_variance(x))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything into one readable JSON file."""
        parts = {"mean": self.mean.content(), "log_variance": self.log_variance.content()}
        write(FORMAT, {**parts, "correlation": self.correlation.tolist()}, path)

    def sample(self, x: ArrayLike, *, seed: int = 0) -> Array:
        """One random run at each point x [count, input_count], outputs drawn jointly, [count, output_count] or [count].

        The scatter is taken as normal around the mean.
        """
        mean, std = np.asarray(self.mean(x)), self.scatter_std(x)
        # No Cholesky factor: with fewer degrees of freedom than outputs the matrix is singular.
        values, vectors = np.linalg.eigh(self.correlation)
        root = vectors * np.sqrt(np.maximum(values, 0.0))
        draws = random_numbers(seed).normal(size=(len(mean), len(root))) @ root.T
        return mean + std * draws.reshape(mean.shape)


def load_stochastic(path: str | os.PathLike[str]) -> StochasticSurrogate:
    """Read what `StochasticSurrogate.save` wrote. Raises ValueError if the file is of another kind or damaged."""

    def build(content: dict[str, Any]) -> StochasticSurrogate:
        mean, spread = Surrogate.from_content(content["mean"]), Surrogate.from_content(content["log_variance"])
        correlation = numbers_from_json("correlation", content["correlation"], len(mean.output_names))
        if mean.inputs != spread.inputs or mean.output_names != spread.output_names:
            raise ValueError("mean and log_variance have different inputs or outputs")
        if len(correlation) != len(mean.output_names) or not np.allclose(correlation, correlation.T):
            raise ValueError("correlation must have a row for each output, and be symmetric")
        return StochasticSurrogate(mean, spread, correlation)

    return read(FORMAT, build, path)


def fit_stochastic(
    inputs: Mapping[str, Distribution], x: ArrayLike, y: ArrayLike, *, output_names: Sequence[str] | None = None
) -> StochasticSurrogate:
    """Fit mean and scatter from runs of which groups have equal inputs (other seeds), arguments as in `fit`.

    The logarithm of a sample variance is too low on average by a known amount, which is added; groups of at least
    two runs enter. Raises ValueError without repeated points, or for an output that does not scatter.
    Source: [Bartlett-1946] (logarithm of a variance); [Zhu-2020] (stochastic expansions).
    """
    training = checked_training(inputs, x, y, output_names=output_names)
    pooled = replicates(training.x, training.y)
    if pooled is None:
        raise ValueError("no point occurs twice, so scatter cannot be told from shape: repeat some runs with new seeds")
    usable = (pooled.variances > 0.0).all(axis=1)
    if not usable.any():
        raise ValueError("equal runs gave equal outputs, so there is no scatter to model: use fit")
    freedom = (pooled.sizes[usable] - 1) / 2.0
    bias = special.digamma(freedom) - np.log(freedom)
    logarithm = np.log(pooled.variances[usable]) - bias[:, None]
    names = training.output_names
    mean = fit(inputs, training.x, training.y, output_names=names)
    # Logarithms of variances from few runs are very noisy: a process shrinks what they do not support.
    method = "gaussian_process" if PROCESS_FROM <= usable.sum() <= PROCESS_LIMIT else "ols"
    spread = fit(inputs, pooled.points[usable], logarithm, method=method, output_names=names)
    mean.one_dimensional = spread.one_dimensional = training.one_dimensional
    return StochasticSurrogate(mean, spread, pooled.correlation)


def joint_scatter(surrogate: Surrogate, x: ArrayLike, y: ArrayLike) -> Array:
    """Scatter of runs x, y, one row for each run that shows it, [row_count, output_count], to be drawn from jointly.

    With runs of equal inputs these are their deviations from their means, widened to the spread of single runs; else
    the residuals of the expansion, brought to the scatter that its report knows (the nugget of a process) or, without
    one, to its expected error, which then also holds what the expansion does not follow. Rows of y that are all NaN
    are left out.
    """
    training = checked_training(surrogate.inputs, x, y, output_names=surrogate.output_names)
    pooled = replicates(training.x, training.y)
    if pooled is not None:
        return pooled.deviations
    residuals = training.y - surrogate.evaluated(training.x)
    residuals -= residuals.mean(axis=0)
    own = residuals.std(axis=0)
    entries = [surrogate.report.get("outputs", {}).get(name, {}) for name in surrogate.output_names]
    known = [entry.get("noise_std") or entry.get("rmse_estimate") for entry in entries]
    wanted = np.array([size if one is None else one for one, size in zip(known, own, strict=True)])
    return residuals * np.divide(wanted, own, out=np.zeros_like(own), where=own > 0.0)
