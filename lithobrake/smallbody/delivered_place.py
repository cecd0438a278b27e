"""Where a place on a body lies that an error of delivery has moved along the ground."""

import numpy as np
from numpy.typing import NDArray

from lithobrake.smallbody.shape import Shape


def delivered_directions(
    shape: Shape,
    latitude_deg: NDArray[np.float64],
    longitude_deg: NDArray[np.float64],
    north: NDArray[np.float64],
    east: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Directions from the centre, shape [count, 3], in which places lie that an error [m] moved north and east."""
    latitude, longitude = np.radians(latitude_deg), np.radians(longitude_deg)
    sine, cosine, along, across = np.sin(latitude), np.cos(latitude), np.cos(longitude), np.sin(longitude)
    up = np.stack([cosine * along, cosine * across, sine], axis=1)
    northward = np.stack([-sine * along, -sine * across, cosine], axis=1)
    eastward = np.stack([-across, along, np.zeros_like(along)], axis=1)
    way = np.hypot(north, east)
    turn = way / np.linalg.norm(shape.surface_point(latitude_deg, longitude_deg), axis=1)
    ahead = (north / way)[:, None] * northward + (east / way)[:, None] * eastward
    there: NDArray[np.float64] = np.cos(turn)[:, None] * up + np.sin(turn)[:, None] * ahead
    return there
