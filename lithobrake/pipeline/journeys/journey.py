"""One journey: what it has in common with all, where the lander is, its next touchdown, and how it ended."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.campaign import Record, RunStatus
from lithobrake.files.reading import hashed_seed
from lithobrake.geometry.attitude import attitude_of, from_frame, spin_of
from lithobrake.pipeline.design import arrivals
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.lander_attitude import side_down
from lithobrake.pipeline.design.soils import Soils, felt
from lithobrake.pipeline.site import Site
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd, TouchdownOutcome
from lithobrake.vocabulary.quantities import (
    IMPACT_AZIMUTH,
    IMPACT_INCIDENCE,
    IMPACT_SPEED,
    PLACE,
    SOIL,
    TIME_LEFT,
    VELOCITY_OUT,
)

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

    from lithobrake.smallbody import Body, Flights, Shape

# Steps toward the nearest ground: each leaves at most the sine of the angle between two facets of the way.
PROJECTIONS = 8
Row = dict[str, float]
# Of one journey; more would be a lander that moves along for ever.
MOST_TOUCHDOWNS = 1000
# What ends a journey with its flight.
ENDS = {
    FlightStatus.ESCAPED: JourneyEnd.ESCAPED,
    FlightStatus.PARTNER: JourneyEnd.PARTNER,
    FlightStatus.FLYING: JourneyEnd.UNDER_WAY,
}


# Compared by identity, as the design.
@dataclass(frozen=True, eq=False)
class JourneyModel:
    design: DrawnDesign

    @property
    def site(self) -> Site:
        """Where the study lands."""
        return self.design.site

    @cached_property
    def body(self) -> "Body":
        return self.site.body

    @property
    def seed(self) -> int:
        return self.design.study.seed

    @property
    def duration(self) -> float:
        """Longest journey [s]."""
        assert self.design.study.journey is not None
        return self.design.study.journey.duration

    @property
    def is_ball(self) -> bool:
        return self.design.study.lander.is_ball

    def inertia(self, row: Mapping[str, float]) -> np.ndarray:
        """Inertia of the lander of a journey about its centre of mass [kg m2], [3, 3]."""
        return arrivals.lander_inertia(self.design.study, row)

    def place(self, x: float, y: float, row: Mapping[str, float]) -> tuple[float, float]:
        """Where on its bed a lander comes down [m], of two uniform numbers; always at one place without a region."""
        if self.design.region is None:
            return row[PLACE[0]], row[PLACE[1]]
        (west, east), (south, north) = self.design.region
        return west + x * (east - west), south + y * (north - south)

    @cached_property
    def soils(self) -> Soils:
        return Soils(self.site)

    def soil(self, journey: int, place: np.ndarray) -> dict[str, float]:
        """The numbers of the grains that a lander meets at a place [m], [3], by dotted key; none where no region has a
        soil of its own, and all ground is what the lander met first.
        """
        if not self.design.study.soil:
            return {}
        own = self.design.own_soil(journey)
        (met,) = self.soils.on_soil([own | {"journey": float(journey)}], place[None])
        return {key: met[key] for key in own}

    def soil_column(self, place: np.ndarray) -> dict[str, str]:
        """The region of a touchdown at a place [m], [3], as its table has it; nothing where there are no regions."""
        return dict(zip(SOIL, self.soils.at(place[None]), strict=True)) if self.design.study.soil else {}

    def fly(
        self, position: np.ndarray, velocity: np.ndarray, left: float, start: float, mass: float, spin_period: float
    ) -> "Flights":
        """Fly one lander to its next impact, for at most `left` [s]."""
        from lithobrake.smallbody import fly

        return fly(
            self.body, position, velocity, left, gravity=self.design.study.flight.gravity, start_time=start,
            # One flight has nothing to share among threads, and starting them would take longer.
            mass=np.array([mass]), spin_period=np.array([spin_period]), threads=1,
        )  # fmt: skip


def on_ground(shape: "Shape", point: np.ndarray) -> np.ndarray:
    """The place on the ground [m], [3], nearest to a point beside it."""
    place = point
    for _ in range(PROJECTIONS):
        height, facet = shape.nearest(place)
        place = place - height * shape.normals[facet]
    if shape.height(place) >= 0.0:
        return place
    # Below the ground no flight begins: a point next to an edge, of which the outermost along the radius is taken.
    return shape.surface_point(*shape.latitude_longitude(point))


@dataclass
class Journey:
    """A lander under way; every place and vector is fixed to the body.

    row: inputs of its present touchdown. origin [m] and axes, in rows, of the frame of that; time [s]: at its
    beginning, since the first; clock [s]: when the first began, as of the partner. path_length [m], contacts: so far;
    touchdowns, flights: rows of their tables, by column. end: how it ended, None while it is under way; reason: why it
    failed; lies: side and tilt of a lander at rest, and attitude, that of its axes against the body's; descent: row of
    the flight to its first touchdown, if it was flown there.
    """

    model: "JourneyModel"
    number: int
    row: Row
    origin: np.ndarray
    axes: np.ndarray
    clock: float
    mass: float
    spin_period: float
    time: float = 0.0
    path_length: float = 0.0
    contacts: int = 0
    touchdowns: list[dict[str, Any]] = field(default_factory=list)
    flights: list[dict[str, Any]] = field(default_factory=list)
    end: JourneyEnd | None = None
    reason: str = ""
    lies: tuple[str, float] | None = None
    attitude: "Rotation | None" = None
    descent: dict[str, Any] | None = None

    def go_on(self, record: Record) -> Row | None:
        """Take in how the present touchdown ended; give the inputs of the next one, or None where there is none."""
        outputs = record.outputs
        began, place = self.time, self.origin
        if record.status == RunStatus.FAILED:
            self.end, self.reason = JourneyEnd.FAILED, record.reason or ""
        else:
            self._move(outputs)
        self.touchdowns.append(self._touchdown(record, began, place))
        if self.end is None:
            self._after(str(record.outcome), outputs)
        return self.row if self.end is None else None

    def _after(self, outcome: str, outputs: Mapping[str, float]) -> None:
        if outcome == TouchdownOutcome.CLEAR:
            self._fly(outputs)
        elif outcome == TouchdownOutcome.CAPTURED:
            self.end = JourneyEnd.AT_REST
            if not self.model.is_ball:
                self.attitude = from_frame(self.axes) * attitude_of(outputs)
                self.lies = side_down(self.attitude, self._felt())
        elif outcome == TouchdownOutcome.TIME_LIMIT:
            self.end = JourneyEnd.UNDER_WAY
        else:
            self.end, self.reason = JourneyEnd.FAILED, f"a touchdown ended as {outcome}"

    def _move(self, outputs: Mapping[str, float]) -> None:
        along, aside = outputs.get("displacement_x", 0.0), outputs.get("displacement_y", 0.0)
        # A program of the user's own may give the duration of the contact alone.
        self.time += outputs.get("duration", outputs.get("contact_duration", 0.0))
        self.path_length += math.hypot(along, aside)
        self.contacts += max(1, round(outputs.get("contacts", 1.0)))
        moved = self.origin + along * self.axes[0] + aside * self.axes[1]
        self.origin = on_ground(self.model.body.shape, moved)

    @property
    def is_on_ground(self) -> bool:
        # A flight without a touchdown behind it has ended aloft or on the partner.
        return len(self.touchdowns) > len(self.flights)

    def _felt(self) -> np.ndarray:
        """Acceleration of what rests where the lander is [m/s2]."""
        here = (np.array([value]) for value in (self.clock + self.time, self.mass, self.spin_period))
        found: np.ndarray = felt(self.model.body, self.origin[None], *here)[0]
        return found

    def _fly(self, outputs: Mapping[str, float]) -> None:
        left = self.model.duration - self.time
        if left <= 0.0 or len(self.touchdowns) == MOST_TOUCHDOWNS:
            self.end = JourneyEnd.UNDER_WAY
            return
        velocity = np.array([outputs[name] for name in VELOCITY_OUT]) @ self.axes
        flight = self.model.fly(self.origin, velocity, left, self.clock + self.time, self.mass, self.spin_period)
        attitude, spin = self._tumbled(outputs, float(flight.time[0]))
        self._note_flight(velocity, float(flight.time[0]))
        self.path_length += float(np.linalg.norm(flight.position[0] - self.origin))
        self.time += float(flight.time[0])
        self.end = ENDS.get(FlightStatus(str(flight.status[0])))
        self.origin = flight.position[0]
        if self.end is None:
            self._arrive(flight, attitude, spin)

    def _tumbled(self, outputs: Mapping[str, float], time: float) -> "tuple[Rotation, np.ndarray]":
        """Attitude and spin [rad/s], against the ground, at the end of a flight, both fixed to the body."""
        from lithobrake.smallbody.rotation import ground_spin

        ground, start = self.model.body.rotation, self.clock + self.time
        (turning,) = ground_spin(ground, np.array([start]), np.array([self.spin_period]))
        attitude = from_frame(self.axes) * attitude_of(outputs)
        # A touchdown gives the spin against the ground, and torque-free rotation is that against axes that do not turn.
        spin = spin_of(outputs) @ self.axes + turning
        inertia = self.model.inertia(self.row)
        return arrivals.turned_in_flight(inertia, attitude, spin, self.spin_period, time, ground=ground, start=start)

    def _arrive(self, flight: "Flights", attitude: "Rotation", spin: np.ndarray) -> None:
        """Prepare the touchdown at the end of a flight: a fresh place of the journey's bed, and a fresh direction."""
        number = len(self.touchdowns)
        # The numbers of a touchdown follow from journey and touchdown, so more journeys change none.
        random = np.random.default_rng(hashed_seed(self.model.seed, "touchdowns", self.number, number))
        # Five in every study: where the ground is flat or the place is given the others stay the same.
        x, y, turn, *gradient = random.random(5).tolist()
        incidence = self._meet_ground(flight, gradient)
        azimuth = 360.0 * turn
        self.row = {**self.row, **self.model.soil(self.number, self.origin)}
        arrival = {
            "touchdown": float(number),
            TIME_LEFT: self.model.duration - self.time,
            **arrivals.impact_inputs(float(flight.impact_speed[0]), incidence),
            IMPACT_AZIMUTH: azimuth,
            **arrivals.attitude_inputs(self.axes, azimuth, attitude, spin),
            **dict(zip(PLACE, self.model.place(x, y, self.row), strict=True)),
            **arrivals.ground_inputs(self.axes @ self._felt(), azimuth, arrivals.friction_of(self.row)),
        }
        if arrivals.MEAN_INCIDENCE in self.row:
            arrival[arrivals.MEAN_INCIDENCE] = math.degrees(float(flight.incidence[0]))
        self.row = {**self.row, **arrival}

    def _meet_ground(self, flight: "Flights", gradient: list[float]) -> float:
        """Lay the frame of the next touchdown, by two uniform numbers; gives the incidence in it [rad]."""
        study, up = self.model.design.study, self.model.body.shape.normals[flight.facet]
        axes, incidence = arrivals.met_ground(
            study, flight.velocity, up, flight.incidence, lambda: np.array([gradient])
        )
        self.axes = axes[0]
        return float(incidence[0])

    def _note_flight(self, velocity: np.ndarray, time: float) -> None:
        begin = self.time
        own = self.mass, self.spin_period
        self.flights.append(
            flight_row(self.number, begin, begin + time, self.clock + begin, self.origin, velocity, *own)
        )

    def _touchdown(self, record: Record, began: float, place: np.ndarray) -> dict[str, Any]:
        latitude, longitude = (float(one) for one in self.model.body.shape.latitude_longitude(place))
        return {
            "journey": self.number,
            "touchdown": len(self.touchdowns),
            "key": record.key,
            "outcome": record.outcome or RunStatus.FAILED.value,
            "begin_s": began,
            "end_s": self.time,
            "latitude_deg": latitude,
            "longitude_deg": longitude,
            **{f"position_{axis}": float(value) for axis, value in zip("xyz", place, strict=True)},
            **{f"velocity_{axis}": float(value) for axis, value in zip("xyz", self._incoming(), strict=True)},
            **self.model.soil_column(place),
        }

    def _incoming(self) -> np.ndarray:
        """Velocity of the present impact against the ground [m/s], fixed to the body."""
        incidence = math.radians(self.row[IMPACT_INCIDENCE])
        along, down = self.row[IMPACT_SPEED] * math.sin(incidence), self.row[IMPACT_SPEED] * math.cos(incidence)
        incoming: np.ndarray = along * self.axes[0] - down * self.axes[2]
        return incoming


def flight_row(
    journey: int,
    begin: float,
    end: float,
    clock: float,
    position: np.ndarray,
    velocity: np.ndarray,
    mass: float,
    spin_period: float,
) -> dict[str, Any]:
    """A row of the table of flights but for its number, by column; times [s], the state at its beginning."""
    return {
        "sample": journey,
        "begin_s": begin,
        "end_s": end,
        "clock_s": clock,
        **{f"position_{axis}": float(value) for axis, value in zip("xyz", position, strict=True)},
        **{f"velocity_{axis}": float(value) for axis, value in zip("xyz", velocity, strict=True)},
        "site_mass": mass,
        "site_spin_period": spin_period,
    }
