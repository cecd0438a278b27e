"""How a body turns that does not turn uniformly: its attitude over time against axes that do."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.geometry.attitude import quaternion_products, rotation_matrices
from lithobrake.smallbody.turning import Turning
from lithobrake.vocabulary.given_numbers import finite_number, numbers

Array = NDArray[np.float64]
# Between two states a quaternion is a cubic; the bounds of its rates are those at so many places, and a little more.
PLACES, SAFETY = 4, 1.1
# The angle [rad] between two states, above which a cubic is no good curve between them.
WIDEST = 0.5


class Attitudes(NamedTuple):
    """Attitudes at some times, [count, ...].

    axes      of the body in columns, in components of the frame, [count, 3, 3]: they turn body-fixed vectors into it
    spin      angular velocity against the frame along body-fixed axes [rad/s], [count, 3], and change of it [rad/s2]
    """

    axes: Array
    spin: Array
    change: Array

    def into_frame(self, vectors: Array) -> Array:
        """Body-fixed vectors [count, 3] along the axes of the frame."""
        found: Array = np.einsum("nij,nj->ni", self.axes, vectors)
        return found

    def out_of_frame(self, vectors: Array) -> Array:
        """Vectors along the axes of the frame [count, 3], body-fixed."""
        found: Array = np.einsum("nji,nj->ni", self.axes, vectors)
        return found

    def states_into_frame(self, position: Array, velocity: Array) -> tuple[Array, Array]:
        """Places [m] and velocities [m/s] against the ground, body-fixed, as those of the frame; all [count, 3]."""
        return self.into_frame(position), self.into_frame(velocity + np.cross(self.spin, position))

    def states_out_of_frame(self, position: Array, velocity: Array) -> tuple[Array, Array]:
        """The way back: places and velocities in the frame as body-fixed ones, against the ground."""
        place = self.out_of_frame(position)
        return place, self.out_of_frame(velocity) - np.cross(self.spin, place)

    def whole_spin(self, spin_rate: ArrayLike) -> tuple[Array, Array]:
        """Angular velocity against the stars [rad/s] and change of it [rad/s2], along body-fixed axes, [count, 3].

        spin_rate: of the frame about its z axis [rad/s].
        """
        of_frame = self.axes[:, 2] * np.reshape(spin_rate, (-1, 1))
        # The frame's own spin is constant, and turns back as the body turns on.
        return self.spin + of_frame, self.change - np.cross(self.spin, of_frame)


@dataclass(frozen=True, eq=False)
class AttitudeHistory:
    """Attitudes of a body at evenly spaced times from 0 on, against axes that turn about z at its spin period.

    step       between the times [s]
    attitude   unit quaternions w, x, y, z that turn body-fixed axes into those, [count, 4]
    spin       angular velocity against those axes, along body-fixed ones [rad/s], [count, 3]

    Between the times the quaternion is the cubic that has these values and rates at its ends. Raises ValueError for
    numbers that are not finite, other shapes, and steps over which the body turns by more than half a radian.
    """

    step: float
    attitude: Array
    spin: Array

    def __post_init__(self) -> None:
        finite_number("step of the attitudes", self.step, above=0.0)
        attitude, spin = numbers("attitude", self.attitude), numbers("spin", self.spin)
        count = len(attitude) if attitude.ndim else 0
        if count < 2 or attitude.shape != (count, 4) or spin.shape != (count, 3):
            raise ValueError(
                f"attitude has shape {attitude.shape} and spin {spin.shape}; they must be [count, 4] and [count, 3], "
                "of at least two times."
            )
        if not (np.isfinite(attitude).all() and np.isfinite(spin).all() and attitude.any(axis=1).all()):
            raise ValueError("attitude and spin must be finite, and no quaternion 0.")
        widest = float(np.linalg.norm(spin, axis=1).max()) * self.step
        if widest > WIDEST:
            raise ValueError(
                f"the body turns by {widest:.3g} rad in a step of {self.step:g} s; it must be at most {WIDEST} rad: "
                "give more attitudes."
            )

    @property
    def duration(self) -> float:
        """Time of the last attitude [s]."""
        return self.step * (len(self.attitude) - 1)

    @cached_property
    def turning(self) -> Turning:
        """What kernels read."""
        whole = np.asarray(self.attitude, dtype=np.float64)
        whole = whole / np.linalg.norm(whole, axis=1, keepdims=True)
        # A quaternion and its negative are one attitude; a curve goes from one to the next on the short way.
        turned = np.where(np.sum(whole[1:] * whole[:-1], axis=1) < 0.0, -1.0, 1.0)
        whole[1:] *= np.cumprod(turned)[:, None]
        rate = 0.5 * quaternion_products(whole, np.column_stack([np.zeros(len(whole)), self.spin]))
        states = np.ascontiguousarray(np.concatenate([whole, rate], axis=1))
        interval = np.repeat(np.arange(len(whole) - 1), PLACES + 1)
        share = np.tile(np.arange(PLACES + 1) / PLACES, len(whole) - 1)
        spin, change = _curve(states, self.step, interval, share)[1:]
        fastest, largest = (SAFETY * float(np.linalg.norm(one, axis=1).max()) for one in (spin, change))
        return Turning(float(self.step), states, fastest, largest)

    @cached_property
    def largest_angles(self) -> tuple[float, float, float]:
        """How far the body's x, y and z axes go from those of the frame [rad]."""
        whole = np.asarray(self.attitude, dtype=np.float64)
        cosines = np.einsum("nii->ni", rotation_matrices(whole)).min(axis=0)
        x, y, z = np.arccos(np.clip(cosines, -1.0, 1.0)).tolist()
        return x, y, z

    def at(self, time: ArrayLike) -> Attitudes:
        """Attitudes at times [s], [count]."""
        part = np.atleast_1d(np.asarray(time, dtype=np.float64)) / self.step
        states = self.turning.states
        interval = np.clip(part.astype(np.int64), 0, len(states) - 2)
        quaternion, spin, change = _curve(states, self.step, interval, part - interval)
        return Attitudes(rotation_matrices(quaternion), spin, change)

    def refuse_beyond(self, begin: Array, end: Array) -> None:
        """Raise ValueError where times [s] from begin to end, [count], are not all in the history."""
        first, last = float(begin.min(initial=0.0)), float(end.max(initial=0.0))
        # An end that is the sum of two numbers may be off by their rounding.
        if first < 0.0 or last > self.duration * (1.0 + 1e-12):
            raise ValueError(
                f"the attitude of the body is known from 0 to {self.duration:.9g} s, and flights or slides may last "
                f"from {first:.9g} to {last:.9g} s; give a longer history, or shorter durations."
            )


def _curve(states: Array, step: float, interval: NDArray[np.int64], u: Array) -> tuple[Array, Array, Array]:
    """Quaternions [count, 4], not of length 1, spins and their changes [count, 3] at parts u of intervals, [count]."""
    u = u[:, None]
    s = 1.0 - u
    first, first_rate, second, second_rate = (
        states[interval + after, 4 * part : 4 * part + 4] for after in (0, 1) for part in (0, 1)
    )
    quaternion = s * s * (1.0 + 2.0 * u) * first + u * u * (1.0 + 2.0 * s) * second
    quaternion += step * u * s * (s * first_rate - u * second_rate)
    slope = (second - first) / step
    rate = 6.0 * u * s * slope + s * (1.0 - 3.0 * u) * first_rate + u * (1.0 - 3.0 * s) * second_rate
    bend = (6.0 * (s - u) * slope + (6.0 * u - 4.0) * first_rate + (6.0 * u - 2.0) * second_rate) / step
    square = np.sum(quaternion**2, axis=1, keepdims=True)
    back = quaternion * np.array([1.0, -1.0, -1.0, -1.0]) / square
    spin = 2.0 * quaternion_products(back, rate)[:, 1:]
    lengthening = 2.0 * np.sum(quaternion * rate, axis=1, keepdims=True) / square
    change = 2.0 * quaternion_products(back, bend)[:, 1:] - lengthening * spin
    return quaternion, spin, change
