"""Scatter as it was seen: whole standardised residuals, drawn by a kernel in the inputs, smoothed.

All outputs of a row come together, so that however they hang together is kept, riders included. Smoothing keeps a
million draws from being a few hundred points; shrinking gives the variance back that it adds.
Source: [Silverman-1987].
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lithobrake.vocabulary.arrays import Array

# Widths of a kernel that looks at all inputs, in units of the root mean square distance of two points, and of one that
# looks at a single input, in deviations of it.
BANDWIDTHS = (0.9, 0.65)
WIDTHS = (0.8, 0.4, 0.2)
# Of the normal rule for the smoothing; the rule itself would take a third off the skewness of a few hundred rows.
SMOOTHING_FACTOR = 0.5


def kernels(input_count: int) -> list[tuple[float, ...]]:
    """Widths [input_count] of the kernels that rows may be drawn by: first none, which draws from all rows alike."""
    # The root mean square distance of two independent points of variance 1 in each input.
    distance = float(np.sqrt(2.0 * input_count))
    found = [(np.inf,) * input_count, *((one * distance,) * input_count for one in BANDWIDTHS)]
    for width in WIDTHS:
        found += [tuple(width if k == own else np.inf for k in range(input_count)) for own in range(input_count)]
    return list(dict.fromkeys(found))


def row_weights(points: Array, row_points: Array, weights: Array, widths: Sequence[float]) -> Array:
    """Chance of each row at each point, [point_count, row_count], which sums to 1.

    points, row_points: standardised inputs [count, input_count]; weights: how often each row counts [row_count];
    widths [input_count] of the kernel, infinite for inputs that it does not look at.
    """
    used = np.isfinite(widths)
    if not used.any():
        return np.broadcast_to(weights / weights.sum(), (len(points), len(weights)))
    own, others = (table[:, used] / np.asarray(widths)[used] for table in (points, row_points))
    squares = (own**2).sum(axis=1)[:, None] + (others**2).sum(axis=1) - 2.0 * own @ others.T
    # The nearest row has the weight 1, so that a point far from all of them does not divide by zero.
    nearness = weights * np.exp(-0.5 * (squares - squares.min(axis=1, keepdims=True)))
    return nearness / nearness.sum(axis=1, keepdims=True)


def log_row_weights(points: Array, row_points: Array, weights: Array, widths: Sequence[float]) -> Array:
    """Logarithms of the chances of rows [point_count, row_count]; one row for all points where they are alike."""
    alike = points if np.isfinite(widths).any() else points[:1]
    return np.log(np.maximum(row_weights(alike, row_points, weights, widths), np.finfo(float).tiny))


def drawn_rows(chances: Array, count: int, random: np.random.Generator) -> NDArray[np.int64]:
    """Places of rows drawn by their chances [point_count, row_count], shape [point_count, count]."""
    ends = np.cumsum(chances, axis=1)
    ends /= ends[:, -1:]
    uniforms = random.random((len(chances), count))
    # One search for all points: each has its own unit of the axis.
    shift = np.arange(len(chances))[:, None]
    places = np.searchsorted((ends + shift).ravel(), (uniforms + shift).ravel(), side="right")
    found = places.reshape(uniforms.shape) - shift * chances.shape[1]
    return np.minimum(found, chances.shape[1] - 1)


def smoothing(rows: Array, weights: Array, factor: float = SMOOTHING_FACTOR) -> tuple[float, Array]:
    """Size of the smoothing and root of the covariance that it follows, [output_count, output_count].

    factor: of the normal rule.
    """
    count, outputs = weights.sum() ** 2 / (weights**2).sum(), rows.shape[1]
    covariance = (rows * weights[:, None]).T @ rows / weights.sum()
    values, vectors = np.linalg.eigh(covariance)
    return factor * count ** (-1.0 / (outputs + 4)), vectors * np.sqrt(np.maximum(values, 0.0))


def smoothed(rows: Array, size: float, root: Array, random: np.random.Generator) -> Array:
    """Rows [..., output_count] with normal noise of this size added and the variance given back."""
    noise = random.standard_normal(rows.shape) @ root.T
    return (rows + size * noise) / np.sqrt(1.0 + size**2)
