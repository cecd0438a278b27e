"""The tables of the study file that say how a lander arrives, and how long it is followed from there by landings."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from lithobrake.study.quantity import (
    Angle,
    MaybeUncertain,
    Number,
    Numbers,
    Scalar,
    Section,
    Uncertain,
    Whole,
)
from lithobrake.study.release_section import Correlation, ReleaseSection

Error = Annotated[Scalar, MaybeUncertain("m")]
Spin = Annotated[Scalar, MaybeUncertain("rad/s")]
# Of its keys, those that say where the lander arrives; the others say how.
PLACE_KEYS = ("latitude_deg", "longitude_deg", "heading_deg", "north_error", "east_error")
# Those of a lander that is flown to the ground from a state, and of draws that go together: of no other table.
OWN_KEYS = ("correlations", "frame", "epoch", "states", "release")
# What such a flight tells and no one gives; from the aim point no direction is then better than another.
FLOWN = ("speed", "incidence_deg", "heading_deg", "north_error", "east_error")
ANY_HEADING = Uncertain("uniform", {"lower": 0.0, "upper": 360.0})
# Grains that barely move are held still in a slow touchdown, which costs a third less and changes no statistic of it
# (docs/decisions/touchdown.md).
HELD_SPEED = 0.03


class DeliverySection(Section):
    """How the lander arrives at its first touchdown: as the keys say, or flown to the ground from a state, a row of
    `states` or a draw of [delivery.release]. Each key up to spin_z stands here or, by the same name, in [impact] or
    [site]. A lander that is flown takes speed, incidence, heading and place from its flight, and attitude and spin from
    here unless `states` has them; latitude_deg and longitude_deg are then its aim point, from which distances count
    and under whose gravity beds settle."""

    latitude_deg: Annotated[Scalar, MaybeUncertain("deg", at_least=-90, at_most=90)] | None = None
    """Latitude of the aim point, planetocentric."""
    longitude_deg: Angle | None = None
    """Longitude of the aim point, east."""
    heading_deg: Angle | None = None
    """Direction of the incoming horizontal velocity, from north toward east."""
    north_error: Error | None = None
    """How far the delivery misses the aim point toward north."""
    east_error: Error | None = None
    """The same toward east."""
    speed: Annotated[Scalar, MaybeUncertain("m/s", above=0, at_most=1000)] | None = None
    """Speed against the ground."""
    incidence_deg: Annotated[Scalar, MaybeUncertain("deg", at_least=0, below=90)] | None = None
    """Angle between the velocity and the inward normal of the ground; 0 is straight down."""
    orientation: Annotated[tuple[float, ...] | str, Numbers("", count=4, word="random")] | None = None
    """Attitude as a quaternion w, x, y, z, or "random"; absent: random."""
    pointing_error_deg: Annotated[float, Number("deg", above=0, at_most=180)] | None = None
    """Half the opening of the cone in which the lander's z axis points, about where `orientation` turns it."""
    spin_x: Spin | None = None
    """Angular velocity about x, which lies along the incoming horizontal velocity where impact.azimuth_deg is 0."""
    spin_y: Spin | None = None
    """Angular velocity about y."""
    spin_z: Spin | None = None
    """Angular velocity about z, the outward normal."""
    correlations: tuple[Correlation, ...] | None = Field(
        default=None, examples=['[["north_error", "east_error", 0.5]]']
    )
    """Rank correlations (Spearman) of uncertain keys above, each two keys and a number between -1 and 1; all other
    pairs are independent. Draws go together by a Gaussian copula."""
    frame: Literal["body_fixed", "icrf"] | None = None
    """Axes of the states: "body_fixed", turning with the body, velocities against them; "icrf", which do not turn,
    through site.pole_right_ascension_deg, site.pole_declination_deg and site.meridian_deg. Either has its origin at
    that of the body's shape."""
    epoch: str | None = Field(default=None, examples=['"2027-04-20T12:00:00"'])
    """Date and time at which the time of the states is 0, in the time system of an ephemeris message, else UTC; absent:
    that of the earliest state of the message."""
    states: str | None = Field(default=None, examples=['"states.csv"'])
    """States that another tool has drawn, one a journey in the order of the file, which counts from the study file: a
    table (CSV) with columns such as time_s, x_m and vx_m_s, or an ephemeris message (OEM); docs/delivery.md."""
    release: ReleaseSection | None = None

    @property
    def is_flown(self) -> bool:
        """Whether landers are flown to the ground from states."""
        return self.states is not None or self.release is not None


SURFACE_KEYS = tuple(key for key in DeliverySection.model_fields if key not in OWN_KEYS)


class JourneySection(Section):
    """Each lander is followed to rest, with a simulated landing at every impact. Absent: it is followed through its
    first touchdown, and the emulator answers for those that come after."""

    count: Annotated[int, Whole("", at_least=2, at_most=1_000_000)] | None = Field(default=None, examples=["96"])
    """How many journeys; a larger count keeps those of a smaller one. Absent: design.run_count."""
    duration: Annotated[float, Number("s", above=0)] = 172_800.0
    """Longest journey, counted from the first touchdown, and longest flight from a state to the ground."""
    hop_height: Annotated[float, Number("m", above=0)] | None = None
    """A lander that would rise higher over the ground leaves the bed and flies in the gravity of the body; lower hops
    are part of the touchdown. Absent: three times the lander's largest diameter."""
    emulated_count: Annotated[int, Whole("", at_least=0, at_most=1_000_000)] = 5000
    """Landers that the emulator of all touchdowns follows beside them, as a check and to narrow the shares of the ends;
    0: none."""


def arrival_key(name: str) -> str:
    """The dotted key, in [impact] or [site], that a key of [delivery] stands for; any other name is its own."""
    table, _, key = name.partition(".")
    return name if table != "delivery" else f"{'site' if key in PLACE_KEYS else 'impact'}.{key}"


def delivered_tables(tables: Mapping[str, Any]) -> Mapping[str, Any]:
    """The tables of a study with the keys of [delivery] where the touchdown and the flight read them.

    What stands in two places, or is no key of [delivery], is left for the checks.
    """
    delivery = tables.get("delivery")
    if not isinstance(delivery, Mapping):
        return tables
    parts = {name: tables.get(name, {}) for name in ("impact", "site")}
    if not all(isinstance(part, Mapping) for part in parts.values()):
        return tables
    for key, value in delivery.items():
        if key in SURFACE_KEYS and value is not None:
            part = "site" if key in PLACE_KEYS else "impact"
            parts[part] = {key: value, **parts[part]}
    if any(delivery.get(key) is not None for key in ("states", "release")):
        parts["impact"] = {"speed": None, "incidence_deg": None, **parts["impact"]}
        parts["site"] = {"heading_deg": ANY_HEADING, **parts["site"]}
    return {**tables, **parts}


def journey_tables(tables: Mapping[str, Any]) -> Mapping[str, Any]:
    """The tables of a study with what follows from [journey]: the run count, local gravity, and grains held still."""
    journey = tables.get("journey")
    if not isinstance(journey, Mapping):
        return tables
    filled: dict[str, dict[str, Any]] = {"surface": {"gravity": "site"}, "contact": {"held_speed": HELD_SPEED}}
    if journey.get("count") is not None:
        filled["design"] = {"run_count": journey["count"]}
    if isinstance(contact := tables.get("contact"), Mapping) and contact.get("stepping", "local") != "local":
        filled.pop("contact")
    given = {name: tables.get(name, {}) for name in filled}
    merged = {name: {**filled[name], **part} for name, part in given.items() if isinstance(part, Mapping)}
    return {**tables, **merged}
