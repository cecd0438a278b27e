"""Angles between places on a ball, by latitude and longitude."""

import numpy as np
from numpy.typing import ArrayLike


def directions(latitude_deg: ArrayLike, longitude_deg: ArrayLike) -> np.ndarray:
    """Unit vectors [..., 3] of planetocentric latitudes and east longitudes [deg], both [...]."""
    latitude, longitude = np.radians(latitude_deg), np.radians(longitude_deg)
    level = np.cos(latitude)
    return np.stack([level * np.cos(longitude), level * np.sin(longitude), np.sin(latitude)], axis=-1)


def angles(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Angles [rad], [...], between directions [..., 3]."""
    # The arctangent keeps the small angles that the arccosine loses.
    between: np.ndarray = np.arctan2(np.linalg.norm(np.cross(one, other), axis=-1), (one * other).sum(axis=-1))
    return between
