"""The law of the coordinates at given inputs: location and logarithm of the scale from ridges, scatter from rows."""

from dataclasses import dataclass

import numpy as np

from lithobrake.emulator.ridge_ladder import Ladder, Smoother, TermTable, best_ladder
from lithobrake.vocabulary.arrays import Array

# Added to a residual's size, as a share of the mean size: one that happens to be near zero says little of the scale,
# but its logarithm would weigh more than all others. Only where the search for the scale begins.
LOGARITHM_FLOOR = 0.15
# A residual counts as no more than this many mean sizes of its place.
LARGEST_SIZE = 4.0
SCALE_STEPS = 3


@dataclass(frozen=True)
class Choices:
    """What is chosen once and kept in every refit: ladders [coordinate_count] of location and scale, and widths
    [input_count] of the kernel by which rows are drawn, in deviations of the standardised inputs.
    """

    location: tuple[Ladder, ...]
    scale: tuple[Ladder, ...]
    widths: tuple[float, ...]

    @property
    def follows_inputs(self) -> bool:
        """Whether anything of the law depends on the inputs."""
        return bool(np.isfinite(self.widths).any()) or any(self.location) or any(self.scale)


@dataclass(frozen=True)
class Law:
    """location, log_scale [1 + term_count, coordinate_count]; scale_limits [2, coordinate_count], least and greatest
    logarithm at the runs, beyond which no polynomial is trusted; rows, standardised residuals [row_count,
    coordinate_count], and how often each counts, weights [row_count].
    """

    location: Array
    log_scale: Array
    scale_limits: Array
    rows: Array
    weights: Array

    def at(self, matrix: Array) -> tuple[Array, Array]:
        """Location and scale [point_count, coordinate_count] at terms but the constant [point_count, term_count]."""
        log_scale = self.log_scale[0] + matrix @ self.log_scale[1:]
        return self.location[0] + matrix @ self.location[1:], np.exp(np.clip(log_scale, *self.scale_limits))


def rows_alone(coordinate_count: int, input_count: int) -> Choices:
    """Choices that draw one of the runs, whatever the inputs."""
    return Choices(((),) * coordinate_count, ((),) * coordinate_count, (np.inf,) * input_count)


def best_choices(design: TermTable, coordinates: Array, *, fades: bool = True) -> Choices:
    """Ladders of location and scale of coordinates [run_count, coordinate_count]; rows are drawn alike.

    fades: whether terms may fade as they are learnt to, which takes longest.
    """
    locations, scales = [], []
    for y in coordinates.T:
        location = best_ladder(design, y, fades=fades)
        scale = _best_scale(design, Smoother(design, location).left_out(y), fades)
        locations.append(location)
        scales.append(scale)
    return Choices(tuple(locations), tuple(scales), (np.inf,) * design.indices.shape[1])


def fit_law(design: TermTable, coordinates: Array, choices: Choices) -> Law:
    """Fit the law that was chosen to coordinates [run_count, coordinate_count]."""
    locations, scales, rows, weights = [], [], [], design.weights
    for y, location_ladder, scale_ladder in zip(coordinates.T, choices.location, choices.scale, strict=True):
        smoother = Smoother(design, location_ladder)
        residual = smoother.left_out(y)
        of_scale = Smoother(design, scale_ladder)
        scale = _scale_fit(design, of_scale, np.abs(residual))
        seen = _working(np.abs(residual), design.at(scale))
        # A run that has drawn the scale to itself must not make its own row smaller.
        row = residual / np.exp(seen - of_scale.left_out(seen))
        mean = weights @ row / weights.sum()
        spread = np.sqrt(weights @ (row - mean) ** 2 / weights.sum())
        # Coordinates that do not scatter at all keep rows of zeros.
        rows.append((row - mean) / (spread if spread > 0.0 else 1.0))
        scale[0] += np.log(spread) if spread > 0.0 else 0.0
        locations.append(smoother.coefficients(y))
        scales.append(scale)
    at_runs = np.array([design.at(one)[weights > 0.0] for one in scales])
    limits = np.array([at_runs.min(axis=1), at_runs.max(axis=1)])
    return Law(np.column_stack(locations), np.column_stack(scales), limits, np.column_stack(rows), weights)


def _best_scale(design: TermTable, residual: Array, fades: bool) -> Ladder:
    """Ladder of the scale of residuals [run_count]."""
    size = np.abs(residual)
    first = best_ladder(design, _log_sizes(size, design.weights), fades=False, doubt=True)
    logarithm = _scale_fit(design, Smoother(design, first), size)
    return best_ladder(design, _working(size, design.at(logarithm)), fades=fades, doubt=True)


def _scale_fit(design: TermTable, smoother: Smoother, size: Array) -> Array:
    """Coefficients [1 + term_count] of the logarithm of the mean size of residuals [run_count].

    From the regression of logarithms by steps of Newton on the likelihood of a mean that is multiplied, which tells
    twice as much of a normal residual. Source: [McCullagh-1989], section 2.5 (working response).
    """
    logarithm = smoother.coefficients(_log_sizes(size, design.weights))
    for _ in range(SCALE_STEPS):
        logarithm = smoother.coefficients(_working(size, design.at(logarithm)))
    return logarithm


def _working(size: Array, logarithm: Array) -> Array:
    """Logarithms of mean sizes with what single residuals [run_count] say of them."""
    return logarithm + np.minimum(size * np.exp(-logarithm), LARGEST_SIZE) - 1.0


def _log_sizes(size: Array, weights: Array) -> Array:
    """Logarithms of sizes of residuals [run_count], kept from running to minus infinity."""
    mean = weights @ size / weights.sum()
    return np.log(size + LOGARITHM_FLOOR * (mean if mean > 0.0 else 1.0))
