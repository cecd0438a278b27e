"""Small bodies by name: the one table of their published mass, spin, size and orbit."""

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class KnownPartner:
    """The other body of a binary, or the planet of a moon, as a ball: name, mass [kg], diameter [m], and period of the
    mutual orbit [s]."""

    name: str
    mass: float
    diameter: float
    period: float


@dataclass(frozen=True)
class KnownBody:
    """A small body whose mass, spin and pole are published.

    name as it is printed; mass [kg]; spin_period [s]; mean_radius [m], of the ball of its volume; pole: right ascension
    and declination in ICRF [deg], None where no flight depends on it; source of these numbers. planet: what it is a
    moon of.
    A body whose shape comes with the package has extents along its axes [m], ridge_height [m] of a ridge along the
    equator, and a partner, by its key, with the period of their orbit [s] and the number that kernels of SPICE have for
    the body; another takes a mesh.
    """

    name: str
    mass: float
    spin_period: float
    mean_radius: float
    source: str
    pole: tuple[float, float] | None = None
    planet: KnownPartner | None = None
    extents: tuple[float, float, float] | None = None
    ridge_height: float = 0.0
    partner: str | None = None
    orbit_period: float | None = None
    kernel_number: int | None = None

    @property
    def key(self) -> str:
        """The name in a study file."""
        return self.name.lower()

    @property
    def is_built_in(self) -> bool:
        """Whether its shape comes with the package."""
        return self.extents is not None

    @property
    def companion(self) -> KnownPartner | None:
        """Its planet, or the other body of its binary; None where it is alone."""
        if self.partner is None or self.orbit_period is None:
            return self.planet
        other = KNOWN_BODIES[self.partner]
        return KnownPartner(other.name, other.mass, 2.0 * other.mean_radius, self.orbit_period)

    @property
    def is_synchronous(self) -> bool:
        """Whether it turns once an orbit of its partner."""
        return self.companion is not None and self.spin_period == self.companion.period


_MUTUAL_PERIOD = 11.3674 * 3600.0  # since the impact of DART; [Naidu-2024]
_PHOBOS_PERIOD = 27_553.8
# Extents of both: [Daly-2023]. The ridge of Didymos is a choice within the 15 m by which its extents are known.
_BODIES = (
    KnownBody(
        "Didymos", 5.32e11, 2.26 * 3600.0, 382.6, "[Daly-2023], [Naidu-2020]", extents=(851.0, 849.0, 620.0),
        ridge_height=20.0, partner="dimorphos", orbit_period=_MUTUAL_PERIOD, kernel_number=920065803,
    ),
    KnownBody(
        "Dimorphos", 4.3e9, _MUTUAL_PERIOD, 76.4, "[Daly-2023], [Naidu-2024]", extents=(177.0, 174.0, 116.0),
        partner="didymos", orbit_period=_MUTUAL_PERIOD, kernel_number=120065803,
    ),
    KnownBody("Bennu", 7.329e10, 4.296057 * 3600.0, 245.0, "[Lauretta-2019]", (85.65, -60.17)),
    KnownBody("Ryugu", 4.50e11, 7.63262 * 3600.0, 448.0, "[Watanabe-2019]", (96.40, -66.40)),
    KnownBody("Itokawa", 3.51e10, 12.132 * 3600.0, 162.0, "[Fujiwara-2006], [Demura-2006]", (90.53, -66.30)),
    KnownBody("Eros", 6.687e15, 5.27025547 * 3600.0, 8420.0, "[Yeomans-2000]", (11.37, 17.22)),
    KnownBody(
        "Phobos", 1.06e16, _PHOBOS_PERIOD, 11_080.0, "[Patzold-2014], [Archinal-2018]", (317.67, 52.89),
        planet=KnownPartner("Mars", 6.417e23, 6.779e6, _PHOBOS_PERIOD),
    ),
)  # fmt: skip
KNOWN_BODIES = {body.key: body for body in _BODIES}


def printed_name(name: str) -> str:
    """The name of a body as it is printed, from its key or the name that a study gives it."""
    return KNOWN_BODIES[name].name if name in KNOWN_BODIES else name


def body_named_in(*words: str) -> KnownBody | None:
    """The known body of which one of these names has the name as a word, as the file phobos_v2.obj has."""
    found = (KNOWN_BODIES.get(part) for word in words for part in re.split(r"[\W\d_]+", word.lower()))
    return next((body for body in found if body is not None), None)


PLANETS = ("Mercury", "Venus", "Earth", "Mars", "Jupiter", "Saturn", "Uranus", "Neptune")
# Those whose shape comes with the package.
BUILT_IN_BODIES = {key: body for key, body in KNOWN_BODIES.items() if body.is_built_in}
