"""Where Sun and Earth stand, against closed forms and another library; spin and partner from kernels of SPICE."""

import math
from pathlib import Path

import numpy as np
import pytest

from lithobrake.geometry.naif_kernels import kernel_files
from lithobrake.smallbody import HeliocentricOrbit, latitudes_over, read_partner, read_spin
from lithobrake.smallbody.sky import earth_place
from lithobrake.study.design_sections import OrbitSection
from lithobrake.vocabulary.clock import Epoch

from .kernels import PERIOD, write_kernels

spice = pytest.importorskip("spiceypy")
pytest.importorskip("erfa")


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
    assert (place.distance, place.period) == (pytest.approx(1150.0, rel=1e-9), pytest.approx(PERIOD, rel=1e-9))
    assert place.latitude_deg == pytest.approx(0.0, abs=1e-9)
    # An angle of 4e7 degrees keeps eight digits of its fraction.
    assert math.remainder(place.longitude_deg - longitude, 360.0) == pytest.approx(0.0, abs=1e-5)


META = r"""KPL/MK
\begindata
PATH_VALUES = ( '%s'
                '/nowhere' )
PATH_SYMBOLS = ( 'A', 'AB' )
KERNELS_TO_LOAD = ( '$A/did+'
                    'ymos.tpc' )
KERNELS_TO_LOAD += '$A/leap.tls'
\begintext
KERNELS_TO_LOAD = ( 'of a text' )
"""


def test_a_kernel_that_a_meta_kernel_names_is_read_again_when_it_changes(kernels: list[Path]) -> None:
    meta = kernels[0].with_name("all.tm")
    meta.write_text(META % meta.parent)
    assert kernel_files([str(meta)]) == [str(meta), *map(str, kernels[:2])]
    assert kernel_files([str(kernels[2]), "absent.tm"]) == [str(kernels[2]), "absent.tm"]
    before = read_spin([meta], "didymos").period
    kernels[0].write_text(kernels[0].read_text().replace("3823.0", "1911.5"))
    assert read_spin([meta], "didymos").period == pytest.approx(2.0 * before, rel=1e-15)


def test_what_the_kernels_do_not_say_is_refused(kernels: list[Path]) -> None:
    with pytest.raises(ValueError, match="no BODY2101955_POLE_RA"):
        read_spin(kernels[:1], 2101955)
    with pytest.raises(ValueError, match="counter-clockwise"):
        read_spin(kernels[:1], "dimorphos")
    with pytest.raises(ValueError, match="add the kernel that has it"):
        read_partner(kernels[:2], "didymos", "dimorphos", "2026-11-22T12:00:00")
    with pytest.warns(UserWarning, match="920065803"), pytest.raises(ValueError, match="BODY2065803_POLE_RA"):
        read_spin(kernels[:1], 2065803)
    with pytest.raises(ValueError, match=r'epoch is "2027-366", and 2027 has the days 001 to 365'):
        read_partner(kernels, "didymos", "dimorphos", "2027-366")
    # Nothing of it stays loaded.
    assert spice.ktotal("ALL") == 0


EPOCH = Epoch.of("2027-04-20")
OBLIQUITY = math.radians(84381.448 / 3600.0)
# A circle in the ecliptic, at the equinox at the epoch.
CIRCLE = HeliocentricOrbit(2.0, 0.0, 0.0, 0.0, 0.0, 0.0, EPOCH)
YEAR = 86_400.0 * 365.2568983  # s, of Gauss


def test_the_sun_goes_to_and_fro_over_a_circle_by_the_tilt_of_the_pole() -> None:
    """With the pole of ICRF: from 0 by -arcsin(sin(obliquity) sin(angle)), to the other side of the body's place."""
    found = latitudes_over(
        CIRCLE, 0.0, 90.0, [EPOCH.after(YEAR * 2.0**1.5 * part) for part in (0.0, 0.125, 0.25, 0.75)]
    )["sun"]
    angles = 2.0 * np.pi * np.array([0.0, 0.125, 0.25, 0.75])
    assert found == pytest.approx(-np.degrees(np.arcsin(np.sin(OBLIQUITY) * np.sin(angles))), abs=1e-4)


def test_an_ellipse_has_its_perihelion_where_its_elements_say() -> None:
    orbit = HeliocentricOrbit(1.6, 0.4, 90.0, 30.0, 90.0, 0.0, EPOCH)
    near, far = orbit.place([EPOCH, EPOCH.after(0.5 * YEAR * 1.6**1.5)])
    # At right angles to the node in an orbit across the ecliptic, perihelion is at the ecliptic's north pole.
    north = np.array([0.0, -math.sin(OBLIQUITY), math.cos(OBLIQUITY)])
    assert near == pytest.approx(0.96 * north, abs=1e-9)
    assert far == pytest.approx(-2.24 * north, abs=1e-3)


def test_the_orbit_of_the_template_takes_didymos_to_where_horizons_has_it() -> None:
    """Three and a half years before its epoch; planets have changed the orbit since by some hundredths of a degree."""
    examples = [field.examples or [""] for field in OrbitSection.model_fields.values()]
    *elements, epoch = (one[0].strip('"') for one in examples)
    orbit = HeliocentricOrbit(*map(float, elements), Epoch.of(epoch))
    (found,) = orbit.place([Epoch.of("2022-12-08T20:07:15")])
    horizons = np.array([0.1321900534972707, 1.022633896837742, 0.4564442166808176])
    assert np.linalg.norm(found - horizons) < math.radians(0.06) * np.linalg.norm(horizons)


def test_earth_is_where_another_library_has_it() -> None:
    coordinates, time = pytest.importorskip("astropy.coordinates"), pytest.importorskip("astropy.time")
    dates = [EPOCH, EPOCH.after(200.0 * 86_400.0)]
    for date, found in zip(dates, earth_place(dates), strict=True):
        at = time.Time(date.text(), scale="utc")
        earth, sun = (
            coordinates.get_body_barycentric(name, at, ephemeris="builtin").xyz.to_value("AU")
            for name in ("earth", "sun")
        )
        assert found == pytest.approx(earth - sun, abs=5e-5)


def test_latitudes_are_those_of_the_ways_from_the_body() -> None:
    """With the pole at the equinox, where the body is 2 AU from the Sun: over one pole the Sun, and Earth beside it."""
    found = latitudes_over(CIRCLE, 0.0, 0.0, [EPOCH])
    assert found["sun"] == pytest.approx([-90.0])
    way = earth_place([EPOCH])[0] - [2.0, 0.0, 0.0]
    assert found["earth"] == pytest.approx([math.degrees(math.asin(way[0] / np.linalg.norm(way)))])
    # Earth is never farther from the Sun than 30 degrees there.
    assert -89.0 < found["earth"][0] < -59.0
