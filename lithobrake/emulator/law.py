"""The law of the coordinates at given inputs: location and logarithm of the scale from ridges, scatter from rows."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.polynomials import Array
from lithobrake.emulator.ridge_ladder import Rung, best_rungs, ridge

# Added to squared residuals, as a share of their mean: a residual that happens to be near zero says little of the
# scale, but its logarithm would weigh more than all others.
LOGARITHM_FLOOR = 0.03


@dataclass(frozen=True)
class Choices:
    """What is chosen once and kept in every refit: rungs [coordinate_count] of location and scale, kernel's width."""

    location: tuple[Rung, ...]
    scale: tuple[Rung, ...]
    bandwidth: float

    @property
    def follows_inputs(self) -> bool:
        """Whether anything of the law depends on the inputs."""
        finite = [rung.penalty for rung in (*self.location, *self.scale)]
        return bool(np.isfinite([*finite, self.bandwidth]).any())


@dataclass(frozen=True)
class Law:
    """location [1 + term_count, coordinate_count]; log_scale [1 + input_count, coordinate_count]; rows, standardised
    residuals [row_count, coordinate_count], and how often each counts, weights [row_count].
    """

    location: Array
    log_scale: Array
    rows: Array
    weights: Array

    def at(self, matrix: Array, input_count: int) -> tuple[Array, Array]:
        """Location and scale [point_count, coordinate_count] at terms but the constant [point_count, term_count]."""
        log_scale = self.log_scale[0] + matrix[:, :input_count] @ self.log_scale[1:]
        return self.location[0] + matrix @ self.location[1:], np.exp(log_scale)


def rows_alone(coordinate_count: int) -> Choices:
    """Choices that draw one of the runs, whatever the inputs."""
    return Choices((Rung(),) * coordinate_count, (Rung(),) * coordinate_count, float("inf"))


def best_choices(matrix: Array, degrees: NDArray[np.int64], coordinates: Array) -> Choices:
    """Rungs of least leave-one-out error, drawing from all rows alike.

    matrix: terms [run_count, term_count] by total degree, degrees [term_count]; coordinates [run_count, count].
    """
    location = best_rungs(matrix, degrees, coordinates)
    ones = np.ones(len(matrix))
    residuals = [ridge(matrix, degrees, y, rung, ones)[1] for y, rung in zip(coordinates.T, location, strict=True)]
    linear = degrees == 1
    scale = best_rungs(matrix[:, linear], degrees[linear], _log_squares(np.column_stack(residuals), ones))
    return Choices(tuple(location), tuple(scale), float("inf"))


def fit_law(matrix: Array, degrees: NDArray[np.int64], coordinates: Array, choices: Choices, weights: Array) -> Law:
    """Fit the law that was chosen to runs that count as often as their weights say [run_count]."""
    linear = matrix[:, degrees == 1]
    locations, scales, rows = [], [], []
    for y, location_rung, scale_rung in zip(coordinates.T, choices.location, choices.scale, strict=True):
        location, residual = ridge(matrix, degrees, y, location_rung, weights)
        log_square = _log_squares(residual[:, None], weights)[:, 0]
        scale = 0.5 * ridge(linear, degrees[degrees == 1], log_square, scale_rung, weights)[0]
        row = residual / np.exp(scale[0] + linear @ scale[1:])
        mean = weights @ row / weights.sum()
        spread = np.sqrt(weights @ (row - mean) ** 2 / weights.sum())
        # Coordinates that do not scatter at all keep rows of zeros.
        rows.append((row - mean) / (spread if spread > 0.0 else 1.0))
        scale[0] += np.log(spread) if spread > 0.0 else 0.0
        locations.append(location)
        scales.append(scale)
    return Law(np.column_stack(locations), np.column_stack(scales), np.column_stack(rows), weights)


def _log_squares(residuals: Array, weights: Array) -> Array:
    """Logarithms of squared residuals [run_count, coordinate_count], kept from running to minus infinity."""
    mean_squares = weights @ residuals**2 / weights.sum()
    return np.log(residuals**2 + LOGARITHM_FLOOR * np.where(mean_squares > 0.0, mean_squares, 1.0))
