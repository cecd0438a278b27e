"""The tables of the study file that say how a lander arrives, and how long it is followed from there by landings."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field

from lithobrake.study.quantity import Angle, MaybeUncertain, Number, Numbers, Scalar, Section, Whole

Error = Annotated[Scalar, MaybeUncertain("m")]
Spin = Annotated[Scalar, MaybeUncertain("rad/s")]
# Of its keys, those that say where the lander arrives; the others say how.
PLACE_KEYS = ("latitude_deg", "longitude_deg", "heading_deg", "north_error", "east_error")
# Grains that barely move are held still in a slow touchdown, which costs a third less and changes no statistic of it
# (docs/decisions/touchdown.md).
HELD_SPEED = 0.03


class DeliverySection(Section):
    """How the lander arrives at the surface, at its first touchdown. Each key stands here or, by the same name, in
    [impact] or [site]."""

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


class JourneySection(Section):
    """Each lander is followed to rest, with a simulated landing at every impact. Absent: it is followed through its
    first touchdown, and the emulator answers for those that come after."""

    count: Annotated[int, Whole("", at_least=2, at_most=1_000_000)] | None = Field(default=None, examples=["96"])
    """How many journeys; a larger count keeps those of a smaller one. Absent: design.run_count."""
    duration: Annotated[float, Number("s", above=0)] = 172_800.0
    """Longest journey, counted from the first touchdown."""
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
        part = "site" if key in PLACE_KEYS else "impact"
        if key in DeliverySection.model_fields and value is not None:
            parts[part] = {key: value, **parts[part]}
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
