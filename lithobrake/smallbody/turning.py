"""How the axes of a body stand against axes that turn uniformly, in kernels: a curve through evenly spaced attitudes.

The frame turns about z at the spin period of the body; a body without a history of its own stands still in it.
"""

from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import kernel
from lithobrake.smallbody.arrays import Floats
from lithobrake.smallbody.polyhedron_gravity import PULL_X
from lithobrake.smallbody.simd import LANES

Vector = tuple[float, float, float]


class Turning(NamedTuple):
    """The history of an attitude; one without states stands for a body that stands still.

    step     between the states [s], the first at time 0
    states   quaternion w, x, y, z that turns body-fixed axes into those of the frame, and its rate [1/s], [count, 8]
    rate     largest angular velocity against the frame [rad/s], and change of it [rad/s2]
    """

    step: float
    states: Floats
    rate: float
    change: float

    @classmethod
    def none(cls) -> "Turning":
        """That of a body that stands still in the frame."""
        return cls(1.0, np.zeros((0, 8)), 0.0, 0.0)


@kernel
def axes_at(turning: Turning, time: float) -> tuple[Vector, Vector, Vector]:
    """The body's axes x, y and z at a time [s], each in components of the frame.

    Between states the quaternion is Hermite's cubic; beyond the ends it goes on as that of the last interval.
    """
    states, step = turning.states, turning.step
    k = min(max(int(time / step), 0), len(states) - 2)
    u = time / step - k
    s = 1.0 - u
    # Weights of the quaternion and of its rate at either end.
    here, there = s * s * (1.0 + 2.0 * u), u * u * (1.0 + 2.0 * s)
    leaving, coming = step * u * s * s, -step * u * u * s
    first, second = states[k], states[k + 1]
    w = here * first[0] + leaving * first[4] + there * second[0] + coming * second[4]
    x = here * first[1] + leaving * first[5] + there * second[1] + coming * second[5]
    y = here * first[2] + leaving * first[6] + there * second[2] + coming * second[6]
    z = here * first[3] + leaving * first[7] + there * second[3] + coming * second[7]
    twice = 2.0 / (w * w + x * x + y * y + z * z)
    return (
        (1.0 - twice * (y * y + z * z), twice * (x * y + w * z), twice * (x * z - w * y)),
        (twice * (x * y - w * z), 1.0 - twice * (x * x + z * z), twice * (y * z + w * x)),
        (twice * (x * z + w * y), twice * (y * z - w * x), 1.0 - twice * (x * x + y * y)),
    )


@kernel
def into_body(point: Floats, turning: Turning, time: float) -> None:
    """Turn a point [3] of the frame, at a time [s], into the axes of the body."""
    if len(turning.states) == 0:
        return
    x, y, z = point[0], point[1], point[2]
    axes = axes_at(turning, time)
    for i in range(3):
        axis = axes[i]
        point[i] = axis[0] * x + axis[1] * y + axis[2] * z


@kernel
def block_into_body(lane: Floats, count: int, turning: Turning, when: Floats, turn: Floats) -> None:
    """Turn the points of a block, rows X, Y, Z of lane [ROWS * LANES], at times when [count] [s], into the body's axes.

    Writes these axes to turn [9, LANES].
    """
    for j in range(count):
        axes = axes_at(turning, when[j])
        x, y, z = lane[j], lane[LANES + j], lane[2 * LANES + j]
        for i in range(3):
            axis = axes[i]
            for k in range(3):
                turn[3 * i + k, j] = axis[k]
            lane[i * LANES + j] = axis[0] * x + axis[1] * y + axis[2] * z


@kernel
def pull_out_of_body(lane: Floats, count: int, turn: Floats) -> None:
    """Turn the pulls of a block from the body's axes, turn [9, LANES], into those of the frame."""
    for j in range(count):
        x, y, z = lane[PULL_X * LANES + j], lane[(PULL_X + 1) * LANES + j], lane[(PULL_X + 2) * LANES + j]
        for k in range(3):
            lane[(PULL_X + k) * LANES + j] = turn[k, j] * x + turn[3 + k, j] * y + turn[6 + k, j] * z
