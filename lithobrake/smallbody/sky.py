"""What a place on the ground sees of the sky, and where Sun and Earth stand over a small body."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.compilation.compiled import compiled
from lithobrake.geometry.naif_kernels import spice
from lithobrake.smallbody.facet_grid import intersect_facet
from lithobrake.smallbody.shape import Shape
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.clock import Epoch
from lithobrake.vocabulary.constants import DAY
from lithobrake.vocabulary.extra_library import extra_library
from lithobrake.vocabulary.given_numbers import finite_number, numbers

# Directions in a day: rise and set are known to half of one each, a fraction of the day to one over this.
DIRECTIONS = 144
# Places of an orbiter on its circle.
PLACES = 720
# Part of the radius by which an eye stands above its own facet, so that it does not hide itself.
EYE = 1e-6
# Multiples of it, less the whole turns, fill the circle evenly however many are taken: the golden ratio.
EVEN = 0.5 * (1.0 + 5.0**0.5)
# Attraction of the Sun [km3/s2], nominal, and the astronomical unit [km]. Source: [Prsa-2016], [IAU-2012].
SUN, ASTRONOMICAL_UNIT = 1.327_124_4e11, 149_597_870.7
# Julian date of the epoch of J2000.
J2000 = 2_451_545.0


class Screen(NamedTuple):
    """A body that hides what is behind it, as a spheroid about an axis along z.

    centre      at each of the directions [m], body-fixed, [direction_count, 3]
    equatorial  semi-axis [m], and polar
    """

    centre: NDArray[np.float64]
    equatorial: float
    polar: float


def day_directions(latitude_deg: ArrayLike) -> NDArray[np.float64]:
    """Unit vectors, body-fixed, to bodies far away that stand over latitudes [deg], [count, DIRECTIONS, 3].

    They are evenly spaced over a day of the body, from longitude 0 westward.
    """
    latitude = np.radians(numbers("latitude_deg", latitude_deg))[:, None]
    longitude = -2.0 * np.pi * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    along = np.cos(latitude)
    up = np.broadcast_to(np.sin(latitude), (len(latitude), DIRECTIONS))
    return np.stack([along * np.cos(longitude), along * np.sin(longitude), up], axis=-1)


def circle_places(radius: float, inclination_deg: float) -> NDArray[np.float64]:
    """Places on a circular orbit [m], body-fixed, [PLACES, 3]: any phase of it with any longitude of its node alike.

    So a long time is, over which the body turns below the orbit. radius [m]; inclination to the body's equator [deg].
    Raises ValueError for a radius that is not above 0, and an inclination beyond 0 to 180 degrees.
    """
    radius = finite_number("radius", radius, above=0.0)
    inclination_deg = finite_number("inclination_deg", inclination_deg, at_least=0.0, at_most=180.0)
    phase, inclination = 2.0 * np.pi * (np.arange(PLACES) + 0.5) / PLACES, np.radians(inclination_deg)
    x, across = np.cos(phase), np.sin(phase)
    node = 2.0 * np.pi * (np.arange(PLACES) * EVEN % 1.0)
    y, z = across * np.cos(inclination), across * np.sin(inclination)
    return radius * np.stack([x * np.cos(node) - y * np.sin(node), x * np.sin(node) + y * np.cos(node), z], axis=1)


def seen_from(
    shape: Shape,
    points: ArrayLike,
    up: ArrayLike,
    directions: ArrayLike,
    mask_deg: float = 0.0,
    *,
    distance: ArrayLike = np.inf,
    screen: Screen | None = None,
) -> NDArray[np.bool_]:
    """Whether something is seen from places on the ground in each of its directions, [count, direction_count].

    points [m] and outward normals up of the ground, [count, 3]; directions: unit vectors from each place, body-fixed,
    [count, direction_count, 3]; distance: how far away it is there [m], a number or [count, direction_count]. It is
    seen where it stands higher above the plane of the ground than mask_deg, and neither a facet nor the screen is
    before it.
    """
    place, normal, along = numbers("points", points), numbers("up", up), numbers("directions", directions)
    height = np.einsum("pdi,pi->pd", along, normal)
    seen = height > np.sin(np.radians(mask_deg))
    eyes = place + EYE * shape.radius * normal
    far = np.ascontiguousarray(np.broadcast_to(np.asarray(distance, dtype=np.float64), seen.shape))
    _take_out_hidden(
        shape.corners, np.ascontiguousarray(eyes), np.ascontiguousarray(normal), np.ascontiguousarray(along), far, seen
    )
    return seen if screen is None else seen & ~_behind(screen, eyes, along, far)


def _behind(screen: Screen, eyes: Floats, directions: Floats, distance: Floats) -> NDArray[np.bool_]:
    """Whether the screen stands before what is so far away, [count, direction_count]."""
    # Where the spheroid is a ball of its equatorial radius, lines stay lines, and how far along them stays, too.
    stretched = np.array([1.0, 1.0, screen.equatorial / screen.polar])
    way, along = (screen.centre[None] - eyes[:, None]) * stretched, directions * stretched
    square = (along**2).sum(axis=-1)
    nearest = (way * along).sum(axis=-1) / square
    inside = screen.equatorial**2 - ((way - nearest[..., None] * along) ** 2).sum(axis=-1)
    first = nearest - np.sqrt(np.maximum(inside, 0.0) / square)
    hidden: NDArray[np.bool_] = (inside > 0.0) & (first > 0.0) & (first < distance)
    return hidden


@compiled
def _take_out_hidden(
    corner: Floats, eyes: Floats, up: Floats, directions: Floats, distance: Floats, seen: NDArray[np.bool_]
) -> None:
    """Write False where a facet stands in the way; only facets that rise above the plane of the ground can."""
    for p in range(len(eyes)):
        for f in range(len(corner)):
            highest = -np.inf
            for c in range(3):
                rise = 0.0
                for i in range(3):
                    rise += (corner[f, c, i] - eyes[p, i]) * up[p, i]
                highest = max(highest, rise)
            if highest <= 0.0:
                continue
            for d in range(directions.shape[1]):
                if seen[p, d]:
                    t, _ = intersect_facet(corner, f, eyes[p], directions[p, d])
                    if 0.0 < t < distance[p, d]:
                        seen[p, d] = False


@dataclass(frozen=True)
class HeliocentricOrbit:
    """Osculating elements, ecliptic and equinox of J2000: semi-major axis [AU], eccentricity, angles [deg], epoch.

    Raises ValueError for an orbit that is not closed, numbers that are not finite, and what is no epoch.
    """

    semi_major_axis_au: float
    eccentricity: float
    inclination_deg: float
    node_deg: float
    perihelion_deg: float
    mean_anomaly_deg: float
    epoch: Epoch

    def __post_init__(self) -> None:
        finite_number("semi_major_axis_au", self.semi_major_axis_au, above=0.0)
        finite_number("eccentricity", self.eccentricity, at_least=0.0, below=1.0)
        for name in ("inclination_deg", "node_deg", "perihelion_deg", "mean_anomaly_deg"):
            finite_number(name, getattr(self, name), at_least=-360.0, at_most=360.0)
        if not isinstance(self.epoch, Epoch):
            raise ValueError(f"epoch is {self.epoch!r}, but must be an Epoch")

    def place(self, dates: Sequence[Epoch]) -> Floats:
        """Heliocentric places [AU] along ICRF, [date_count, 3], by Kepler's equation as SPICE solves it.

        Raises ImportError without spiceypy.
        """
        library = spice()
        angles = np.radians([self.inclination_deg, self.node_deg, self.perihelion_deg, self.mean_anomaly_deg])
        nearest = self.semi_major_axis_au * ASTRONOMICAL_UNIT * (1.0 - self.eccentricity)
        elements = [nearest, self.eccentricity, *angles, 0.0, SUN]
        states = [library.conics(elements, date.since(self.epoch))[:3] for date in dates]
        return np.array(states) @ np.array(library.pxform("ECLIPJ2000", "J2000", 0.0)).T / ASTRONOMICAL_UNIT


def earth_place(dates: Sequence[Epoch]) -> Floats:
    """Heliocentric places of Earth [AU] along ICRF, [date_count, 3].

    Raises ImportError without pyerfa. Source: [Moisson-2001], as ERFA shortens it (epv00).
    """
    days = np.array([date.ephemeris_time / DAY for date in dates])
    erfa = extra_library("erfa", "pyerfa, which knows where Earth is,", "spice")
    heliocentric, _ = erfa.epv00(J2000, days)
    return np.array(heliocentric["p"])


def latitudes_over(
    orbit: HeliocentricOrbit, pole_right_ascension_deg: float, pole_declination_deg: float, dates: Sequence[Epoch]
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
