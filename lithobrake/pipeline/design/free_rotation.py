"""How a lander turns in flight: without torque, against ground that turns too."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

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
    from lithobrake.smallbody.free_rotation import turned_freely
    from lithobrake.smallbody.turning_ground import ground_spin

    (turning,) = ground_spin(ground, np.array([start + time]), np.array([spin_period]))
    after, spin_after = turned_freely(inertia, attitude, spin, spin_period, time, ground=ground, start=start)
    return after, spin_after - turning
