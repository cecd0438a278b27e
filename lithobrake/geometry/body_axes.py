"""Axes fixed to a body that turns about its pole, against those of ICRF."""

import numpy as np
from numpy.typing import ArrayLike


def axes_in_icrf(pole_right_ascension_deg: float, pole_declination_deg: float, meridian: ArrayLike) -> np.ndarray:
    """The body's axes x, y, z along ICRF in rows, [..., 3, 3]: they turn components along ICRF into body-fixed ones.

    meridian: angle W of longitude 0 [rad], [...], from the node of the body's equator on that of ICRF, eastward.
    Source: [Archinal-2018], Fig 1.
    """
    right_ascension, declination = np.radians(pole_right_ascension_deg), np.radians(pole_declination_deg)
    node = np.array([-np.sin(right_ascension), np.cos(right_ascension), 0.0])
    pole = np.array(
        [
            np.cos(declination) * np.cos(right_ascension),
            np.cos(declination) * np.sin(right_ascension),
            np.sin(declination),
        ]
    )
    ahead = np.cross(pole, node)
    angle = np.asarray(meridian, dtype=np.float64)[..., None]
    x = np.cos(angle) * node + np.sin(angle) * ahead
    y = np.cos(angle) * ahead - np.sin(angle) * node
    return np.stack([x, y, np.broadcast_to(pole, x.shape)], axis=-2)
