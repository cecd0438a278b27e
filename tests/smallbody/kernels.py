"""Kernels of SPICE for the system of Didymos, written with NAIF's own routines."""

import importlib
import math
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

PCK = r"""KPL/PCK
\begindata
BODY920065803_POLE_RA = ( 69.327 0. 0. )
BODY920065803_POLE_DEC = ( -72.725 0. 0. )
BODY920065803_PM = ( 120.0 3823.0 0. )
BODY120065803_POLE_RA = ( 69.327 )
BODY120065803_POLE_DEC = ( -72.725 )
BODY120065803_PM = ( 0.0 -760. )
\begintext
"""
LSK = r"""KPL/LSK
\begindata
DELTET/DELTA_T_A = 32.184
DELTET/K = 1.657D-3
DELTET/EB = 1.671D-2
DELTET/M = ( 6.239996D0 1.99096871D-7 )
DELTET/DELTA_AT = ( 10, @1972-JAN-1 37, @2017-JAN-1 )
\begintext
"""
DISTANCE, PERIOD = 1.15, 40_920.0  # km, s


def write_kernels(folder: Path) -> list[Path]:
    """Constants, leap seconds, and an ephemeris of Dimorphos on a circle about Didymos in its equator."""
    paths = [folder / name for name in ("didymos.tpc", "leap.tls", "didymos.bsp")]
    for path, content in zip(paths, (PCK.encode(), LSK.encode(), _ephemeris()), strict=True):
        path.write_bytes(content)
    return paths


@cache
def _ephemeris() -> bytes:
    """What the file of the ephemeris holds, which takes long to write."""
    spice = importlib.import_module("spiceypy")
    times = np.linspace(8.4e8, 8.5e8, 20001)
    angle = 2.0 * np.pi * times / PERIOD
    pole_ra, pole_dec = math.radians(69.327), math.radians(-72.725)
    node = np.array([-math.sin(pole_ra), math.cos(pole_ra), 0.0])
    pole = np.array(
        [math.cos(pole_dec) * math.cos(pole_ra), math.cos(pole_dec) * math.sin(pole_ra), math.sin(pole_dec)]
    )
    across = np.cross(pole, node)
    along = np.cos(angle)[:, None] * node + np.sin(angle)[:, None] * across
    speed = DISTANCE * 2.0 * np.pi / PERIOD * (-np.sin(angle)[:, None] * node + np.cos(angle)[:, None] * across)
    states = np.ascontiguousarray(np.concatenate([DISTANCE * along, speed], axis=1))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "didymos.bsp"
        handle = spice.spkopn(str(path), "test", 0)
        spice.spkw09(handle, 120065803, 920065803, "J2000", times[0], times[-1], "orbit", 7, len(times), states, times)
        spice.spkcls(handle)
        return path.read_bytes()
