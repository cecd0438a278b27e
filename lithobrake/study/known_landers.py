"""Landers by name: what `lithobrake new` writes into the table [lander] of a study."""

from dataclasses import dataclass

from lithobrake.study.by_name import by_name

_CDS = "largest mass and envelope in [CDS-2022], without deployable parts"


@dataclass(frozen=True)
class KnownLander:
    """A box without wings and booms: name as it is printed, edges [m], mass [kg], and where they come from."""

    name: str
    edges: tuple[float, float, float]
    mass: float
    source: str


_LANDERS = (
    KnownLander("1U", (0.1, 0.1, 0.1135), 2.0, _CDS),
    KnownLander("2U", (0.1, 0.1, 0.227), 4.0, _CDS),
    KnownLander("3U", (0.1, 0.1, 0.3405), 6.0, _CDS),
    KnownLander("6U", (0.2263, 0.1, 0.366), 12.0, _CDS),
    KnownLander("12U", (0.2263, 0.2263, 0.366), 24.0, _CDS),
    KnownLander("Juventas", (0.37, 0.23, 0.10), 12.0, "[ESA-2024]; its four booms of 1.5 m are left out"),
    KnownLander("Milani", (0.13, 0.246, 0.366), 12.0, "[Hera-2024]; its wings are left out"),
    KnownLander("MASCOT", (0.275, 0.29, 0.195), 10.0, "[Scholten-2019]"),
)
LANDERS = {lander.name.lower(): lander for lander in _LANDERS}


def known_lander(name: str) -> KnownLander:
    """The lander of a name in any case. Raises ValueError for another name."""
    return by_name("lander", LANDERS, name, "for another one write its edges and mass")
