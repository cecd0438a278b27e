"""How a lander turns in flight: without torque, against ground that turns too."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.geometry.contact_frame import about_z, quaternion
from lithobrake.study import Study
from lithobrake.study.touchdown_model import lander

if TYPE_CHECKING:
    from lithobrake.smallbody import AttitudeHistory


def lander_inertia(study: Study, row: Mapping[str, float]) -> np.ndarray:
    """Inertia of the lander of a journey about its centre of mass [kg m2], [3, 3]."""
    return lander(study, row).body.inertia


def turned_in_flight(
    inertia: np.ndarray,
    attitude: Rotation,
    spin: np.ndarray,
    spin_period: float,
    time: float,
    *,
    ground: "AttitudeHistory | None" = None,
    start: float = 0.0,
) -> tuple[Rotation, np.ndarray]:
    """Attitude and spin [rad/s], against the ground, after a flight [s], from those at its start, fixed to the body.

    inertia: of the lander [kg m2], [3, 3]. spin: at the start, against axes that do not turn. spin_period: of the body
    about z [s]. ground: Body.rotation, of which the flight begins at a time start [s].
    """
    from lithobrake.smallbody import tumble
    from lithobrake.smallbody.turning_ground import ground_spin

    (turning,) = ground_spin(ground, np.array([start + time]), np.array([spin_period]))
    turned, spins = tumble(inertia, np.array([quaternion(attitude)]), spin[None], np.array([time]))
    back = about_z(-2.0 * np.pi / spin_period * time)
    if ground is not None:
        begin, end = (Rotation.from_matrix(ground.at(at).axes[0]) for at in (start, start + time))
        back = end.inv() * back * begin
    w, x, y, z = turned[0]
    return back * Rotation.from_quat([x, y, z, w]), back.apply(spins[0]) - turning
