"""The law of the coordinates at given inputs: location and logarithm of the scale from ridges, scatter from rows."""

from dataclasses import dataclass

import numpy as np

from lithobrake.chaos.multi_index import Indices
from lithobrake.emulator.ridge_ladder import Ladder, averaged_ridge, best_ladder
from lithobrake.vocabulary.arrays import Array

# Added to squared residuals, as a share of their mean: a residual that happens to be near zero says little of the
# scale, but its logarithm would weigh more than all others.
LOGARITHM_FLOOR = 0.03


@dataclass(frozen=True)
class Choices:
    """What is chosen once and kept in every refit: ladders [coordinate_count] of location and scale, kernel's width."""

    location: tuple[Ladder, ...]
    scale: tuple[Ladder, ...]
    bandwidth: float

    @property
    def follows_inputs(self) -> bool:
        """Whether anything of the law depends on the inputs."""
        return bool(np.isfinite(self.bandwidth)) or any(self.location) or any(self.scale)


@dataclass(frozen=True)
class Law:
    """location [1 + term_count, coordinate_count]; log_scale [1 + input_count, coordinate_count]; rows, standardised
    residuals [row_count, coordinate_count], and how often each counts, weights [row_count].
    """

    location: Array
    log_scale: Array
    rows: Array
    weights: Array

    def at(self, matrix: Array) -> tuple[Array, Array]:
        """Location and scale [point_count, coordinate_count] at terms but the constant [point_count, term_count]."""
        log_scale = self.log_scale[0] + matrix[:, : len(self.log_scale) - 1] @ self.log_scale[1:]
        return self.location[0] + matrix @ self.location[1:], np.exp(log_scale)


def rows_alone(coordinate_count: int) -> Choices:
    """Choices that draw one of the runs, whatever the inputs."""
    return Choices(((),) * coordinate_count, ((),) * coordinate_count, float("inf"))


def best_choices(indices: Indices, matrix: Array, coordinates: Array, bandwidth: float = float("inf")) -> Choices:
    """Ladders of location and scale, with a given width of the kernel.

    matrix: terms [run_count, term_count] with these indices; coordinates [run_count, coordinate_count].
    """
    inputs, ones = indices.shape[1], np.ones(len(matrix))
    locations, scales = [], []
    for y in coordinates.T:
        location = best_ladder(indices, matrix, y)
        log_square = _log_squares(averaged_ridge(indices, matrix, y, location, ones)[1], ones)
        locations.append(location)
        scales.append(best_ladder(indices[:inputs], matrix[:, :inputs], log_square))
    return Choices(tuple(locations), tuple(scales), bandwidth)


def fit_law(indices: Indices, matrix: Array, coordinates: Array, choices: Choices, weights: Array) -> Law:
    """Fit the law that was chosen to runs that count as often as their weights say [run_count]."""
    inputs = indices.shape[1]
    linear = matrix[:, :inputs]
    locations, scales, rows = [], [], []
    for y, location_ladder, scale_ladder in zip(coordinates.T, choices.location, choices.scale, strict=True):
        location, residual = averaged_ridge(indices, matrix, y, location_ladder, weights)
        log_square = _log_squares(residual, weights)
        scale = 0.5 * averaged_ridge(indices[:inputs], linear, log_square, scale_ladder, weights)[0]
        row = residual / np.exp(scale[0] + linear @ scale[1:])
        mean = weights @ row / weights.sum()
        spread = np.sqrt(weights @ (row - mean) ** 2 / weights.sum())
        # Coordinates that do not scatter at all keep rows of zeros.
        rows.append((row - mean) / (spread if spread > 0.0 else 1.0))
        scale[0] += np.log(spread) if spread > 0.0 else 0.0
        locations.append(location)
        scales.append(scale)
    return Law(np.column_stack(locations), np.column_stack(scales), np.column_stack(rows), weights)


def _log_squares(residual: Array, weights: Array) -> Array:
    """Logarithms of squared residuals [run_count], kept from running to minus infinity."""
    mean_square = weights @ residual**2 / weights.sum()
    return np.log(residual**2 + LOGARITHM_FLOOR * (mean_square if mean_square > 0.0 else 1.0))
