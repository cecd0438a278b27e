"""How a body turns and where its partner stands, from kernels of SPICE, by NAIF's own routines.

In the process of the caller, which SPICE may end where a kernel is damaged: `read_apart` calls these in another one.
"""

import math
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np

from lithobrake.geometry.kernel_process import spice

# Bodies that SPICE's own table of names may lack.
NUMBERS = {"didymos": 920065803, "dimorphos": 120065803}
# What others, older kernels among them, call the same two bodies.
OLD_NUMBERS = {2065803: 920065803, 20065803: 920065803}
DAY = 86_400.0  # [s]


def spin(kernels: Sequence[str], body: str | int) -> tuple[float, float, float, float]:
    """The numbers of `SpinState` in its order; raises ValueError as `read_spin` does."""
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
    return 360.0 / rate * DAY, float(right_ascension[0]), float(declination[0]), float(meridian[0])


def partner(
    kernels: Sequence[str], body: str | int, partner: str | int, epoch: str
) -> tuple[float, float, float, float]:
    """The numbers of `PartnerPlace` in its order; raises ValueError as `read_partner` does."""
    with _loaded(kernels) as loaded:
        number, other = _number(loaded, body), _number(loaded, partner)
        time = loaded.str2et(epoch)
        state = 1e3 * np.array(loaded.spkgeo(other, time, "J2000", number)[0])
        fixed = np.array(loaded.tipbod("J2000", number, time)) @ state[:3]
    distance = float(np.linalg.norm(state[:3]))
    rate = float(np.linalg.norm(np.cross(state[:3], state[3:]))) / distance**2
    latitude = math.degrees(math.asin(fixed[2] / distance))
    return distance, latitude, math.degrees(math.atan2(fixed[1], fixed[0])), 2.0 * math.pi / rate


def places(kernels: Sequence[str], body: str | int, target: str, times: Sequence[str]) -> list[np.ndarray]:
    """Body-fixed places of a target [m], [time_count, 3], at UTC times; raises ValueError as `read_places` does."""
    with _loaded(kernels) as loaded:
        number = _number(loaded, body)
        found = []
        for text in times:
            time = loaded.str2et(text)
            place = np.array(loaded.spkezp(_number(loaded, target), time, "J2000", "NONE", number)[0])
            found.append(1e3 * (np.array(loaded.tipbod("J2000", number, time)) @ place))
    return [np.array(found)]


@contextmanager
def _loaded(kernels: Sequence[str]) -> Iterator[Any]:
    """SPICE with these kernels, as long as this lasts; what it refuses becomes a ValueError."""
    loaded = spice()
    done: list[str] = []
    try:
        for kernel in kernels:
            loaded.furnsh(kernel)
            done.append(kernel)
        yield loaded
    except (loaded.exceptions.SpiceyError, loaded.exceptions.NotFoundError) as error:
        names = ", ".join(kernels)
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
