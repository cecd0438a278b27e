"""The tables of the study file that say how a lander arrives or is released, and how long it is followed."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field
from pydantic_core import core_schema

from lithobrake.study import quantity

# Largest numbers of a state by their units: all orbits about a small body are well within the first, and speeds against
# axes that turn with the body within the second. The resolution of a larger time is worse than 0.1 ms.
LARGEST = {"m": 1e9, "m/s": 1e6, "s": 1e11, "rad/s": 1e3}
FAR, FAST, LATE = (LARGEST[unit] for unit in ("m", "m/s", "s"))
Matrix = tuple[tuple[float, ...], ...]
SIDE = 6
Error = Annotated[quantity.Scalar, quantity.MaybeUncertain("m")]
Offset = Annotated[float, quantity.Number("m", at_least=-FAR, at_most=FAR)]
VelocityOffset = Annotated[float, quantity.Number("m/s", at_least=-FAST, at_most=FAST)]
Spin = Annotated[quantity.Scalar, quantity.MaybeUncertain("rad/s")]
# Of its keys, those that say where the lander arrives; the others say how.
PLACE_KEYS = ("latitude_deg", "longitude_deg", "heading_deg", "north_error", "east_error")
# Those of a lander that is flown to the ground from a state, and of draws that go together: of no other table.
OFFSETS = ("offset_up", "offset_north", "offset_east")
VELOCITY_OFFSETS = tuple(f"velocity_{key}" for key in OFFSETS)
OWN_KEYS = ("correlations", "frame", "epoch", "states", "release", *OFFSETS, *VELOCITY_OFFSETS)
# What such a flight tells and no one gives; from the aim point no direction is then better than another.
FLOWN = ("speed", "incidence_deg", "heading_deg", "north_error", "east_error")
ANY_HEADING = quantity.Uncertain("uniform", {"lower": 0.0, "upper": 360.0})
# Of these, the errors; those of a release are its standard deviations or its covariance.
ERROR_KEYS = ("north_error", "east_error")
# Of one journey; more would be a lander that moves along for ever.
MOST_TOUCHDOWNS = 1000
# What follows for those who look at first touchdowns alone.
FIRST_TOUCHDOWN_TIME, FIRST_TOUCHDOWN_SAMPLES, EMULATED_LANDERS = 60.0, 100_000, 5000


class SquareMatrix:
    def __get_pydantic_core_schema__(self, _source: object, _handler: object) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def read(self, value: Any) -> Matrix:
        rows = value if isinstance(value, list | tuple) else ()
        if len(rows) != SIDE or not all(isinstance(row, list | tuple) and len(row) == SIDE for row in rows):
            raise quantity.refuse(
                value, f"{SIDE} rows of {SIDE} numbers", "write six lists of six numbers in square brackets"
            )
        if not all(quantity.is_number(entry) for row in rows for entry in row):
            raise quantity.refuse(value, f"{SIDE} rows of {SIDE} finite numbers", "write finite numbers without quotes")
        return tuple(tuple(float(entry) for entry in row) for row in rows)


class CorrelatedPair:
    def __get_pydantic_core_schema__(self, _source: object, _handler: object) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self.read)

    def read(self, value: Any) -> tuple[str, str, float]:
        allowed = "two keys and a number between -1 and 1"
        if not isinstance(value, list | tuple) or len(value) != 3 or not all(isinstance(one, str) for one in value[:2]):
            raise quantity.refuse(value, allowed, 'write it as ["north_error", "east_error", 0.5]')
        if not quantity.is_number(value[2]) or not -1.0 < value[2] < 1.0:
            raise quantity.refuse(value, allowed, "write such a number without quotes")
        return value[0], value[1], float(value[2])


Correlation = Annotated[tuple[str, str, float], CorrelatedPair()]


class Deviations(quantity.Numbers):
    """One standard deviation, or three."""

    def check(self, value: Any) -> tuple[float, ...]:
        """Give back three numbers."""
        return super().check([value] * 3 if quantity.is_number(value) else value)


class ReleaseSection(quantity.Section):
    """The mean state in which a carrier releases the lander, in the axes of delivery.frame. The state of each journey
    is sampled from a normal distribution about it, and the lander flies to the ground. The spread is `covariance`, or
    `position_std` and `velocity_std`; without them all journeys begin in the same state."""

    time: Annotated[float, quantity.Number("s", at_least=-LATE, at_most=LATE)] = 0.0
    """Time of the release, counted from delivery.epoch."""
    position: Annotated[tuple[float, ...], quantity.Numbers("m", at_least=-FAR, at_most=FAR)] = Field(
        examples=["[0.0, -300.0, 0.0]"]
    )
    """x, y, z from the centre of the body."""
    velocity: Annotated[tuple[float, ...], quantity.Numbers("m/s", at_least=-FAST, at_most=FAST)] = Field(
        examples=["[0.0, 0.03, 0.0]"]
    )
    """Along the same axes."""
    position_std: Annotated[tuple[float, ...], Deviations("m", at_least=0, at_most=FAR)] | None = Field(
        default=None, examples=["30.0"]
    )
    """Standard deviation in every direction, or three: up, from the centre of the body; north; east."""
    velocity_std: Annotated[tuple[float, ...], Deviations("m/s", at_least=0, at_most=FAST)] | None = Field(
        default=None, examples=["0.0067"]
    )
    """The same for the velocity."""
    covariance: Annotated[Matrix, SquareMatrix()] | None = None
    """Instead of these: six rows of six numbers, for x, y, z, vx, vy, vz along the axes of delivery.frame [m2, m2/s,
    m2/s2]."""

    @property
    def has_errors(self) -> bool:
        """Whether its landers begin in different states."""
        rows = self.covariance or (self.position_std or (), self.velocity_std or ())
        return any(entry != 0.0 for row in rows for entry in row)

    def with_errors(self, factor: float) -> "ReleaseSection":
        """The same release with errors so many times as large, the covariance by the square of that."""
        given = {name: getattr(self, name) for name in ("position_std", "velocity_std")}
        changed: dict[str, Any] = {
            name: tuple(factor * one for one in std) for name, std in given.items() if std is not None
        }
        if self.covariance is not None:
            changed["covariance"] = tuple(tuple(factor**2 * one for one in row) for row in self.covariance)
        return self.model_copy(update=changed)


class DeliverySection(quantity.Section):
    """How the lander arrives at its first touchdown: as the keys state, or by a flight to the ground from a state,
    which is a row of `states` or a sample of [delivery.release]. Each key up to spin_z may be given here or, by the
    same name, in [impact] or [site]. After a flight, speed, incidence, heading and place are those of the flight;
    attitude and spin are those given here, unless `states` has them. latitude_deg and longitude_deg are then the aim
    point: distances count from it, and beds settle under its gravity."""

    latitude_deg: Annotated[quantity.Scalar, quantity.MaybeUncertain("deg", at_least=-90, at_most=90)] | None = None
    """Latitude of the aim point, planetocentric."""
    longitude_deg: quantity.Angle | None = None
    """Longitude of the aim point, east."""
    heading_deg: quantity.Angle | None = None
    """Direction of the incoming horizontal velocity, from north toward east."""
    north_error: Error | None = None
    """Distance by which the delivery misses the aim point toward north."""
    east_error: Error | None = None
    """The same toward east."""
    speed: Annotated[quantity.Scalar, quantity.MaybeUncertain("m/s", above=0, at_most=1000)] | None = None
    """Speed relative to the ground."""
    incidence_deg: Annotated[quantity.Scalar, quantity.MaybeUncertain("deg", at_least=0, below=90)] | None = None
    """Angle between the velocity and the inward normal of the ground; 0 is straight down."""
    orientation: Annotated[tuple[float, ...] | str, quantity.Numbers("", count=4, word="random")] | None = None
    """Attitude as a quaternion w, x, y, z, or "random"; absent: random."""
    pointing_error_deg: Annotated[float, quantity.Number("deg", above=0, at_most=180)] | None = None
    """Half the opening angle of the cone in which the lander's z axis points, about its direction by `orientation`."""
    spin_x: Spin | None = None
    """Angular velocity about x, which lies along the incoming horizontal velocity where impact.azimuth_deg is 0."""
    spin_y: Spin | None = None
    """Angular velocity about y."""
    spin_z: Spin | None = None
    """Angular velocity about z, the outward normal."""
    correlations: tuple[Correlation, ...] | None = Field(
        default=None, examples=['[["north_error", "east_error", 0.5]]']
    )
    """Rank correlations (Spearman) of uncertain keys above: for each, two keys and a number between -1 and 1. All other
    pairs are independent. Samples come from a Gaussian copula."""
    frame: Literal["body_fixed", "icrf"] | None = None
    """Axes of the states. "body_fixed": they rotate with the body, and velocities are relative to them. "icrf": they do
    not rotate; site.pole_right_ascension_deg, site.pole_declination_deg and site.meridian_deg give the attitude of the
    body. Both have the origin of the body's shape."""
    epoch: str | None = Field(default=None, examples=['"2027-04-20T12:00:00"'])
    """Date and time at which the time of the states is 0: in UTC, or in the time system that it ends with, as in
    "2027-04-20T12:00:00 TDB" (UTC, TAI, GPS, TT, TDB). Absent: that of the earliest state of the message."""
    states: str | None = Field(default=None, examples=['"states.csv"'])
    """File of states from another tool, relative to the study file, one state per journey in the order of the file: a
    table (CSV) with columns such as time_s, x_m and vx_m_s, or an ephemeris message (OEM); docs/delivery.md."""
    offset_up: Offset | None = None
    """Added to the position of every state or release: away from the centre of the body. `aim.grid` can
    compare several values."""
    offset_north: Offset | None = None
    """The same toward north at that position."""
    offset_east: Offset | None = None
    """The same toward east."""
    velocity_offset_up: VelocityOffset | None = None
    """Added to the velocity of every state or release, in the same three directions."""
    velocity_offset_north: VelocityOffset | None = None
    """The same toward north."""
    velocity_offset_east: VelocityOffset | None = None
    """The same toward east."""
    release: ReleaseSection | None = None

    @property
    def is_flown(self) -> bool:
        return self.states is not None or self.release is not None

    @property
    def offsets(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """What is added to positions [m] and velocities [m/s], up, north and east."""
        position, velocity = (tuple(getattr(self, key) or 0.0 for key in keys) for keys in (OFFSETS, VELOCITY_OFFSETS))
        return position, velocity


SURFACE_KEYS = tuple(key for key in DeliverySection.model_fields if key not in OWN_KEYS)


class JourneySection(quantity.Section):
    """How far each lander is followed, with a landing simulated at every impact."""

    touchdowns: Annotated[int, quantity.Whole("", at_least=1, at_most=MOST_TOUCHDOWNS)] | None = Field(
        default=None, examples=["1"]
    )
    """Most touchdowns of a lander; 1: the first touchdown alone. Absent: landers are followed to rest."""
    count: Annotated[int, quantity.Whole("", at_least=2, at_most=1_000_000)] | None = None
    """Number of journeys; a larger count keeps those of a smaller one. Absent: design.run_count."""
    duration: Annotated[float, quantity.Number("s", above=0, at_most=LATE)] = 172_800.0
    """Longest journey, counted from the first touchdown, and longest flight from a state to the ground."""
    hop_height: Annotated[float, quantity.Number("m", at_least=0, at_most=1000)] | None = None
    """A lander that would rise higher above the ground than this leaves the bed and flies in the gravity of the body;
    lower hops are part of the touchdown. 0: the touchdown ends when the lander first leaves the ground, or has too
    little energy to leave it. Absent: three times the lander's largest diameter; 0 with touchdowns = 1."""
    emulated_count: Annotated[int, quantity.Whole("", at_least=0, at_most=1_000_000)] | None = None
    """Number of further landers that the emulator of all touchdowns follows to rest, as a check and to narrow the
    intervals of the fractions of all ends. 0: none. Absent: 5000; none with touchdowns = 1, whose emulator is
    trained on first impacts alone."""


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
            # What is given in [impact] or [site] is kept, so that the checks can compare the two and refuse a
            # contradiction.
            parts[part] = {key: value, **parts[part]}
    if any(delivery.get(key) is not None for key in ("states", "release")):
        # The schema requires both keys, which follow from the flight to the ground.
        parts["impact"] = {"speed": None, "incidence_deg": None, **parts["impact"]}
        parts["site"] = {"heading_deg": ANY_HEADING, **parts["site"]}
    return {**tables, **parts}


def journey_tables(tables: Mapping[str, Any]) -> Mapping[str, Any]:
    """The tables of a study with what follows from how far landers are followed; all else is left for the checks."""
    journey = tables.get("journey")
    if not isinstance(journey, Mapping):
        return tables
    is_first, design, contact = journey.get("touchdowns") == 1, tables.get("design", {}), tables.get("contact", {})
    is_local = not isinstance(contact, Mapping) or contact.get("stepping", "local") == "local"
    has_landers = not isinstance(design, Mapping) or design.get("run_count") != 0
    filled: dict[str, dict[str, Any]] = {
        "contact": {} if is_local else {"held_speed": 0.0},
        "journey": {"hop_height": 0.0, "emulated_count": 0} if is_first else {"emulated_count": EMULATED_LANDERS},
        "design": {} if journey.get("count") is None else {"run_count": journey["count"]},
        "monte_carlo": {"sample_count": FIRST_TOUCHDOWN_SAMPLES if is_first or not has_landers else 0},
    }
    if {**filled["journey"], **journey}.get("hop_height") == 0.0:
        filled["landing"] = {"time_limit": FIRST_TOUCHDOWN_TIME}
    given = {name: tables.get(name, {}) for name in filled}
    merged = {name: {**filled[name], **part} for name, part in given.items() if isinstance(part, Mapping)}
    return {**tables, **merged}
