"""Landers on their way to their first touchdown, from states of another tool or from where they are released."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

from lithobrake.geometry.attitude import directions
from lithobrake.pipeline.design import arrivals
from lithobrake.pipeline.design.descent_checks import refuse_below, refuse_fast, refuse_spinning
from lithobrake.pipeline.design.released_states import released_states, with_offsets
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.site import Site
from lithobrake.study import Study
from lithobrake.study.delivered_states import states_of
from lithobrake.study.delivery_sections import SIDE
from lithobrake.study.state_paths import DeliveredStates
from lithobrake.vocabulary.known_bodies import printed_name
from lithobrake.vocabulary.number_words import QUANTILES, duration, out_of, span_of
from lithobrake.vocabulary.outcomes import FlightStatus
from lithobrake.vocabulary.quantities import IMPACT_AZIMUTH, Row

if TYPE_CHECKING:
    from lithobrake.smallbody import Flights
    from lithobrake.smallbody.grounds import Moments

# Coordinates of the sequence of a study beside the others.
RELEASE = tuple(f"release {number}" for number in range(1, SIDE + 1))
WORDS = {FlightStatus.ESCAPED: "escape", FlightStatus.PARTNER: "hit the planet"}


@dataclass(frozen=True, eq=False)
class Descents:
    """Flights of the landers of a study to the ground, one row a journey from `first` on.

    flights         in axes fixed to the body; their start time is that of the partner's motion and the body's rotation
    axes            of the first touchdown, in rows, [count, 3, 3], x along the incoming horizontal velocity, z along
                    the normal of the ground that is met; of those that touch down
    incidence       on the ground that is met [rad], [count]
    attitude, spin  at the start, fixed to the body, of a lander whose states have them: [count, 4] as w, x, y, z, and
                    against axes that do not turn [rad/s], [count, 3]; else None
    """

    site: Site
    first: int
    flights: "Flights"
    axes: np.ndarray
    incidence: np.ndarray
    attitude: Rotation | None
    spin: np.ndarray | None

    @classmethod
    def flown(cls, site: Site, first: int, uniforms: np.ndarray) -> "Descents":
        """Fly the journeys from `first` on, each with six uniform numbers [count, 6], which a release draws by.

        Raises StudyError for states below the ground, and landers too fast for any contact.
        """
        from lithobrake.smallbody import fly

        study, count = site.study, len(uniforms)
        columns = {key: values[first:] for key, values in site.sampled(first + count).items()}
        states = _states(site, first, uniforms)
        into_body = _into_body(study, states.time, columns["spin_period"])
        position, velocity = arrivals.turned(into_body, states.position), arrivals.turned(into_body, states.velocity)
        if _is_icrf(study):
            velocity = arrivals.against_ground(position, velocity, columns["spin_period"])
        clock, uniform = site.clock(columns), position
        if (ground := site.body.rotation) is None:
            clock = clock + states.time
        else:
            # The partner stands still: when a lander is released counts for nothing but in the rotation.
            here = ground.at(clock)
            position, velocity = here.states_out_of_frame(position, velocity)
            into_body = here.axes.transpose(0, 2, 1) @ into_body
        refuse_below(site, position, uniform, clock, columns, states.source)
        flights = fly(
            *(site.body, position, velocity, study.journey.duration),
            gravity=study.flight.gravity,
            start_time=clock,
            mass=columns["mass"],
            spin_period=columns["spin_period"],
        )
        down = _landed(flights)
        axes, incidence = _met_ground(study, flights, down, first)
        falling = [states.source[row] for row in np.flatnonzero(down).tolist()]
        fastest = refuse_fast(study, flights.impact_speed[down], falling)
        if states.rates is not None:
            refuse_spinning(study, states.rates, fastest, states.source)
        attitude, spin = _turning(states, into_body)
        return cls(site, first, flights, axes, incidence, attitude, spin)

    @property
    def touches_down(self) -> np.ndarray:
        """Which landers reach the ground of the body or of its partner, [count]."""
        return _landed(self.flights)

    @property
    def ground(self) -> np.ndarray:
        """Which ground each reaches, [count]: 0 that of the body, 1 that of its partner; 0 of what reaches none."""
        found: np.ndarray = (self.touches_down & (self.flights.status == FlightStatus.PARTNER)).astype(np.int64)
        return found

    @property
    def reach(self) -> float:
        """The fraction of the landers that reach the ground of the body of the site."""
        return float((self.touches_down & (self.ground == 0)).mean())

    @property
    def position(self) -> np.ndarray:
        """Where flights end [m], [count, 3], fixed to the body that each reaches."""
        return np.where(self.touches_down[:, None], self.flights.on_ground[0], self.flights.position)

    @property
    def clock(self) -> np.ndarray:
        """When each flight ends, in the time of the partner's motion [s], [count]."""
        end: np.ndarray = self.flights.start.time + self.flights.time
        return end

    def first_touchdowns(self, rows: Sequence[Row]) -> list[Row]:
        """Rows of all journeys as the first touchdowns of those that reach the ground, with what the flight tells."""
        from lithobrake.smallbody.grounds import grounds_of

        flights, down = self.flights, np.flatnonzero(self.touches_down)
        found: list[Row] = []
        for lander in down.tolist():
            row = rows[lander] | self._impact(lander)
            found.append(row | self._attitude(lander, row))
        for number, ground in enumerate(grounds_of(flights.body)):
            there = np.flatnonzero(self.ground[down] == number)
            if len(there):
                landers, rows = down[there], [found[row] for row in there.tolist()]
                states = self.position[landers], self.axes[landers], self._moments(landers)
                # Regions with a soil of their own are those of the body of the site.
                rows = rows if number else Soils(self.site).on_soil(rows, self.position[landers])
                for place, met in zip(there.tolist(), arrivals.on_ground(ground, rows, *states), strict=True):
                    found[place] = met
        return found

    def _moments(self, landers: np.ndarray) -> "Moments":
        """The ends of the flights of some landers."""
        from lithobrake.smallbody.grounds import Moments

        start = self.flights.start
        return Moments(self.clock[landers], start.mass[landers], start.spin_period[landers])

    def _impact(self, lander: int) -> Row:
        met = arrivals.impact_inputs(float(self.flights.impact_speed[lander]), float(self.incidence[lander]))
        if not self.site.study.site.roughness_deg:
            return met
        return met | {arrivals.MEAN_INCIDENCE: np.degrees(float(self.flights.incidence[lander]))}

    def _attitude(self, lander: int, row: Row) -> Row:
        if self.attitude is None or self.spin is None:
            return {}
        period, time = float(self.flights.start.spin_period[lander]), float(self.flights.time[lander])
        inertia = arrivals.lander_inertia(self.site.study, row)
        ground, start = self.flights.body.rotation, float(self.flights.start.time[lander])
        attitude, spin = arrivals.turned_in_flight(
            *(inertia, self.attitude[lander], self.spin[lander], period, time), ground=ground, start=start
        )
        if self.ground[lander]:
            attitude, spin = self._onto_partner(lander, attitude, spin)
        return arrivals.attitude_inputs(self.axes[lander], row[IMPACT_AZIMUTH], attitude, spin)

    def _onto_partner(self, lander: int, attitude: Rotation, spin: np.ndarray) -> tuple[Rotation, np.ndarray]:
        """Attitude and spin [rad/s] of a lander against the ground of the partner, from those against the body's."""
        from lithobrake.smallbody.grounds import grounds_of

        own, partner = grounds_of(self.flights.body)
        when = self._moments(np.array([lander]))
        turns = partner.turns(when)
        assert turns is not None
        whole = turns[0] @ (spin + own.spin(when)[0])
        return Rotation.from_matrix(turns[0]) * attitude, whole - partner.spin(when)[0]


def _landed(flights: "Flights") -> np.ndarray:
    """Which flights end on ground on which landers are followed, [count]."""
    from lithobrake.smallbody.grounds import LANDED, grounds_of

    return np.isin(flights.status, LANDED[: len(grounds_of(flights.body))])


def _met_ground(study: Study, flights: "Flights", down: np.ndarray, first: int) -> tuple[np.ndarray, np.ndarray]:
    """Axes and incidences of the first touchdowns of the landers that are down; axes of the others: the body's."""
    axes, incidence = np.tile(np.eye(3), (len(flights), 1, 1)), np.array(flights.incidence)
    journeys = (first + np.flatnonzero(down)).tolist()
    met = flights.on_ground[1][down], flights.normals[down], incidence[down]
    axes[down], incidence[down] = arrivals.met_ground(study, *met, lambda: arrivals.first_uniforms(study, journeys))
    return axes, incidence


def _is_icrf(study: Study) -> bool:
    return study.delivery is not None and study.delivery.frame == "icrf"


def _into_body(study: Study, time: np.ndarray, spin_period: np.ndarray) -> np.ndarray:
    """Rotations from the axes of the states into those of the body, [count, 3, 3]."""
    if _is_icrf(study):
        return arrivals.icrf_to_body(study.site, time, spin_period)
    return np.tile(np.eye(3), (len(time), 1, 1))


def _states(site: Site, first: int, uniforms: np.ndarray) -> DeliveredStates:
    study, delivery = site.study, site.study.delivery
    assert delivery is not None
    pole = _into_body(study, np.zeros(1), np.full(1, site.medians["spin_period"]))[0, 2]
    if delivery.release is None:
        return with_offsets(delivery, states_of(study).rows(first, len(uniforms)), pole)
    return with_offsets(delivery, released_states(delivery.release, uniforms, first, pole), pole)


def _turning(states: DeliveredStates, into_body: np.ndarray) -> tuple[Rotation | None, np.ndarray | None]:
    """Attitudes and spins at the start, fixed to the body."""
    if states.attitude is None or states.rates is None:
        return None, None
    # The scalar stands first in the file and last in SciPy.
    given = Rotation.from_quat(np.roll(states.attitude, -1, axis=1))
    return Rotation.from_matrix(into_body) * given, arrivals.turned(into_body, given.apply(states.rates))


def descents_in_words(descents: Descents) -> str:
    """Return how many landers reach the ground, when, how fast and where; and what the others do."""
    flights, down = descents.flights, descents.touches_down
    others = Counter(flights.status[~down].tolist())
    said = f"Delivery: {out_of(int(down.sum()), len(flights), 'landers')} reach the ground"
    if down.any():
        speed, time = 100.0 * flights.impact_speed[down], flights.time[down]
        said += (
            f", {duration(time.min())} to {duration(time.max())} after their state, at "
            f"{span_of((speed.min(), speed.max()))} cm/s"
        )
    there = int(descents.ground.sum())
    said += f", {there} of them on {printed_name(descents.site.ground_names[1])}" if there else ""
    ends = [f"{number} {WORDS.get(FlightStatus(one), 'still fly')}" for one, number in others.items()]
    return "; ".join([said, *ends]) + "." + (_places(descents) if (down & (descents.ground == 0)).any() else "")


def _places(descents: Descents) -> str:
    """Where the first touchdowns lie about the aim point, whose distance is an arc of the radius there."""
    site, places = descents.site, descents.position[descents.touches_down & (descents.ground == 0)]
    near, middle, far = np.quantile(site.ways_from_aim(places), QUANTILES)
    shape = site.body.shape
    latitude, longitude = shape.latitude_longitude(directions(*shape.latitude_longitude(places)).mean(axis=0))
    return (
        f" First touchdowns lie {middle:.3g} m from the aim point in the median (5th to 95th percentile {near:.3g} to "
        f"{far:.3g} m), about latitude {latitude:.1f} deg, longitude {longitude:.1f} deg; the aim point is at "
        f"{site.aim[0]:.1f}, {site.aim[1]:.1f}."
    )
