"""Density of observed outputs by an emulator: that of its own draws, exactly, as a kernel about each residual row."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lithobrake.vocabulary.arrays import Array

# Rows times points that are looked at together: bounds the memory.
_BLOCK = 1 << 21


@dataclass(frozen=True)
class Kernels:
    """Kernels about standardised rows [row_count, output_count]: each a normal law of this covariance."""

    rows: Array
    covariance: Array


def kernels_of(rows: Array, size: float, root: Array) -> Kernels:
    """The kernels that draws of smoothed rows have. size, root: of their smoothing; Source: [Silverman-1987]."""
    shrunk = 1.0 + size**2
    return Kernels(rows / np.sqrt(shrunk), size**2 / shrunk * root @ root.T)


def log_density(
    kernels: Kernels, columns: Sequence[int], coordinate: Array, location: Array, scale: Array, error: Array,
    chances: Array,
) -> Array:  # fmt: skip
    """Logarithm of the density of coordinates [point_count, len(columns)] at each point, [point_count].

    location, scale [point_count, len(columns)] of the law there; error likewise: standard deviation of the observation;
    chances [point_count, row_count] of the rows. Outputs that are not observed drop out with their columns.
    """
    part = list(columns)
    rows, covariance = kernels.rows[:, part], kernels.covariance[np.ix_(part, part)]
    standard, blur = (coordinate - location) / scale, error / scale
    step = max(1, _BLOCK // (len(rows) * max(len(part), 1)))
    parts = [
        _of_block(rows, covariance, standard[block], blur[block], chances[block])
        for block in (slice(start, start + step) for start in range(0, len(standard), step))
    ]
    return np.concatenate(parts) - np.log(scale).sum(axis=1)


def _of_block(rows: Array, covariance: Array, standard: Array, blur: Array, chances: Array) -> Array:
    """The same for standardised coordinates and errors of a few points."""
    width = covariance.shape[0]
    # Errors are blurred into the kernel, so that it is another one wherever the scale is.
    blurred = covariance + blur[:, :, None] ** 2 * np.eye(width) if blur.any() else covariance[None]
    factor = np.linalg.inv(np.linalg.cholesky(blurred))
    whitened = np.einsum("pij,pj->pi", np.broadcast_to(factor, (len(standard), width, width)), standard)
    squares = np.zeros(chances.shape)
    for k in range(width):
        # One output after another, so that no array holds points, rows and outputs together.
        squares += (whitened[:, k, None] - factor[:, k, :] @ rows.T) ** 2
    # The nearest row has the exponent 0, so that a point far from all of them keeps a finite logarithm.
    logarithms = np.log(np.maximum(chances, np.finfo(float).tiny)) - 0.5 * squares
    nearest = logarithms.max(axis=1)
    logarithms -= nearest[:, None]
    np.exp(logarithms, out=logarithms)
    determinant = np.log(np.diagonal(factor, axis1=1, axis2=2)).sum(axis=1)
    density: Array = np.log(logarithms.sum(axis=1)) + nearest + determinant - 0.5 * width * np.log(2.0 * np.pi)
    return density
