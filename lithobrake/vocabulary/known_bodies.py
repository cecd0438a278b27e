"""Small bodies by name: the one table of their published mass, spin, size and orbit."""

from dataclasses import dataclass


@dataclass(frozen=True)
class KnownBody:
    """A small body whose mass, spin and pole are published.

    name as it is printed; mass [kg]; spin_period [s]; mean_radius [m], of the ball of its volume; pole: right ascension
    and declination in ICRF [deg], None where no flight depends on it; source of these numbers. missing: what the model
    leaves out there, as a sentence.
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
    missing: str = ""
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
    def is_synchronous(self) -> bool:
        """Whether it turns once an orbit of its partner."""
        return self.spin_period == self.orbit_period


MARS = (
    "Mars' attraction is left out: on Phobos it takes up to a half off the weight along the line to Mars, and flights "
    "beyond some kilometres are wrong."
)
_MUTUAL_PERIOD = 11.3674 * 3600.0  # since the impact of DART; [Naidu-2024]
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
    KnownBody("Phobos", 1.06e16, 27_553.8, 11_080.0, "[Patzold-2014], [Archinal-2018]", (317.67, 52.89), missing=MARS),
)  # fmt: skip
KNOWN_BODIES = {body.key: body for body in _BODIES}
# Those whose shape comes with the package.
BUILT_IN_BODIES = {key: body for key, body in KNOWN_BODIES.items() if body.is_built_in}
