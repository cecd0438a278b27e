"""The ground of a body against the frame of flights, which turns uniformly, and against the stars.

rotation: the body's history of attitudes against that frame, or None for a body that stands still in it. Vectors and
states are [count, 3], times [s] and spin periods [s], of the frame about its z axis, [count].
"""

import numpy as np
from numpy.typing import NDArray

from lithobrake.smallbody.attitude_history import AttitudeHistory
from lithobrake.smallbody.turning import Turning

Array = NDArray[np.float64]
Rotation = AttitudeHistory | None


def turning_of(rotation: Rotation) -> Turning:
    """What kernels read."""
    return Turning.none() if rotation is None else rotation.turning


def into_frame(rotation: Rotation, position: Array, velocity: Array, time: Array) -> tuple[Array, Array]:
    """Body-fixed places [m] and velocities against the ground [m/s] as those of the frame."""
    return (position, velocity) if rotation is None else rotation.at(time).states_into_frame(position, velocity)


def out_of_frame(rotation: Rotation, position: Array, velocity: Array, time: Array) -> tuple[Array, Array]:
    """Places [m] and velocities [m/s] of the frame as body-fixed ones, against the ground."""
    return (position, velocity) if rotation is None else rotation.at(time).states_out_of_frame(position, velocity)


def ground_spin(rotation: Rotation, time: Array, spin_period: Array) -> Array:
    """Angular velocity of the ground against the stars [rad/s], along body-fixed axes."""
    spin_rate = 2.0 * np.pi / spin_period
    if rotation is None:
        return np.outer(spin_rate, [0.0, 0.0, 1.0])
    return rotation.at(time).whole_spin(spin_rate)[0]


def kept_among_stars(rotation: Rotation, vectors: Array, start: Array, time: Array, spin_period: Array) -> Array:
    """Body-fixed vectors at a start, which then stay among the stars, as body-fixed ones a time later."""
    angle = 2.0 * np.pi / spin_period * time
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = (vectors if rotation is None else rotation.at(start).into_frame(vectors)).T
    turned = np.column_stack([c * x + s * y, c * y - s * x, z])
    return turned if rotation is None else rotation.at(start + time).out_of_frame(turned)


def refuse_beyond(rotation: Rotation, own_period: float, spin_period: Array, begin: Array, end: Array) -> None:
    """Raise ValueError for flights that last longer than the history, or with another spin period than the body's."""
    if rotation is None:
        return
    if (spin_period != own_period).any():
        raise ValueError(
            f"spin_period is not {own_period:g} s in every flight, with which the axes turn that the attitudes of the "
            "body are against; leave it out."
        )
    rotation.refuse_beyond(begin, end)
