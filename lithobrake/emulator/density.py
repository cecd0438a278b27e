"""Density of observed outputs by an emulator: a kernel about each residual row."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from lithobrake.vocabulary.arrays import Array

# Rows times points that are looked at together: bounds the memory.
_BLOCK = 1 << 20
# Of the normal rule ([Silverman-1986], section 4.3). Draws have half of it, to keep their skewness, but the product of
# densities over several bounces follows the bumps that narrow kernels leave between rows (docs/decisions/chaos.md has
# how often intervals held the truth by this factor).
DENSITY_FACTOR = 1.5


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
        whole: Array = self.rows / np.sqrt(1.0 - self.size**2)
        return whole

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
        factor = np.linalg.inv(np.linalg.cholesky(covariance))
        whitened = np.einsum("pij,pj->pi", np.broadcast_to(factor, (len(standard), *factor.shape[1:])), standard)
        squares = self._squares(whitened, np.ascontiguousarray(factor @ seen))
        determinant = np.log(np.diagonal(factor, axis1=1, axis2=2)).sum(axis=1)
        step = max(1, _BLOCK // len(self.rows))
        blocks = [slice(start, start + step) for start in range(0, len(standard), step)]
        found = [_log_sum(squares[block] @ self._features.T, _rows_of(log_chances, block)) for block in blocks]
        density: Array = np.concatenate(found) + determinant - 0.5 * len(columns) * np.log(2.0 * np.pi)
        return density

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


def _rows_of(table: Array, block: slice) -> Array:
    """A block of points of a table, or its one row for all of them."""
    return table if len(table) == 1 else table[block]


def _log_sum(logarithms: Array, log_chances: Array) -> Array:
    """Logarithm of the sum of exponentials over rows [point_count]; the nearest row keeps it finite."""
    logarithms += log_chances
    nearest = logarithms.max(axis=1)
    logarithms -= nearest[:, None]
    np.exp(logarithms, out=logarithms)
    total: Array = np.log(logarithms.sum(axis=1)) + nearest
    return total
