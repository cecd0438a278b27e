"""Bounded outputs as unbounded coordinates: logit between two bounds, logarithm beyond one, the output itself else.

A law that is fitted in these coordinates cannot leave the bounds, whatever it draws. A bound far from all outputs
bends no coordinate: draws beyond it are put onto the next number inside.
"""

import numpy as np

from lithobrake.vocabulary.arrays import Array


def to_coordinate(y: Array, lower: Array, upper: Array) -> Array:
    """Coordinates of outputs y strictly between bounds of the same shape; an infinite bound is none."""
    has_lower, has_upper = np.isfinite(lower), np.isfinite(upper)
    # Where there is no bound the distance is 1, of which the logarithm is 0.
    above = np.where(has_lower, y - np.where(has_lower, lower, 0.0), 1.0)
    below = np.where(has_upper, np.where(has_upper, upper, 0.0) - y, 1.0)
    return np.where(has_lower | has_upper, np.log(above) - np.log(below), y)


def with_slope(y: Array, lower: Array, upper: Array) -> tuple[Array, Array]:
    """Coordinates of any outputs, and derivatives of them by the output; beyond a bound infinite, with derivative 0.

    Bounds broadcast to the shape of y.
    """
    low, high = np.broadcast_to(lower, y.shape), np.broadcast_to(upper, y.shape)
    within = np.clip(y, np.nextafter(low, np.inf), np.nextafter(high, -np.inf))
    coordinate = np.where(y <= low, -np.inf, np.where(y >= high, np.inf, to_coordinate(within, low, high)))
    # Of an infinite bound nothing is left; at the smallest numbers a derivative would overflow.
    with np.errstate(over="ignore"):
        slope = np.minimum(1.0 / (within - low) + 1.0 / (high - within), np.finfo(float).max)
    slope = np.where(np.isfinite(low) | np.isfinite(high), slope, 1.0)
    return coordinate, np.where(np.isinf(coordinate), 0.0, slope)


def from_coordinate(coordinate: Array, lower: Array, upper: Array) -> Array:
    """Outputs of coordinates, strictly between bounds that broadcast to their shape."""
    has_lower, has_upper = np.isfinite(lower), np.isfinite(upper)
    start, end = np.where(has_lower, lower, 0.0), np.where(has_upper, upper, 0.0)
    # Of a coordinate far out no more than the bound itself would be left: the exponent is the smaller one.
    share = 1.0 / (1.0 + np.exp(-np.clip(coordinate, -700.0, 700.0)))
    grown = np.exp(np.clip(coordinate, -700.0, 700.0))
    two_sided = start + (end - start) * share
    one_sided = np.where(has_lower, start + grown, end - 1.0 / grown)
    y = np.where(has_lower & has_upper, two_sided, np.where(has_lower | has_upper, one_sided, coordinate))
    # Rounding may put a draw onto a bound, which no output reaches.
    return inside(y, lower, upper)


def inside(y: Array, lower: Array, upper: Array) -> Array:
    """Outputs with those beyond bounds put onto the next number inside."""
    return np.clip(y, np.nextafter(lower, np.inf), np.nextafter(upper, -np.inf))
