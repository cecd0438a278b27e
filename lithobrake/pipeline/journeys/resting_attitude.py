"""How a lander lies: which side is down, and its tilt against the plumb line."""

import math

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.study.lander_sides import SIDES


def side_down(attitude: Rotation, acceleration: np.ndarray) -> tuple[str, float]:
    """The side of the lander that points down most, and the angle [rad] between it and the plumb line.

    attitude: of the lander, acceleration [m/s2]: of what rests there, both in one frame.
    """
    down = attitude.inv().apply(acceleration / np.linalg.norm(acceleration))
    axis = int(np.argmax(np.abs(down)))
    return SIDES[2 * axis + int(down[axis] < 0.0)], math.acos(min(abs(float(down[axis])), 1.0))
