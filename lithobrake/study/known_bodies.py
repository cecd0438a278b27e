"""Small bodies by name: what `lithobrake new` writes into the table [site] of a study."""

from dataclasses import dataclass

from lithobrake.study.by_name import by_name


@dataclass(frozen=True)
class KnownBody:
    """A small body whose mass, spin and pole are published.

    name as it is printed; mass [kg]; spin_period [s]; mean_radius [m], of the ball of its volume; pole: right ascension
    and declination in ICRF [deg], None where no flight depends on it; source of these numbers. is_built_in: its shape
    comes with the package; another takes a mesh. missing: what the model leaves out there, as a sentence.
    """

    name: str
    mass: float
    spin_period: float
    mean_radius: float
    source: str
    pole: tuple[float, float] | None = None
    is_built_in: bool = False
    missing: str = ""


MARS = (
    "Mars' attraction is left out: on Phobos it takes up to a half off the weight along the line to Mars, and flights "
    "beyond some kilometres are wrong."
)
_BODIES = (
    KnownBody("Didymos", 5.32e11, 2.26 * 3600.0, 382.6, "[Daly-2023], [Naidu-2020]", is_built_in=True),
    KnownBody("Dimorphos", 4.3e9, 11.3674 * 3600.0, 76.4, "[Daly-2023], [Naidu-2024]", is_built_in=True),
    KnownBody("Bennu", 7.329e10, 4.296057 * 3600.0, 245.0, "[Lauretta-2019]", (85.65, -60.17)),
    KnownBody("Ryugu", 4.50e11, 7.63262 * 3600.0, 448.0, "[Watanabe-2019]", (96.40, -66.40)),
    KnownBody("Itokawa", 3.51e10, 12.132 * 3600.0, 162.0, "[Fujiwara-2006], [Demura-2006]", (90.53, -66.30)),
    KnownBody("Eros", 6.687e15, 5.27025547 * 3600.0, 8420.0, "[Yeomans-2000]", (11.37, 17.22)),
    KnownBody("Phobos", 1.06e16, 27_553.8, 11_080.0, "[Patzold-2014], [Archinal-2018]", (317.67, 52.89), missing=MARS),
)
BODIES = {body.name.lower(): body for body in _BODIES}


def known_body(name: str) -> KnownBody:
    """The body of a name in any case. Raises ValueError for another name."""
    return by_name("body", BODIES, name, "for another body write its mass and spin into [site]")
