"""How a body turns and where its partner stands, from kernels of SPICE: text constants (PCK) and ephemerides (SPK)."""

import os
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lithobrake.geometry import body_kernels
from lithobrake.geometry.kernel_process import Reply, read_apart


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
    return SpinState(*_numbers(body_kernels.spin, kernels, body))


def read_partner(
    kernels: Sequence[str | os.PathLike[str]], body: str | int, partner: str | int, epoch: str
) -> PartnerPlace:
    """Where the partner of a body stands at an epoch, a text that SPICE takes, as 2026-11-22T12:00:00 (UTC).

    kernels: an ephemeris (SPK) of both, constants (PCK) of the body, and leap seconds (LSK).
    Raises ValueError where these lack what is asked for.
    """
    return PartnerPlace(*_numbers(body_kernels.partner, kernels, body, partner, epoch))


def read_places(
    kernels: Sequence[str | os.PathLike[str]], body: str | int, target: str, times: Sequence[str]
) -> NDArray[np.float64]:
    """Places of a target, the Sun, Earth or a spacecraft, in the axes of a body [m], [time_count, 3], at UTC times.

    kernels: ephemerides (SPK) of both, constants (PCK) of the body, and leap seconds (LSK).
    Raises ValueError where these lack what is asked for.
    """
    paths = tuple(os.fspath(kernel) for kernel in kernels)
    reply = _reply(body_kernels.places, paths, tuple(_stamp(path) for path in paths), body, target, tuple(times))
    return np.array(reply.unpacked()[0])


def _numbers(
    function: Callable[..., Any], kernels: Sequence[str | os.PathLike[str]], *arguments: str | int
) -> list[float]:
    paths = tuple(os.fspath(kernel) for kernel in kernels)
    reply = _reply(function, paths, tuple(_stamp(path) for path in paths), *arguments)
    return [float(value) for value in reply.unpacked(stacklevel=3)]


# A study asks for the same numbers many times, and each time another process would start.
@lru_cache(maxsize=32)
def _reply(
    function: Callable[..., Any],
    paths: tuple[str, ...],
    _stamps: tuple[Any, ...],
    *arguments: str | int | tuple[str, ...],
) -> Reply:
    return read_apart(function, paths, *arguments, kernels=paths)


def _stamp(path: str) -> tuple[int, int, int] | None:
    """What of a file changes when its content does; None where there is none."""
    try:
        found = os.stat(path)
    except OSError:
        return None
    return found.st_ino, found.st_size, found.st_mtime_ns
