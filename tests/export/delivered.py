"""A study of journeys of landers that are delivered by states along ICRF, with attitudes."""

from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.pipeline.design.arrivals import against_ground, icrf_to_body, turned
from lithobrake.study.impact_sections import SiteSection

from ..pipeline.journeys.bouncing_lander import journey_tables

EPOCH = "2027-04-20T12:00:00"
POLE = {"pole_right_ascension_deg": 60.0, "pole_declination_deg": -71.0, "meridian_deg": 25.0}
SPIN_PERIOD, COUNT = 40922.64, 8
TITLES = "time_s,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,q_w,q_x,q_y,q_z,rate_x_rad_s,rate_y_rad_s,rate_z_rad_s"
# Of the lander that is delivered: turned by 40 degrees about an axis that is none of its own, and tumbling.
ATTITUDE, RATES = Rotation.from_rotvec(np.radians(40.0) * np.array([0.6, 0.0, 0.8])), [0.002, -0.003, 0.004]


def delivered_states() -> np.ndarray:
    """Times, states along ICRF, attitudes and rates, [count, 14]; every lander at another time."""
    off = np.random.default_rng(1).standard_normal((COUNT, 6)) * [5.0, 5.0, 5.0, 1e-3, 1e-3, 1e-3]
    place, velocity = np.split(np.array([5.0, 140.0, 10.0, 0.002, -0.03, 0.001]) + off, 2, axis=1)
    time, period = 100.0 * np.arange(COUNT), np.full(COUNT, SPIN_PERIOD)
    back = np.transpose(icrf_to_body(SiteSection(**POLE), time, period), (0, 2, 1))
    inertial = 2.0 * velocity - against_ground(place, velocity, period)
    own = np.tile([*ATTITUDE.as_quat(scalar_first=True), *RATES], (COUNT, 1))
    return np.column_stack([time, turned(back, place), turned(back, inertial), own])


def delivered_tables(folder: Path) -> dict[str, Any]:
    """The tables of the study; writes the states beside it."""
    path = folder / "states.csv"
    np.savetxt(path, delivered_states(), fmt="%.17g", delimiter=",", header=TITLES, comments="")
    tables = journey_tables(site=POLE, journey={"count": COUNT, "emulated_count": 0})
    tables["delivery"] = {"latitude_deg": 0.0, "longitude_deg": 90.0, "frame": "icrf", "epoch": EPOCH,
        "states": str(path)}  # fmt: skip
    return tables
