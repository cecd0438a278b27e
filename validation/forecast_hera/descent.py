"""Ballistic descents that meet an end of Dimorphos along the vertical: where and how the lander is released.

The descent of [Celik-2019]: unpowered, vertical at the touchdown, nearly as slow as one from that distance can be, with
release errors of 90 m and 2 cm/s (3 sigma) in each direction. Dimorphos turns with its orbit here, is symmetric about
the plane through both centres and the pole, and Didymos' orbit is a circle: a flight upwards, seen in that mirror and
backwards in time, is a descent.
"""

from typing import Any

import numpy as np

from lithobrake.smallbody import Body, fly

DISTANCE = 200.0  # m from the centre, beyond the Lagrange points of all densities
FASTER = 1.25  # times the least speed: the least itself lingers at the Lagrange point
POSITION_STD, VELOCITY_STD = 30.0, 0.02 / 3.0  # m and m/s
LONGEST = 6.0 * 3600.0  # s


def release(body: Body, longitude_deg: float) -> dict[str, Any]:
    """The table [delivery.release] of the descent to the end of the long axis at a longitude, 0 or 180."""
    tip = body.shape.surface_point(0.0, longitude_deg)
    up = np.array([np.cos(np.radians(longitude_deg)), 0.0, 0.0])
    speed = FASTER * least_speed(body, tip, up)
    duration = time_to(body, tip, speed * up)
    end = fly(body, tip, speed * up, duration)
    x, y, z = end.position[0]
    u, v, w = end.velocity[0]
    return {
        "position": [float(x), float(-y), float(z)], "velocity": [float(-u), float(v), float(-w)],
        "position_std": POSITION_STD, "velocity_std": VELOCITY_STD,
    }  # fmt: skip


def least_speed(body: Body, tip: np.ndarray, up: np.ndarray) -> float:
    """Least speed [m/s], to 0.01 cm/s, with which a flight straight up reaches DISTANCE."""
    low, high = 0.01, 0.2
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if np.isinf(time_to(body, tip, middle * up)) else (low, middle)
    return high


def time_to(body: Body, tip: np.ndarray, velocity: np.ndarray) -> float:
    """Time [s] at which a flight is DISTANCE from the centre; infinite where it comes down before."""
    low, high = 0.0, LONGEST
    while high - low > 1.0:
        times = np.linspace(low, high, 41)[1:]
        starts = np.broadcast_to(tip, (len(times), 3)), np.broadcast_to(velocity, (len(times), 3))
        ends = fly(body, *starts, times, gravity="table", threads=1)
        beyond = (ends.status == "flying") & (np.linalg.norm(ends.position, axis=1) >= DISTANCE)
        if not beyond.any():
            return np.inf
        first = int(np.flatnonzero(beyond)[0])
        low, high = (float(times[first - 1]) if first else low), float(times[first])
    return high
