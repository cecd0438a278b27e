"""How a body turns under the torque of its partner, or as kernels of SPICE say."""

import math
import os
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lithobrake.files.reading import file_stamp
from lithobrake.geometry import naif_kernels
from lithobrake.geometry.attitude import quaternion_products, rotation_matrices
from lithobrake.geometry.naif_kernels import Reply, read_apart
from lithobrake.smallbody.body import Body
from lithobrake.smallbody.rotation import AttitudeHistory
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.clock import Epoch
from lithobrake.vocabulary.given_numbers import finite_number, numbers

Rates = tuple[float, ...]
# Between two attitudes the body turns, and its torque swings, by at most this angle [rad]: cubics are then good to
# some 1e-9 rad.
STEP_ANGLE = 0.02
# Of the integration, relative; its own error stays below that of the cubics over years.
TOLERANCE = 1e-10
# Of a step of the integration [rad]; longer ones would make rounding grow where the body hardly moves.
LONGEST_ANGLE = 0.5
# Of a history [s], thirty years: of a body that turns in two hours it has a million and a half attitudes a year.
LONGEST = 1e9


def rotation_history(
    body: Body,
    duration: float,
    *,
    yaw_deg: float = 0.0,
    pitch_deg: float = 0.0,
    roll_deg: float = 0.0,
    spin: Sequence[float] = (0.0, 0.0, 0.0),
) -> AttitudeHistory:
    """Attitudes of a body over a duration [s] from time 0, for Body.rotation.

    yaw_deg, pitch_deg, roll_deg   at the start against the frame, which turns about z at the body's spin period: turns
                                   about z, then about the new y, then about the newest x
    spin                           angular velocity at the start against the frame, along body-fixed axes [rad/s], [3]

    The body is rigid and of uniform density, its partner a point on its circle, whose pull twists it. It does not act
    back on the orbit, which stays as it is. Without a partner the body turns freely.
    Raises ValueError for numbers out of range.
    Source: [Murray-1999], chapter 5 (Euler's equations and the torque of a point).
    """
    from scipy.integrate import solve_ivp

    duration = finite_number("duration", duration, above=0.0, at_most=LONGEST)
    angles = [
        math.radians(finite_number(name, angle, at_least=-360.0, at_most=360.0))
        for name, angle in (("yaw_deg", yaw_deg), ("pitch_deg", pitch_deg), ("roll_deg", roll_deg))
    ]
    rates = numbers("spin", spin)
    if rates.shape != (3,) or not np.isfinite(rates).all():
        raise ValueError(f"spin is {spin!r} rad/s; it must be three finite numbers.")
    moments, principal = np.linalg.eigh(body.shape.inertia_per_density)
    principal[:, 2] *= np.sign(np.linalg.det(principal))
    start = _turns(*angles) @ principal
    whole = principal.T @ rates + body.spin_rate * start[2]
    # The unit of all rates, so that one tolerance holds for the quaternion and for them.
    pace = max(body.spin_rate, math.sqrt(_twist(body)), float(np.linalg.norm(whole)))
    found = solve_ivp(
        _derivative(body, moments, pace),
        (0.0, duration * pace),
        np.concatenate([_quaternion(start), whole / pace]),
        method="DOP853",
        rtol=TOLERANCE,
        atol=TOLERANCE,
        max_step=LONGEST_ANGLE,
        dense_output=True,
    )
    fastest = max(pace, float(np.linalg.norm(found.y[4:], axis=0).max()) * pace + body.spin_rate)
    count = math.ceil(duration * fastest / STEP_ANGLE) + 1
    step = duration / (count - 1)
    state = found.sol(np.arange(count) * step * pace).T
    return _history(body, step, principal, state[:, :4], state[:, 4:] * pace)


def _twist(body: Body) -> float:
    """Three G masses of the partner over the cube of its distance [1/s2]; 0 without one."""
    if body.partner is None:
        return 0.0
    return 3.0 * body.partner.body.gravitational_parameter / body.orbit.distance**3


def _derivative(body: Body, moments: Array, pace: float) -> Callable[[float, Sequence[float]], list[float]]:
    """Rates of the quaternion of the principal axes and of the angular velocity along them, in units of pace [rad/s].

    Plain numbers: arrays of three take longer.
    """
    (a, b, c), orbit = moments.tolist(), body.orbit
    twist, spin = _twist(body) / pace**2, body.spin_rate / pace
    angle, rate = float(orbit.angle), float(orbit.rate) / pace

    def derivative(time: float, state: Sequence[float]) -> list[float]:
        w, x, y, z, p, q, r = state
        size = w * w + x * x + y * y + z * z
        cosine, sine = math.cos(angle + rate * time) / size, math.sin(angle + rate * time) / size
        # The partner's direction, and the spin of the frame, along the principal axes.
        u = cosine * (w * w + x * x - y * y - z * z) + sine * 2.0 * (x * y + w * z)
        v = cosine * 2.0 * (x * y - w * z) + sine * (w * w - x * x + y * y - z * z)
        s = cosine * 2.0 * (x * z + w * y) + sine * 2.0 * (y * z - w * x)
        of_frame = spin / size
        i = p - of_frame * 2.0 * (x * z - w * y)
        j = q - of_frame * 2.0 * (y * z + w * x)
        k = r - of_frame * (w * w - x * x - y * y + z * z)
        return [
            0.5 * (-x * i - y * j - z * k),
            0.5 * (w * i + y * k - z * j),
            0.5 * (w * j + z * i - x * k),
            0.5 * (w * k + x * j - y * i),
            (b - c) / a * (q * r - twist * v * s),
            (c - a) / b * (r * p - twist * s * u),
            (a - b) / c * (p * q - twist * u * v),
        ]

    return derivative


def _history(body: Body, step: float, principal: Array, quaternion: Array, whole: Array) -> AttitudeHistory:
    """Of the body-fixed axes, from quaternions of the principal ones and spins against the stars along these."""
    against_frame = whole - body.spin_rate * rotation_matrices(quaternion)[:, 2]
    # Not by a matrix product, whose rounding depends on how many rows there are.
    spin = np.stack([(against_frame * row).sum(axis=1) for row in principal], axis=1)
    return AttitudeHistory(step, _after(quaternion, _quaternion(principal.T)), spin)


def _after(first: Array, second: Array) -> Array:
    """Unit quaternions [count, 4] of the second turn, [4], then the first."""
    whole = quaternion_products(first, np.broadcast_to(second, first.shape))
    unit: Array = whole / np.linalg.norm(whole, axis=1, keepdims=True)
    return unit


def _turns(yaw: float, pitch: float, roll: float) -> Array:
    """Rotation matrix [3, 3] of turns about z, the new y and the newest x [rad]."""
    (a, b), (c, d), (e, f) = ((math.cos(one), math.sin(one)) for one in (yaw, pitch, roll))
    about_z = np.array([[a, -b, 0.0], [b, a, 0.0], [0.0, 0.0, 1.0]])
    about_y = np.array([[c, 0.0, d], [0.0, 1.0, 0.0], [-d, 0.0, c]])
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, e, -f], [0.0, f, e]])
    turn: Array = about_z @ about_y @ about_x
    return turn


def _quaternion(matrix: Array) -> Array:
    """Quaternion w, x, y, z of a rotation matrix [3, 3]."""
    from scipy.spatial.transform import Rotation

    found: Array = np.roll(Rotation.from_matrix(matrix).as_quat(), 1)
    return found


class SpinState(NamedTuple):
    """How a body turns: sidereal period [s], its pole (J2000), and longitude 0 at the epoch of J2000 [deg]."""

    period: float
    pole_right_ascension_deg: float
    pole_declination_deg: float
    prime_meridian_deg: float


class PartnerPlace(NamedTuple):
    """Where a partner stands: distance of the centres [m], planetocentric latitude and east longitude [deg] over which
    it stands, and the period of a circle at its angular speed [s]."""

    distance: float
    latitude_deg: float
    longitude_deg: float
    period: float


def read_spin(kernels: Sequence[str | os.PathLike[str]], body: str | int) -> SpinState:
    """The spin of a body from text constants (PCK); terms that are not constant are left out, and that is warned of.

    body: a name that the kernels or SPICE know, or its number.
    Raises ValueError where the kernels say nothing of it, or that it turns clockwise or not at all.
    """
    return SpinState(*_numbers(naif_kernels.spin, kernels, body))


def read_partner(
    kernels: Sequence[str | os.PathLike[str]], body: str | int, partner: str | int, epoch: str
) -> PartnerPlace:
    """Where the partner of a body stands at an epoch (UTC), as 2026-11-22T12:00:00.

    kernels: an ephemeris (SPK) of both, and constants (PCK) of the body.
    Raises ValueError where these lack what is asked for, and for an epoch that is none.
    """
    return PartnerPlace(*_numbers(naif_kernels.partner, kernels, body, partner, _time_of_spice(epoch)))


def read_places(
    kernels: Sequence[str | os.PathLike[str]], body: str | int, target: str, times: Sequence[str]
) -> NDArray[np.float64]:
    """Places of a target, the Sun, Earth or a spacecraft, in the axes of a body [m], [time_count, 3], at UTC times.

    kernels: ephemerides (SPK) of both, and constants (PCK) of the body.
    Raises ValueError where these lack what is asked for, and for a time that is none.
    """
    paths = tuple(os.fspath(kernel) for kernel in kernels)
    reply = _reply(naif_kernels.places, paths, _stamps(paths), body, target, tuple(map(_time_of_spice, times)))
    return np.array(reply.unpacked()[0])


def _time_of_spice(epoch: str) -> float:
    try:
        return Epoch.of(epoch).ephemeris_time
    except ValueError as error:
        raise ValueError(f"epoch {error}") from error


def _numbers(
    function: Callable[..., Any], kernels: Sequence[str | os.PathLike[str]], *arguments: str | float
) -> list[float]:
    paths = tuple(os.fspath(kernel) for kernel in kernels)
    reply = _reply(function, paths, _stamps(paths), *arguments)
    return [float(value) for value in reply.unpacked(stacklevel=3)]


# A study asks for the same numbers many times, and each time another process would start.
@lru_cache(maxsize=32)
def _reply(
    function: Callable[..., Any],
    paths: tuple[str, ...],
    _stamps: tuple[Any, ...],
    *arguments: str | float | tuple[float, ...],
) -> Reply:
    # The stamps are only part of the key: files that have changed are read again.
    return read_apart(function, paths, *arguments, kernels=paths)


def _stamps(kernels: tuple[str, ...]) -> tuple[Any, ...]:
    return tuple(map(file_stamp, naif_kernels.kernel_files(kernels)))
