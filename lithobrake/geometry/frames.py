"""Axes fixed to a turning body, the frame of a touchdown, and angles between places on a ball."""

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from lithobrake.vocabulary.quantities import ORIENTATION, ORIENTATION_OUT, SPIN, SPIN_OUT


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


def attitude_of(outputs: Mapping[str, float], names: tuple[str, ...] = ORIENTATION_OUT) -> Rotation:
    """The attitude at the end of a touchdown, in its frame; none told: unturned."""
    w, x, y, z = (outputs.get(name, default) for name, default in zip(names, (1.0, 0.0, 0.0, 0.0), strict=True))
    return Rotation.from_quat([x, y, z, w])


def spin_of(outputs: Mapping[str, float]) -> np.ndarray:
    """The spin at the end of a touchdown [rad/s], in its frame, against the ground; none told: none."""
    return np.array([outputs.get(name, 0.0) for name in SPIN_OUT])


def quaternion(attitude: Rotation) -> tuple[float, float, float, float]:
    """An attitude as w, x, y, z."""
    # Of the two quaternions of an attitude the one with w >= 0, so that equal attitudes are equal numbers.
    x, y, z, w = attitude.as_quat(canonical=True).tolist()
    return w, x, y, z


def from_frame(axes: np.ndarray) -> Rotation:
    """The rotation that turns vectors of a frame with these axes in rows [3, 3] into those of the body."""
    return Rotation.from_matrix(axes.T)


def arriving(inputs: Mapping[str, float], axes: np.ndarray) -> tuple[Rotation, np.ndarray]:
    """Attitude of a lander as a touchdown begins, and its spin against the ground [rad/s], both fixed to the body.

    inputs: of the touchdown, in the frame of its bed; axes: of the touchdown in rows, [3, 3], body-fixed.
    """
    out_of_bed = from_frame(axes) * about_z(-math.radians(inputs["impact.azimuth_deg"]))
    return out_of_bed * attitude_of(inputs, ORIENTATION), out_of_bed.apply([inputs[name] for name in SPIN])


def about_z(angle: float) -> Rotation:
    """A rotation about z by an angle [rad]."""
    return Rotation.from_quat([0.0, 0.0, math.sin(0.5 * angle), math.cos(0.5 * angle)])


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
