"""How a lander leaves: one velocity from the drawn speed, elevation and azimuth, and whether it can be."""

import math
from collections.abc import Sequence

import numpy as np

VELOCITY = ("velocity_out_x", "velocity_out_y", "velocity_out_z")


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
    level = speed * np.cos(elevation)
    result = outputs.copy()
    result[:, [list(names).index(name) for name in VELOCITY]] = np.column_stack(
        [level * np.cos(azimuth), level * np.sin(azimuth), speed * np.sin(elevation)]
    )
    return result, (speed > 0.0) & (elevation > 0.0) & (elevation <= 0.5 * math.pi)
