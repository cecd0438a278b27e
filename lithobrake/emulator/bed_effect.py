"""What runs on one bed have in common: how much of their scatter it is, and what some of them say of the next.

In coordinates in which residual rows have covariance 1, a run is a bed's effect and a rest of its own. Given runs on a
bed, the next has the effect's best linear prediction on top, and the rows narrowed to what is left of the covariance:
any number of runs has the covariance of beds drawn at random, and the first on a bed has the emulator's own law.
Source: [Searle-1992], section 3.6 (analysis of variance) and chapter 7 (best linear prediction).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from lithobrake.vocabulary.arrays import Array

# Of the variance of a direction that beds may have at most: with all of it runs on one bed would be alike.
MOST_OF_BED = 0.95


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
        """The effect of a bed of which nothing is known."""
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
        values, vectors = np.linalg.eigh(self._next)
        # Rounding must not turn the first run on a bed.
        if (self.covariance == self.before).all():
            return np.broadcast_to(np.eye(len(self.before)), self.covariance.shape)
        return (vectors * np.sqrt(np.maximum(values, 0.0))[:, None, :]) @ vectors.transpose(0, 2, 1)

    def given(self, root: Array, columns: Sequence[int], left: Array, blur: Array) -> "BedEffect":
        """The effect after one more run: left [point_count, len(columns)], what its standardised outputs are beyond
        the mean; blur likewise: their errors; root: as in `Kernels`.
        """
        seen = root[list(columns)]
        expected = seen @ self._next @ seen.T
        if blur.any():
            expected = expected + blur[:, :, None] ** 2 * np.eye(len(columns))
        gain = self.covariance @ seen.T @ np.linalg.inv(expected)
        moved = np.einsum("pij,pj->pi", np.broadcast_to(gain, (len(left), *gain.shape[1:])), left)
        return replace(self, mean=self.mean + moved, covariance=self.covariance - gain @ seen @ self.covariance)

    @property
    def _next(self) -> Array:
        """Covariance of the next run about its mean."""
        return np.eye(len(self.before)) - self.before + self.covariance
