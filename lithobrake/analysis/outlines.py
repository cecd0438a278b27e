"""Outlines of regions with no more points than their shape needs."""

import math

import numpy as np

from lithobrake.vocabulary.array_types import Array

# Places are rounded to this part of the tolerance of the outline that they are on.
ROUNDING = 0.01


def thinned(line: Array, tolerance: float) -> Array:
    """The points of a closed line [count, 2] that keep all others within a tolerance of it; in the unit of the line.

    Its first and last point, which are one, stay, and so does the one farthest from them. A line that would have no
    area left is returned whole. Source: [Douglas-1973].
    """
    kept = np.zeros(len(line), dtype=bool)
    far = int(np.argmax(np.linalg.norm(line - line[0], axis=1)))
    kept[[0, far, -1]] = True
    open_parts = [(0, far), (far, len(line) - 1)]
    while open_parts:
        first, last = open_parts.pop()
        if last - first < 2:
            continue
        away = _distances(line[first + 1 : last], line[first], line[last])
        most = int(np.argmax(away))
        if away[most] > tolerance:
            middle = first + 1 + most
            kept[middle] = True
            open_parts += [(first, middle), (middle, last)]
    return line[kept] if kept.sum() > 3 else line


def _distances(points: Array, start: Array, end: Array) -> Array:
    """Distances of points [count, 2] from the straight line between two of them, [count]."""
    along = end - start
    square = float(along @ along)
    part = np.clip((points - start) @ along / square, 0.0, 1.0) if square > 0.0 else np.zeros(len(points))
    distances: Array = np.linalg.norm(points - start - part[:, None] * along, axis=1)
    return distances


def to_the_tolerance(outline: Array, tolerance: float) -> Array:
    """Latitude and longitude [deg], [count, 2], to as many decimals as a tolerance [rad] deserves.

    Neither angle moves by more than a hundredth of it. Longitudes stay in (-180, 180].
    """
    decimals = max(0, math.ceil(-math.log10(2.0 * ROUNDING * math.degrees(tolerance))))
    latitude, longitude = np.round(outline, decimals).T + 0.0
    return np.column_stack([latitude, np.where(longitude == -180.0, 180.0, longitude)])
