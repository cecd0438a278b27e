"""What an expansion tells beyond mean and variance: effects, gradients, expansions in fewer inputs, distributions."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.chaos.basis import germs_of, recurrences_of
from lithobrake.chaos.sobol_indices import SAMPLE_COUNT, skewness_and_kurtosis
from lithobrake.chaos.surrogate import Surrogate
from lithobrake.chaos.training_data import one_thread
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import numbers, random_numbers, sample_count, whole_number


def shape_moments(surrogate: Surrogate, *, count: int = SAMPLE_COUNT, seed: int = 0) -> dict[str, Any]:
    """Skewness and kurtosis (3 for a normal) of each output, [output_count] or numbers; 0 where nothing varies.

    "exact" says whether they are; where not, they come from `count` points, and `skewness_and_kurtosis` says when.
    """
    skewness, kurtosis, exact = skewness_and_kurtosis(
        surrogate.inputs, surrogate.multi_indices, surrogate.coefficient_table, count=count, seed=seed
    )
    return {"skewness": surrogate.shaped(skewness), "kurtosis": surrogate.shaped(kurtosis), "exact": exact}


def marginal(surrogate: Surrogate, names: Sequence[str]) -> Surrogate:
    """The mean over all other inputs, as an expansion in the named inputs only. Source: [Sudret-2008], section 3.

    Raises ValueError for an unknown name or none.
    """
    columns = surrogate.columns(names)
    if not columns:
        raise ValueError(f"marginal needs at least one of {', '.join(surrogate.inputs)}")
    others = [k for k in range(len(surrogate.inputs)) if k not in columns]
    kept = surrogate.multi_indices[:, others].sum(axis=1) == 0
    return Surrogate(
        {surrogate.input_names[k]: list(surrogate.inputs.values())[k] for k in columns},
        np.ascontiguousarray(surrogate.multi_indices[kept][:, columns]),
        surrogate.coefficient_table[kept],
        output_names=surrogate.output_names,
        one_dimensional=surrogate.one_dimensional,
        report={"marginal_of": surrogate.report.get("data_hash")},
    )


def main_effect(surrogate: Surrogate, name: str, points: ArrayLike | int = 50) -> tuple[Array, Array]:
    """Mean output as a function of one input: its values [count], and the effect [count, output_count] or [count].

    points: values in the unit of the input, or how many to spread over its probabilities 0.005 to 0.995.
    """
    entry = surrogate.inputs[surrogate.input_names[surrogate.columns([name])[0]]]
    if isinstance(points, int | np.integer):
        values = np.asarray(entry.ppf(np.linspace(0.005, 0.995, sample_count("count", int(points), 1))))
    else:
        values = numbers("points", points)
    return values, marginal(surrogate, [name])(values[:, None])


@one_thread()
def gradient(surrogate: Surrogate, x: ArrayLike) -> Array:
    """Gradient at points x [count, input_count]; result [count, output_count, input_count] or [count, input_count].

    In units of the output over those of the input.
    """
    points = surrogate.checked_points(x)
    indices = surrogate.multi_indices
    coefficients = surrogate.coefficient_table
    germs = germs_of(surrogate.inputs, points)
    recurrences = recurrences_of(surrogate.inputs, indices)
    values = [one.values(germ)[indices[:, k]] for k, (one, germ) in enumerate(zip(recurrences, germs, strict=True))]
    result = np.empty((len(points), coefficients.shape[1], len(values)))
    for k, entry in enumerate(surrogate.inputs.values()):
        # The other factors are multiplied again, since a term cannot be divided by a factor that is 0 at a point.
        product = recurrences[k].derivatives(germs[k])[indices[:, k]] * entry.germ_derivative(points[:, k])
        for other in range(len(values)):
            if other != k:
                product *= values[other]
        result[:, :, k] = product.T @ coefficients
    return result[:, 0] if surrogate.one_dimensional else result


def sampled_outputs(surrogate: Surrogate, count: int = 100_000, *, seed: int = 0) -> Array:
    """Outputs at random inputs, [count, output_count] or [count]."""
    shape = sample_count("count", count, len(surrogate.inputs)), len(surrogate.inputs)
    uniforms = random_numbers(seed).random(shape)
    columns = [entry.ppf(uniforms[:, k]) for k, entry in enumerate(surrogate.inputs.values())]
    return surrogate(np.column_stack(columns))


def quantiles(surrogate: Surrogate, probabilities: ArrayLike, *, count: int = 100_000, seed: int = 0) -> Array:
    """Quantiles of the outputs by sampling, [probability_count, output_count] or [probability_count]."""
    wanted = numbers("probabilities", probabilities)
    if not ((wanted >= 0.0) & (wanted <= 1.0)).all():
        raise ValueError(f"probabilities are {wanted.tolist()}, but each must lie from 0 to 1")
    return np.quantile(sampled_outputs(surrogate, count, seed=seed), wanted, axis=0)


def density(
    surrogate: Surrogate, output: str | None = None, *, point_count: int = 200, count: int = 100_000, seed: int = 0
) -> tuple[Array, Array]:
    """Values of one output [point_count] and their probability density, by a Gaussian kernel over samples.

    output: its name, None is the first. Source: [Silverman-1986], Eq 3.31 (width of the kernel).
    """
    whole_number("point_count", point_count, 2)
    names = surrogate.output_names
    if output is not None and output not in names:
        raise ValueError(f"output is {output!r}, but must be one of {', '.join(names)}")
    samples = sampled_outputs(surrogate, count, seed=seed).reshape(count, -1)[:, names.index(output) if output else 0]
    # 1.34 is the interquartile range of a normal over its standard deviation; the smaller of both resists long tails.
    spread = min(np.std(samples), np.subtract(*np.quantile(samples, [0.75, 0.25])) / 1.34)
    if spread <= 0.0:
        raise ValueError(f"output {output or names[0]!r} does not vary, so it has no density")
    width = 0.9 * spread * count**-0.2
    edges = np.linspace(samples.min() - 4.0 * width, samples.max() + 4.0 * width, 4097)
    # Samples are binned first, so the cost does not grow with their number.
    fractions = np.histogram(samples, edges)[0] / count
    middles = 0.5 * (edges[1:] + edges[:-1])
    points = np.linspace(edges[0], edges[-1], point_count)
    bumps = np.exp(-0.5 * ((points[:, None] - middles) / width) ** 2) / (width * np.sqrt(2.0 * np.pi))
    return points, bumps @ fractions


def output_correlation(surrogate: Surrogate) -> Array:
    """Correlation of the outputs over the inputs, exact from the coefficients, [output_count, output_count]."""
    varying = surrogate.multi_indices.sum(axis=1) > 0
    coefficients = surrogate.coefficient_table[varying]
    covariance = coefficients.T @ coefficients
    scale = np.sqrt(np.where(np.diag(covariance) > 0.0, np.diag(covariance), 1.0))
    return covariance / np.outer(scale, scale)
