"""Where Sun and Earth stand over a small body, from its heliocentric orbit and its pole."""

import importlib
from collections.abc import Sequence
from datetime import datetime
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lithobrake.geometry.body_kernels import DAY
from lithobrake.geometry.kernel_process import INSTALL, spice

Floats = NDArray[np.float64]
# Attraction of the Sun [km3/s2], nominal, and the astronomical unit [km]. Source: [Prsa-2016], [IAU-2012].
SUN, ASTRONOMICAL_UNIT = 1.327_124_4e11, 149_597_870.7
# Julian date of the epoch of J2000, and the same as a date.
J2000, AT_J2000 = 2_451_545.0, datetime(2000, 1, 1, 12)


class HeliocentricOrbit(NamedTuple):
    """Osculating elements, ecliptic and equinox of J2000: semi-major axis [AU], eccentricity, angles [deg] and date."""

    semi_major_axis_au: float
    eccentricity: float
    inclination_deg: float
    node_deg: float
    perihelion_deg: float
    mean_anomaly_deg: float
    epoch: datetime

    def place(self, dates: Sequence[datetime]) -> Floats:
        """Heliocentric places [AU] along ICRF, [date_count, 3], by Kepler's equation as SPICE solves it.

        Raises ImportError without spiceypy.
        """
        library = spice()
        angles = np.radians([self.inclination_deg, self.node_deg, self.perihelion_deg, self.mean_anomaly_deg])
        nearest = self.semi_major_axis_au * ASTRONOMICAL_UNIT * (1.0 - self.eccentricity)
        elements = [nearest, self.eccentricity, *angles, 0.0, SUN]
        states = [library.conics(elements, (date - self.epoch).total_seconds())[:3] for date in dates]
        return np.array(states) @ np.array(library.pxform("ECLIPJ2000", "J2000", 0.0)).T / ASTRONOMICAL_UNIT


def earth_place(dates: Sequence[datetime]) -> Floats:
    """Heliocentric places of Earth [AU] along ICRF, [date_count, 3]; UTC stands for TDB, a minute that moves it little.

    Raises ImportError without pyerfa. Source: [Moisson-2001], as ERFA shortens it (epv00).
    """
    days = np.array([(date - AT_J2000).total_seconds() / DAY for date in dates])
    heliocentric, _ = _erfa().epv00(J2000, days)
    return np.array(heliocentric["p"])


def latitudes_over(
    orbit: HeliocentricOrbit, pole_right_ascension_deg: float, pole_declination_deg: float, dates: Sequence[datetime]
) -> dict[str, Floats]:
    """Latitudes [deg], [date_count], over which Sun and Earth stand, by name; the pole of the body is along ICRF."""
    body = orbit.place(dates)
    right_ascension, declination = np.radians(pole_right_ascension_deg), np.radians(pole_declination_deg)
    level = np.cos(declination)
    pole = np.array([level * np.cos(right_ascension), level * np.sin(right_ascension), np.sin(declination)])
    ways = {"sun": -body, "earth": earth_place(dates) - body}
    return {name: latitude_of(way, pole) for name, way in ways.items()}


def latitude_of(way: Floats, pole: Floats) -> Floats:
    """Latitudes [deg], [count], of directions [count, 3] about a pole, a unit vector."""
    found: Floats = np.degrees(np.arcsin(np.clip(way @ pole / np.linalg.norm(way, axis=1), -1.0, 1.0)))
    return found


def _erfa() -> Any:
    try:
        return importlib.import_module("erfa")
    except ImportError as error:
        raise ImportError(f"pyerfa, which knows where Earth is, is not installed: {INSTALL}") from error
