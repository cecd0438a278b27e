"""Inputs of a touchdown from the flight that ends with it."""

import math

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.geometry.contact_frame import about_z, from_frame, quaternion
from lithobrake.vocabulary.quantities import ORIENTATION, SPIN

Row = dict[str, float]
# A lander that comes in along the ground meets it from above all the same.
FLATTEST_DEG = 89.9


def impact_inputs(speed: float, incidence: float) -> Row:
    """Speed [m/s] and incidence [rad] of an impact, as inputs of its touchdown."""
    return {"impact.speed": speed, "impact.incidence_deg": min(math.degrees(incidence), FLATTEST_DEG)}


def attitude_inputs(axes: np.ndarray, azimuth_deg: float, attitude: Rotation, spin: np.ndarray) -> Row:
    """Attitude and spin [rad/s], both fixed to the body, in the frame of the bed.

    axes: of the touchdown in rows, [3, 3], whose x lies along the incoming horizontal velocity, at this azimuth in the
    bed.
    """
    into_bed = about_z(math.radians(azimuth_deg)) * from_frame(axes).inv()
    spins = dict(zip(SPIN, into_bed.apply(spin).tolist(), strict=True))
    return spins | dict(zip(ORIENTATION, quaternion(into_bed * attitude), strict=True))
