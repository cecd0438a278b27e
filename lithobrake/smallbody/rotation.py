"""How the axes of a body stand over time, in kernels and against the stars."""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.compilation.compiled import kernel
from lithobrake.geometry.attitude import quaternion_products, rotation_matrices
from lithobrake.smallbody.polyhedron_gravity import PULL_X
from lithobrake.smallbody.simd import LANES
from lithobrake.vocabulary.array_types import Array, Floats, Vector
from lithobrake.vocabulary.given_numbers import finite_number, numbers

# Between two states a quaternion is a cubic; the bounds of its rates are those at so many places, and a little more.
PLACES, SAFETY = 4, 1.1
# The angle [rad] between two states, above which a cubic is no good curve between them.
WIDEST = 0.5


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
    # Over the square of its length, which a cubic does not keep at 1.
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
        # Between the places where they are taken, the cubic's rates may be a little larger.
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
        """Attitudes at times [s], [count]. Raises ValueError for times out of the history by more than a step."""
        part = np.atleast_1d(numbers("time", time)) / self.step
        if not ((part >= -1.0) & (part <= len(self.attitude))).all():
            raise ValueError(f"time is {time!r} s; allowed: 0 to {self.duration:.9g} s, for which attitudes are known.")
        states = self.turning.states
        interval = np.clip(part.astype(np.int64), 0, len(states) - 2)
        quaternion, spin, change = _curve(states, self.step, interval, part - interval)
        return Attitudes(rotation_matrices(quaternion), spin, change)


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
    # A cubic does not keep the length of a quaternion; what changes that length turns nothing.
    lengthening = 2.0 * np.sum(quaternion * rate, axis=1, keepdims=True) / square
    change = 2.0 * quaternion_products(back, bend)[:, 1:] - lengthening * spin
    return quaternion, spin, change


Rotation = AttitudeHistory | None


def turning_of(rotation: Rotation) -> Turning:
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
    # The frame turns on by this angle, so what stays among the stars turns back in it.
    angle = 2.0 * np.pi / spin_period * time
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = (vectors if rotation is None else rotation.at(start).into_frame(vectors)).T
    turned = np.column_stack([c * x + s * y, c * y - s * x, z])
    return turned if rotation is None else rotation.at(start + time).out_of_frame(turned)


def refuse_beyond(rotation: Rotation, own_period: float, spin_period: Array, begin: Array, end: Array) -> None:
    """Raise ValueError for flights from begin to end [s], [count], that are not all in the history, or have another
    spin period than the body's."""
    if rotation is None:
        return
    if (spin_period != own_period).any():
        raise ValueError(
            f"spin_period is not {own_period:g} s in every flight, with which the axes turn that the attitudes of the "
            "body are against; leave it out."
        )
    first, last = float(begin.min(initial=0.0)), float(end.max(initial=0.0))
    # An end that is the sum of two numbers may be off by their rounding.
    if first < 0.0 or last > rotation.duration * (1.0 + 1e-12):
        raise ValueError(
            f"the attitude of the body is known from 0 to {rotation.duration:.9g} s, and flights or slides may last "
            f"from {first:.9g} to {last:.9g} s; give a longer history, or shorter durations."
        )
