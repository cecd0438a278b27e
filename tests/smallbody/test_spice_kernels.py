"""Spin and partner from kernels that these tests write with NAIF's own routines."""

import math
from pathlib import Path

import pytest

from lithobrake.smallbody import read_partner, read_spin

from .kernels import PERIOD, write_kernels

spice = pytest.importorskip("spiceypy")


@pytest.fixture
def kernels(tmp_path: Path) -> list[Path]:
    """Constants, leap seconds, and an ephemeris."""
    return write_kernels(tmp_path)


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
