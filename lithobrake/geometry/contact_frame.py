"""Attitudes, spins and vectors between the frame of a touchdown and axes fixed to the body.

The frame of a touchdown has x along the incoming horizontal velocity and z along the outward normal of the ground.
"""

import math
from collections.abc import Mapping

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.vocabulary.quantities import ORIENTATION, ORIENTATION_OUT, SPIN, SPIN_OUT


def attitude_of(outputs: Mapping[str, float], names: tuple[str, ...] = ORIENTATION_OUT) -> Rotation:
    """The attitude at the end of a touchdown, in its frame; none told: unturned."""
    w, x, y, z = (outputs.get(name, default) for name, default in zip(names, (1.0, 0.0, 0.0, 0.0), strict=True))
    return Rotation.from_quat([x, y, z, w])


def spin_of(outputs: Mapping[str, float]) -> np.ndarray:
    """The spin at the end of a touchdown [rad/s], in its frame, against the ground; none told: none."""
    return np.array([outputs.get(name, 0.0) for name in SPIN_OUT])


def quaternion(attitude: Rotation) -> tuple[float, float, float, float]:
    """An attitude as w, x, y, z."""
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
