"""Spin and partner from kernels that these tests write with NAIF's own routines."""

import math
from pathlib import Path

import numpy as np
import pytest

from lithobrake.smallbody import read_partner, read_spin

spice = pytest.importorskip("spiceypy")

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


@pytest.fixture
def kernels(tmp_path: Path) -> list[Path]:
    """Constants, leap seconds, and an ephemeris of Dimorphos on a circle about Didymos in its equator."""
    paths = [tmp_path / name for name in ("didymos.tpc", "leap.tls", "didymos.bsp")]
    paths[0].write_text(PCK)
    paths[1].write_text(LSK)
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
    handle = spice.spkopn(str(paths[2]), "test", 0)
    states = np.ascontiguousarray(np.concatenate([DISTANCE * along, speed], axis=1))
    spice.spkw09(handle, 120065803, 920065803, "J2000", times[0], times[-1], "orbit", 7, len(times), states, times)
    spice.spkcls(handle)
    return paths


def test_spin_is_that_of_the_constants(kernels: list[Path]) -> None:
    for body in ("Didymos", 920065803):
        spin = read_spin(kernels[:1], body)
        assert spin.period == pytest.approx(360.0 / 3823.0 * 86_400.0, rel=1e-15)
        assert spin[1:] == (69.327, -72.725, 120.0)


def test_the_partner_stands_where_its_orbit_has_it(kernels: list[Path]) -> None:
    """In its own equator: longitude of the node, less how far the prime meridian is from it."""
    epoch = "2026-11-22T12:00:00"
    place = read_partner(kernels, "didymos", "dimorphos", epoch)
    spice.furnsh(str(kernels[1]))
    time = spice.str2et(epoch)
    spice.unload(str(kernels[1]))
    longitude = math.degrees(2.0 * math.pi * time / PERIOD) - (120.0 + 3823.0 * time / 86_400.0)
    assert place.distance == pytest.approx(1150.0, rel=1e-9)
    assert place.period == pytest.approx(PERIOD, rel=1e-9)
    assert place.latitude_deg == pytest.approx(0.0, abs=1e-9)
    # An angle of 4e7 degrees keeps eight digits of its fraction.
    assert math.remainder(place.longitude_deg - longitude, 360.0) == pytest.approx(0.0, abs=1e-5)


def test_what_the_kernels_do_not_say_is_refused(kernels: list[Path]) -> None:
    with pytest.raises(ValueError, match="no BODY2101955_POLE_RA"):
        read_spin(kernels[:1], 2101955)
    with pytest.raises(ValueError, match="counter-clockwise"):
        read_spin(kernels[:1], "dimorphos")
    with pytest.raises(ValueError, match="add the kernel that has it"):
        read_partner(kernels[:2], "didymos", "dimorphos", "2026-11-22T12:00:00")
    with pytest.warns(UserWarning, match="920065803"), pytest.raises(ValueError, match="BODY2065803_POLE_RA"):
        read_spin(kernels[:1], 2065803)
    # Nothing of it stays loaded.
    assert spice.ktotal("ALL") == 0
