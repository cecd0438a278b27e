"""How a body turns and where its partner stands, from kernels of SPICE: text constants (PCK) and ephemerides (SPK)."""

import math
import os
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy as np

from lithobrake.shape_kernel import spice

# Bodies that SPICE's own table of names may lack.
NUMBERS = {"didymos": 920065803, "dimorphos": 120065803}
# What others, older kernels among them, call the same two bodies.
OLD_NUMBERS = {2065803: 920065803, 20065803: 920065803}
DAY = 86_400.0  # [s]


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
    with _loaded(kernels) as loaded:
        number = _number(loaded, body)
        right_ascension, declination, meridian = (
            _constants(loaded, number, name) for name in ("POLE_RA", "POLE_DEC", "PM")
        )
        moving = [*right_ascension[1:], *declination[1:], *meridian[2:]]
        if any(moving) or loaded.bodfnd(number, "NUT_PREC_PM"):
            warnings.warn(f"body {number}: precession, nutation and change of its spin are left out", stacklevel=2)
    rate = meridian[1] if len(meridian) > 1 else 0.0
    if rate <= 0.0:
        raise ValueError(
            f"body {number}: BODY{number}_PM turns by {rate} degrees a day; allowed: above 0, as the pole of a small "
            "body is the one about which it turns counter-clockwise"
        )
    return SpinState(360.0 / rate * DAY, float(right_ascension[0]), float(declination[0]), float(meridian[0]))


def read_partner(
    kernels: Sequence[str | os.PathLike[str]], body: str | int, partner: str | int, epoch: str
) -> PartnerPlace:
    """Where the partner of a body stands at an epoch, a text that SPICE takes, as 2026-11-22T12:00:00 (UTC).

    kernels: an ephemeris (SPK) of both, constants (PCK) of the body, and leap seconds (LSK).
    Raises ValueError where these lack what is asked for.
    """
    with _loaded(kernels) as loaded:
        number, other = _number(loaded, body), _number(loaded, partner)
        time = loaded.str2et(epoch)
        state = 1e3 * np.array(loaded.spkgeo(other, time, "J2000", number)[0])
        fixed = np.array(loaded.tipbod("J2000", number, time)) @ state[:3]
    distance = float(np.linalg.norm(state[:3]))
    rate = float(np.linalg.norm(np.cross(state[:3], state[3:]))) / distance**2
    latitude = math.degrees(math.asin(fixed[2] / distance))
    return PartnerPlace(distance, latitude, math.degrees(math.atan2(fixed[1], fixed[0])), 2.0 * math.pi / rate)


@contextmanager
def _loaded(kernels: Sequence[str | os.PathLike[str]]) -> Iterator[Any]:
    """SPICE with these kernels, as long as this lasts; what it refuses becomes a ValueError."""
    loaded = spice()
    done: list[str] = []
    try:
        for kernel in kernels:
            loaded.furnsh(os.fspath(kernel))
            done.append(os.fspath(kernel))
        yield loaded
    except (loaded.exceptions.SpiceyError, loaded.exceptions.NotFoundError) as error:
        names = ", ".join(os.fspath(kernel) for kernel in kernels)
        words = " ".join(str(getattr(error, "long", "") or error).split())
        raise ValueError(f"kernels {names}: {words}; add the kernel that has it") from error
    finally:
        for kernel in done:
            loaded.unload(kernel)


def _number(loaded: Any, body: str | int) -> int:
    number = body if isinstance(body, int) else NUMBERS.get(body.lower()) or int(loaded.bods2c(body))
    if number in OLD_NUMBERS:
        warnings.warn(
            f"body {number} is not Didymos in the kernels of DART and Hera, but {OLD_NUMBERS[number]}", stacklevel=3
        )
    return number


def _constants(loaded: Any, number: int, name: str) -> list[float]:
    if not loaded.bodfnd(number, name):
        raise ValueError(f"the kernels have no BODY{number}_{name}; add the constants (PCK) of the body")
    return [float(value) for value in loaded.bodvcd(number, name, 10)[1]]
