"""How a lander turns in flight: without torque, seen from a body that turns too."""

import math

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.geometry.contact_frame import about_z, quaternion
from lithobrake.smallbody.arrays import Floats
from lithobrake.smallbody.attitude_history import AttitudeHistory
from lithobrake.smallbody.tumbling import tumble


def turned_freely(
    inertia: Floats,
    attitude: Rotation,
    spin: Floats,
    spin_period: float,
    time: float,
    *,
    ground: AttitudeHistory | None = None,
    start: float = 0.0,
) -> tuple[Rotation, Floats]:
    """Attitude of a lander and its spin against the stars [rad/s], [3], a time [s] later, or earlier where it is below
    0, from those at its start, all along axes fixed to the body as it then is.

    inertia: of the lander [kg m2], [3, 3]. spin_period: of the body about z [s]. ground: Body.rotation, at a time start
    [s].
    """
    turned, spins = tumble(inertia, np.array([quaternion(attitude)]), spin[None], np.array([time]))
    back = about_z(-2.0 * math.pi / spin_period * time)
    if ground is not None:
        begin, end = (Rotation.from_matrix(ground.at(at).axes[0]) for at in (start, start + time))
        back = end.inv() * back * begin
    return back * Rotation.from_quat(turned[0], scalar_first=True), back.apply(spins[0])
