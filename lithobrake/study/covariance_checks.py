"""What keeps a matrix of a study file from being a covariance, and draws from going together as it asks."""

import math
from collections.abc import Iterator

from lithobrake.study.release_section import SIDE, Matrix

# Of numbers that were written with ten digits.
ROUNDING = 1e-9


def covariance_problems(matrix: Matrix) -> Iterator[str]:
    """What is wrong with a matrix of six rows, after its name; the first thing alone."""
    pairs = [(row, column) for row in range(SIDE) for column in range(row)]
    wrong = [text for row in range(SIDE) if (text := _variance(matrix, row))]
    wrong = wrong or [text for row, column in pairs if (text := _pair(matrix, row, column))]
    if wrong:
        yield wrong[0]
    elif (smallest := _smallest(matrix)) < -SIDE * ROUNDING:
        yield (
            f"has correlations whose matrix has the eigenvalue {smallest:.3g}; allowed: none below 0 (positive "
            "semi-definite); weaken correlations that contradict each other, or write more digits"
        )


def _variance(matrix: Matrix, row: int) -> str | None:
    variance = matrix[row][row]
    if variance >= 0.0:
        return None
    return f"has {variance:g} as the variance in row {row + 1}; allowed: at least 0; mend it"


def _pair(matrix: Matrix, row: int, column: int) -> str | None:
    """What is wrong with two entries that mirror each other."""
    one, other = matrix[row][column], matrix[column][row]
    size = math.sqrt(matrix[row][row] * matrix[column][column])
    where = f"row {row + 1}, column {column + 1}"
    if abs(one - other) > ROUNDING * max(abs(one), abs(other)):
        return (
            f"has {one:g} in {where} and {other:g} in row {column + 1}, column {row + 1}; allowed: a symmetric matrix; "
            "make the two equal"
        )
    if abs(one) > size * (1.0 + ROUNDING):
        return f"has {one:g} in {where}; allowed: -{size:g} to {size:g}, by the two variances; lower it, or raise these"
    return None


def _smallest(matrix: Matrix) -> float:
    """The smallest eigenvalue of its correlations; what has no variance is left out by being correlated with nothing"""
    import numpy as np

    variances = np.array([matrix[row][row] for row in range(SIDE)])
    scale = np.sqrt(np.where(variances > 0.0, variances, 1.0))
    return float(np.linalg.eigvalsh(np.array(matrix) / np.outer(scale, scale))[0])
