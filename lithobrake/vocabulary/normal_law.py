"""What scores of predictions and of emulators take of the normal law."""

import math

import numpy as np
from scipy import special

from lithobrake.vocabulary.array_types import Array


def mean_distance(mean: Array, deviation: Array | float) -> Array:
    """Mean of the absolute value of a normal variable of this mean and standard deviation, arrays that broadcast; a
    deviation of 0 throughout leaves the absolute value of the mean. Source: [Grimit-2006].
    """
    if not np.any(deviation):
        return np.abs(mean)
    z = mean / deviation
    density = np.exp(-0.5 * z * z) / math.sqrt(2.0 * math.pi)
    return np.asarray(mean * (2.0 * special.ndtr(z) - 1.0) + 2.0 * deviation * density)
