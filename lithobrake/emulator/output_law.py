"""The distribution of one output at given inputs: density, probabilities, quantiles and mean, from normals."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.chaos.polynomials import hermite
from lithobrake.emulator.law import row_weights, smoothing
from lithobrake.emulator.stochastic_expansion import Normals
from lithobrake.emulator.storage import Parts
from lithobrake.emulator.training_runs import from_coordinate, inside, with_slope
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import numbers

# Halvings after which an interval of quantiles is no wider than rounding.
HALVINGS = 60
# Nodes of a normal in a mean of bounded outputs.
NORMAL_NODES = 16


@dataclass(frozen=True)
class OutputLaw:
    """Distribution of one output at given points, among runs with outputs; made by `Emulator.output_law`.

    normals: in the coordinate of the output, itself or its logit or logarithm. lower, upper [point_count, 1]: bounds;
    bending: those of them that the coordinate has, infinite else.
    """

    normals: Normals
    lower: Array
    upper: Array
    bending: tuple[Array, Array]

    def density(self, y: ArrayLike) -> Array:
        """Density [1 / unit of the output] of outputs y [value_count] or [point_count, value_count], shape
        [point_count, value_count]; 0 beyond bounds.
        """
        coordinates, slopes = self._coordinates(y)
        bells = self.normals.averaged(lambda away: np.exp(-0.5 * away**2), coordinates)
        return bells * slopes / (self.normals.deviation * np.sqrt(2.0 * np.pi))

    def cdf(self, y: ArrayLike) -> Array:
        """Probability of not exceeding y; shapes as in `density`."""
        return self.normals.averaged(special.ndtr, self._coordinates(y)[0])

    def quantile(self, levels: ArrayLike) -> Array:
        """Outputs that are not exceeded with probabilities levels [level_count], [point_count, level_count].

        Raises ValueError for levels outside 0 to 1, and for 0 and 1 themselves.
        """
        wanted = np.atleast_1d(numbers("levels", levels))
        if wanted.ndim != 1 or not ((wanted > 0.0) & (wanted < 1.0)).all():
            raise ValueError(f"levels are {wanted.tolist()}, but must be a list of numbers above 0 and below 1")
        # At the least mean's own quantile no part of the mixture has reached its level, at the greatest's all have.
        own, means = self.normals.deviation * special.ndtri(wanted), self.normals.means
        low, high = means.min(axis=1)[:, None] + own, means.max(axis=1)[:, None] + own
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            below = self.normals.averaged(special.ndtr, middle) < wanted
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return self._outputs(0.5 * (low + high))

    @property
    def mean(self) -> Array:
        """Mean output [point_count]."""
        normals, mean = self.normals, np.zeros(len(self.lower))
        for node, share in zip(*hermite(NORMAL_NODES).gauss_rule(), strict=True):
            mean += share * (self._outputs(normals.means + normals.deviation * node) * normals.weights).sum(axis=1)
        return mean

    def _coordinates(self, y: ArrayLike) -> tuple[Array, Array]:
        """Coordinates of y and their slopes [point_count, value_count]."""
        values, count = np.atleast_1d(numbers("y", y)), len(self.lower)
        if values.ndim > 2 or (values.ndim == 2 and len(values) != count) or np.isnan(values).any():
            raise ValueError(
                f"y has shape {values.shape}, but must be [value_count] or [{count}, value_count], without NaN"
            )
        table = np.broadcast_to(values, (count, values.shape[-1]))
        coordinate, slope = with_slope(table, *self.bending)
        # Beyond a bound that bends nothing there is as little as beyond another one.
        coordinate = np.where(table <= self.lower, -np.inf, np.where(table >= self.upper, np.inf, coordinate))
        return coordinate, np.where(np.isinf(coordinate), 0.0, slope)

    def _outputs(self, coordinates: Array) -> Array:
        """Outputs of coordinates [point_count, any]."""
        return inside(from_coordinate(coordinates, *self.bending), self.lower, self.upper)


def output_law(
    model: Parts, points: Array, output: str | None, bounds: tuple[ArrayLike | None, ArrayLike | None]
) -> OutputLaw:
    """The law of one output of an emulator, as in `Emulator.output_law`; raises ValueError for names it has not."""
    modelled = [model.runs.output_names[column] for column in model.runs.modelled]
    if output is None and len(modelled) == 1:
        output = modelled[0]
    if output not in modelled:
        raise ValueError(f"output is {output!r}; allowed: {', '.join(modelled)}")
    column = model.runs.output_names.index(output)
    low, high = model.runs.bounds_at(*bounds, len(points))
    bending = tuple(bound[:, [column]] for bound in model.runs.bending(low, high))
    expansion = model.expansion
    normals = _of_rows(model, points, modelled.index(output)) if expansion is None else expansion.normals(points)
    return OutputLaw(normals, low[:, [column]], high[:, [column]], (bending[0], bending[1]))


def _of_rows(model: Parts, points: Array, place: int) -> Normals:
    """A normal about each row, as draws are smoothed. Raises ValueError where rows do not scatter."""
    law, matrix = model.law, model.terms.matrix(points)
    size, root = smoothing(law.rows, law.weights)
    shrunk, spread = np.sqrt(1.0 + size**2), np.linalg.norm(root[place])
    if spread == 0.0:
        raise ValueError("the output does not scatter in the runs, so it has no density: use lithobrake.chaos.fit")
    location, scale = (one[:, [place]] for one in law.at(matrix))
    weights = row_weights(matrix[:, : len(model.runs.inputs)], model.row_points, law.weights, model.choices.widths)
    return Normals(weights, location + scale * law.rows[:, place] / shrunk, scale * size * spread / shrunk)
