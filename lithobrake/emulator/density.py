"""Density of observed outputs by an emulator, alone or beside others on their bed."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.emulator.law import log_row_weights, smoothing
from lithobrake.emulator.stochastic_expansion import Normals
from lithobrake.emulator.storage import Parts
from lithobrake.emulator.training_runs import with_slope
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import finite_number

# Rows times points that are looked at together: bounds the memory.
_BLOCK = 1 << 20
# Of the normal rule ([Silverman-1986], section 4.3). Draws have half of it, to keep their skewness, but the product of
# densities over several bounces follows the bumps that narrow kernels leave between rows (docs/decisions/chaos.md has
# how often intervals held the truth by this factor).
DENSITY_FACTOR = 1.5
# Of the variance of a direction that beds may have at most: with all of it runs on one bed would be alike.
MOST_OF_BED = 0.95
# Of an observation: the squares of larger ones overflow, and these say nothing either.
LARGEST_ERROR = 1e100
# Outputs whose variance, given the others, is a smaller part of their own follow from these: the rest is rounding.
TIED = 1e-12


@dataclass(frozen=True)
class Kernels:
    """Normal kernels about residual rows, in coordinates in which the rows have covariance 1.

    rows [row_count, output_count]; size: standard deviation of a kernel in every direction; root
    [output_count, output_count] turns these coordinates into standardised outputs.
    """

    rows: Array
    size: float
    root: Array

    @classmethod
    def of(cls, rows: Array, size: float, root: Array) -> "Kernels":
        """Kernels that keep the covariance of the rows. size, root: of their smoothing; Source: [Silverman-1987]."""
        shrunk = np.sqrt(1.0 + size**2)
        return cls(rows @ np.linalg.pinv(root).T / shrunk, size / shrunk, root)

    @property
    def whitened(self) -> Array:
        """The residual rows themselves in coordinates of covariance 1 [row_count, output_count]."""
        return self.rows / np.sqrt(1.0 - self.size**2)

    def log_density(
        self, columns: Sequence[int], standard: Array, blur: Array, log_chances: Array, spread: Array
    ) -> Array:
        """Logarithm of the density of standardised outputs [point_count, len(columns)] at each point, [point_count].

        blur [point_count, len(columns)]: standard deviation of the observation in the same unit; log_chances
        [point_count or 1, row_count] of the rows; spread [point_count or 1, output_count, output_count]: what rows are
        multiplied by in the coordinates of covariance 1. Outputs that are not observed drop out with their columns.
        """
        seen = self.root[list(columns)] @ spread
        covariance = self.size**2 * seen @ seen.transpose(0, 2, 1)
        if blur.any():
            # Errors are blurred into the kernel, so that it is another one wherever the scale is.
            covariance = covariance + blur[:, :, None] ** 2 * np.eye(len(columns))
        root = np.linalg.cholesky(covariance)
        left = np.diagonal(root, axis1=1, axis2=2) ** 2
        if (left < TIED * np.diagonal(covariance, axis1=1, axis2=2)).any():
            raise np.linalg.LinAlgError("of an output nothing but rounding is left, given the others")
        factor = np.linalg.inv(root)
        whitened = np.einsum("pij,pj->pi", np.broadcast_to(factor, (len(standard), *factor.shape[1:])), standard)
        # All distances of points to rows are then one product of matrices, without an array [point, row, output].
        squares = self._squares(whitened, np.ascontiguousarray(factor @ seen))
        determinant = np.log(np.diagonal(factor, axis1=1, axis2=2)).sum(axis=1)
        step = max(1, _BLOCK // len(self.rows))
        blocks = [slice(start, start + step) for start in range(0, len(standard), step)]
        chances = np.broadcast_to(log_chances, (len(standard), len(self.rows)))
        found = [_log_sum(squares[block] @ self._features.T, chances[block]) for block in blocks]
        return np.concatenate(found) + determinant - 0.5 * len(columns) * np.log(2.0 * np.pi)

    @property
    def _features(self) -> Array:
        """Powers of the rows, of which the square of any distance from them is a sum [row_count, feature_count]."""
        products = (self.rows[:, :, None] * self.rows[:, None, :]).reshape(len(self.rows), -1)
        return np.column_stack([np.ones(len(self.rows)), self.rows, products])

    def _squares(self, whitened: Array, seen: Array) -> Array:
        """Coefficients of the features of -|whitened - seen @ row|^2 / 2, [point_count, feature_count]."""
        quadratic = (seen.transpose(0, 2, 1) @ seen).reshape(len(seen), -1)
        linear = np.einsum("pij,pi->pj", np.broadcast_to(seen, (len(whitened), *seen.shape[1:])), whitened)
        quadratic = np.broadcast_to(quadratic, (len(whitened), quadratic.shape[1]))
        return np.column_stack([-0.5 * (whitened**2).sum(axis=1), linear, -0.5 * quadratic])


def _log_sum(logarithms: Array, log_chances: Array) -> Array:
    """Logarithm of the sum of exponentials over rows [point_count]; the nearest row keeps it finite."""
    logarithms += log_chances
    nearest = logarithms.max(axis=1)
    logarithms -= nearest[:, None]
    np.exp(logarithms, out=logarithms)
    return np.log(logarithms.sum(axis=1)) + nearest


@dataclass(frozen=True)
class BedEffect:
    """A bed's effect given the runs that were seen on it, normal, in the coordinates of covariance 1.

    mean [point_count or 1, output_count], covariance [point_count or 1, output_count, output_count]; before
    [output_count, output_count]: covariance over all beds.
    """

    mean: Array
    covariance: Array
    before: Array

    @classmethod
    def unseen(cls, before: Array) -> "BedEffect":
        return cls(np.zeros((1, len(before))), before[None], before)

    @classmethod
    def none(cls, output_count: int) -> "BedEffect":
        """That of a bed which no other run shares."""
        return cls.unseen(np.zeros((output_count, output_count)))

    @classmethod
    def of_groups(cls, rows: Array, weights: Array, group: NDArray[np.int64]) -> "BedEffect":
        """Before any run is seen, by analysis of variance of rows [row_count, output_count] of covariance 1.

        weights: how often each row counts [row_count], in a bed alike; a bed that counts twice is two beds. The
        covariance is cut to between 0 and nearly all. Raises ValueError where no bed has two rows, or none but one.
        """
        there = weights > 0.0
        bed = np.unique(group[there], return_inverse=True)[1]
        values, weight = rows[there], weights[there]
        runs, total = np.bincount(bed), np.bincount(bed, weight)
        beds, whole = float((total / runs).sum()), float(total.sum())
        if whole - beds <= 0.0 or len(runs) < 2:
            raise ValueError(
                "no bed of the emulator has two runs with outputs, so nothing is known of what runs on one bed have in "
                "common; leave the bed of each bounce out, or fit the emulator with groups"
            )
        means = np.column_stack([np.bincount(bed, weight * one) / total for one in values.T])
        inside, between = values - means[bed], means - total @ means / whole
        within = (inside.T * weight) @ inside / (whole - beds)
        of_means = (between.T * total) @ between / (beds - 1.0)
        runs_of_bed = (whole - float(total @ runs) / whole) / (beds - 1.0)
        shares, vectors = np.linalg.eigh((of_means - within) / runs_of_bed)
        return cls.unseen((vectors * np.clip(shares, 0.0, MOST_OF_BED)) @ vectors.T)

    @property
    def spread(self) -> Array:
        """Root of the covariance of the next run about its mean, [point_count or 1, output_count, output_count]."""
        # Rounding must not turn the first run on a bed.
        if (self.covariance == self.before).all():
            return np.broadcast_to(np.eye(len(self.before)), self.covariance.shape)
        values, vectors = np.linalg.eigh(self._next)
        return (vectors * np.sqrt(np.maximum(values, 0.0))[:, None, :]) @ vectors.transpose(0, 2, 1)

    def given(self, root: Array, columns: Sequence[int], left: Array, blur: Array) -> "BedEffect":
        """The effect after one more run: left [point_count, len(columns)], what its standardised outputs are beyond
        the mean; blur likewise: their errors; root: as in `Kernels`.
        """
        if not self.before.any():
            # On a bed that no other run shares nothing is learnt.
            return self
        seen = root[list(columns)]
        expected = seen @ self._next @ seen.T
        if blur.any():
            expected = expected + blur[:, :, None] ** 2 * np.eye(len(columns))
        gain = self.covariance @ seen.T @ np.linalg.inv(expected)
        moved = np.einsum("pij,pj->pi", np.broadcast_to(gain, (len(left), *gain.shape[1:])), left)
        return replace(self, mean=self.mean + moved, covariance=self.covariance - gain @ seen @ self.covariance)

    @property
    def _next(self) -> Array:
        return np.eye(len(self.before)) - self.before + self.covariance


def kernels_of(model: Parts) -> Kernels:
    return Kernels.of(model.law.rows, *smoothing(model.law.rows, model.law.weights, DENSITY_FACTOR))


def observed_density(
    model: Parts,
    observed: Mapping[str, float],
    at: tuple[Array, Array],
    errors: Mapping[str, float],
    outcome: str | None,
    bounds: tuple[ArrayLike | None, ArrayLike | None],
    bed: BedEffect,
) -> tuple[Array, BedEffect]:
    """Logarithm of the density of an observed run at points, and what it says of its bed.

    at: points [point_count, input_count] in physical units, and the emulator's terms there [point_count, term_count].
    observed, errors, outcome, bounds (lower and upper): as in `Emulator.log_density`. bed: its effect as far as other
    runs show it. An outcome without outputs has its chance alone, and says nothing of the bed.
    """
    points, matrix = at
    ended = _checked_outcome(model, observed, errors, outcome)
    chance = np.log(np.maximum(model.classes.chances(matrix)[:, ended], np.finfo(float).tiny))
    if not observed:
        return chance, bed
    low, high = model.runs.bounds_at(*bounds, len(matrix))
    columns = [model.runs.output_names.index(name) for name in observed]
    y = np.broadcast_to(list(observed.values()), (len(matrix), len(columns)))
    possible = np.all((y > low[:, columns]) & (y < high[:, columns]), axis=1)
    coordinate, slope = with_slope(y, *(bound[:, columns] for bound in model.runs.bending(low, high)))
    places = [model.runs.modelled.index(column) for column in columns]
    # What lies beyond a bound at some point cannot have come from there.
    inside = possible & np.all(np.isfinite(coordinate), axis=1)
    steepness = np.log(np.where(inside[:, None], slope, 1.0)).sum(axis=1)
    coordinate, blur = np.where(inside[:, None], coordinate, 0.0), slope * [errors.get(name, 0.0) for name in observed]
    if model.expansion is not None:
        found = _by_expansion(model.expansion.normals(points), coordinate, blur)
        return np.where(inside, chance + found + steepness, -np.inf), bed
    location, scale = (one[:, places] for one in model.law.at(matrix))
    kernels, standard, blur = kernels_of(model), (coordinate - location) / scale, blur / scale
    left = standard - bed.mean @ kernels.root[places].T
    chances = log_row_weights(
        matrix[:, : len(model.runs.inputs)], model.row_points, model.law.weights, model.choices.widths
    )
    found = _by_rows(list(observed), kernels, places, (left, blur), chances, bed.spread)
    steepness -= np.log(scale).sum(axis=1)
    density: Array = np.where(inside, chance + found + steepness, -np.inf)
    return density, bed.given(kernels.root, places, left, blur)


def _by_rows(
    names: Sequence[str], kernels: Kernels, places: Sequence[int], seen: tuple[Array, Array], chances: Array,
    spread: Array,
) -> Array:  # fmt: skip
    """`Kernels.log_density` of outputs and blurs seen; raises ValueError where some outputs follow from the others."""
    try:
        return kernels.log_density(places, *seen, chances, spread)
    except np.linalg.LinAlgError as error:
        raise ValueError(
            f"{', '.join(names)} have no density together: in the runs some of them follow from the others to "
            "the last digit; leave such outputs out, or give each an error"
        ) from error


def _by_expansion(normals: Normals, coordinate: Array, blur: Array) -> Array:
    """Logarithm of the density of a coordinate with errors of so many units, [point_count, 1] each, [point_count]."""
    return replace(normals, deviation=np.hypot(normals.deviation, blur)).log_density(coordinate[:, 0])


def _checked_outcome(
    model: Parts, observed: Mapping[str, float], errors: Mapping[str, float], outcome: str | None
) -> int:
    """Place of the outcome of an observation. Raises ValueError for names and values that cannot be."""
    modelled = [model.runs.output_names[column] for column in model.runs.modelled]
    if not (isinstance(observed, Mapping) and isinstance(errors, Mapping)):
        raise ValueError(f"outputs and errors must be dicts by name; outputs that may be observed: {modelled}")
    for name, value in observed.items():
        if name not in modelled:
            raise ValueError(f"{name} is observed as {value}; allowed: finite numbers of {', '.join(modelled)}")
        finite_number(f"observed {name}", value)
    for name, error in errors.items():
        if name not in observed:
            raise ValueError(f"the error of {name} is {error}; allowed: 0 or more, of what was observed")
        finite_number(f"the error of {name}", error, at_least=0.0, at_most=LARGEST_ERROR)
    if outcome is None:
        return model.runs.output_outcome
    if outcome not in model.runs.outcome_names:
        raise ValueError(f"outcome is {outcome!r}; allowed: {', '.join(model.runs.outcome_names)}")
    ended = model.runs.outcome_names.index(outcome)
    if observed and ended != model.runs.output_outcome:
        raise ValueError(f"outcome is {outcome!r}, which has no outputs: leave {', '.join(observed)} out")
    return ended
