"""How a lander leaves: one velocity from the drawn speed, elevation and azimuth, whether it can be, and its spin."""

import math
from collections.abc import Sequence

import numpy as np

from lithobrake.vocabulary.quantities import VELOCITY_OUT

VELOCITY = VELOCITY_OUT


def outgoing(outputs: np.ndarray, names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """Outputs whose velocity has the drawn speed, elevation and azimuth, and which of them can be.

    outputs: [count, output_count], SI, columns as the names say; result of the same shape, and [count]. The azimuth is
    that of the drawn horizontal components. Components that were drawn one by one shrink towards their means, so their
    speed is less than the speed that was drawn. A speed of 0 or less, or an elevation outside 0 to 90 degrees, is no
    way to leave: such a draw says nothing of the lander.
    """
    column = {name: outputs[:, list(names).index(name)] for name in ("speed_out", "elevation_out", *VELOCITY)}
    speed, elevation = column["speed_out"], column["elevation_out"]
    azimuth = np.arctan2(column["velocity_out_y"], column["velocity_out_x"])
    result = outputs.copy()
    result[:, [list(names).index(name) for name in VELOCITY]] = outgoing_velocity(speed, elevation, azimuth)
    return result, (speed > 0.0) & (elevation > 0.0) & (elevation <= 0.5 * math.pi)


def outgoing_velocity(speed: np.ndarray, elevation: np.ndarray, azimuth: np.ndarray) -> np.ndarray:
    """Velocities [m/s] in the frame of the touchdown, [count, 3], from speed [m/s], elevation and azimuth [rad]."""
    level = speed * np.cos(elevation)
    return np.column_stack([level * np.cos(azimuth), level * np.sin(azimuth), speed * np.sin(elevation)])


def rolling_spin(velocity: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Angular velocity [rad/s] of a size, shape [count], about the axis of rolling along velocities [count, 3]."""
    across = np.column_stack([-velocity[:, 1], velocity[:, 0], np.zeros(len(velocity))])
    length = np.linalg.norm(across, axis=1, keepdims=True)
    # Straight up there is no direction to roll in; any level axis will do.
    axis = np.where(length > 0.0, across / np.where(length > 0.0, length, 1.0), np.array([0.0, 1.0, 0.0]))
    spin: np.ndarray = axis * size[:, None]
    return spin
