"""Landers that are followed from touchdown to touchdown: where they are, how they fly, and how they end."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.geometry.attitude import from_frame
from lithobrake.smallbody.grounds import LANDED, Moments
from lithobrake.smallbody.lander_states import LanderStates
from lithobrake.smallbody.touchdown import FAILED, Answers, ImpactStates, Touchdown, into_frame, out_of_frame
from lithobrake.vocabulary.array_types import Array, Integers
from lithobrake.vocabulary.outcomes import RESTS, FlightStatus, JourneyEnd, TouchdownOutcome
from lithobrake.vocabulary.quantities import UNKNOWN_END

if TYPE_CHECKING:
    from lithobrake.smallbody.flight_results import Flights
    from lithobrake.smallbody.shape import Shape

# Steps toward the nearest ground: each leaves at most the sine of the angle between two facets of the way.
PROJECTIONS = 8
# How a lander ends by its touchdown; one that leaves flies on.
AFTER = {
    TouchdownOutcome.CLEAR: "",
    TouchdownOutcome.CAPTURED: JourneyEnd.AT_REST,
    TouchdownOutcome.TIME_LIMIT: JourneyEnd.UNDER_WAY,
    TouchdownOutcome.LEFT_SIDEWAYS: JourneyEnd.FAILED,
    FAILED: JourneyEnd.FAILED,
    UNKNOWN_END: UNKNOWN_END,
}
# The same by its flight, where that does not end on ground on which landers are followed.
ENDS = {
    FlightStatus.ESCAPED: JourneyEnd.ESCAPED,
    FlightStatus.PARTNER: JourneyEnd.PARTNER,
    FlightStatus.FLYING: JourneyEnd.UNDER_WAY,
}


def on_ground(shape: "Shape", points: Array) -> Array:
    """The places on the ground [m], [count, 3], nearest to points beside it."""
    places = points
    for _ in range(PROJECTIONS):
        height, facet = shape.nearest(places)
        places = places - height[:, None] * shape.normals[facet]
    # Below the ground no flight begins: a point next to an edge, of which the outermost along the radius is taken.
    below = ~(shape.height(places) >= 0.0)
    if below.any():
        places[below] = shape.surface_point(*shape.latitude_longitude(points[below]))
    return places


@dataclass(kw_only=True)
class Landers(LanderStates):
    """LanderStates that are followed from touchdown to touchdown."""

    def impacts(self, which: Integers) -> ImpactStates:
        """The impacts of some landers that are under way."""
        mass, period = np.empty(len(which)), np.empty(len(which))
        for ground, there in self.on_each(which):
            mass[there], period[there] = ground.own(self.moments(which[there]))
        return ImpactStates(
            lander=which,
            number=self.touchdowns[which],
            ground=self.ground[which],
            position=self.position[which],
            axes=self.axes[which],
            speed=self.speed[which],
            incidence_deg=self.incidence_deg[which],
            mean_incidence_deg=self.mean_incidence_deg[which],
            spin=self.spin[which],
            attitude=[self.attitude[one] for one in which.tolist()],
            acceleration=into_frame(self.axes[which], self.acceleration(which)),
            rotation=into_frame(self.axes[which], self.ground_spin(which)),
            time=self.time[which],
            left=self.duration - self.time[which],
            clock=self.clock(which),
            mass=mass,
            spin_period=period,
        )

    def go_on(self, which: Integers, answers: Answers) -> "Flights | None":
        """End the touchdowns of some landers, and fly those that leave to their next impacts.

        Returns the flights, in the order of the landers; None where none flies.
        """
        self._end_touchdowns(which, answers)
        flies = (answers.outcome == TouchdownOutcome.CLEAR) & (self.end[which] == "")
        if not flies.any():
            return None
        going, axes = which[flies], self.axes[which[flies]]
        velocity, spin = out_of_frame(axes, answers.velocity[flies]), out_of_frame(axes, answers.spin[flies])
        attitudes = [answers.attitude[one] for one in np.flatnonzero(flies).tolist()]
        for lander, frame, attitude in zip(going.tolist(), axes, attitudes, strict=True):
            self.attitude[lander] = None if attitude is None else from_frame(frame) * attitude
        place, velocity = self._leaving(going, answers.rise[flies], velocity)
        spin = self._among_stars(going, spin)
        flights = self._flown(going, place, velocity)
        hits = np.flatnonzero(self.is_down[going])
        self._arrive(going[hits], flights, hits, spin[hits])
        return flights

    def _end_touchdowns(self, which: Integers, answers: Answers) -> None:
        self.touchdowns[which] += 1
        self.contacts[which] += answers.contacts
        self.time[which] += answers.duration
        self.contact_time[which] += answers.duration
        self.path_length[which] += answers.length
        self.contact_length[which] += answers.length
        self.position[which] += out_of_frame(self.axes[which], answers.way)
        moved = which[answers.way.any(axis=1)]
        for ground, there in self.on_each(moved):
            self.position[moved[there]] = on_ground(ground.body.shape, self.position[moved[there]])
        self.end[which] = [str(AFTER[word]) for word in answers.outcome.tolist()]
        self.end[which[(self.ground[which] > 0) & (self.end[which] == JourneyEnd.AT_REST)]] = JourneyEnd.PARTNER
        over = (self.time[which] >= self.duration) | (self.touchdowns[which] >= self.most)
        self.end[which[over & (self.end[which] == "")]] = JourneyEnd.UNDER_WAY
        for place, lander in enumerate(which.tolist()):
            word, attitude = str(answers.outcome[place]), answers.attitude[place]
            if self.end[lander] == JourneyEnd.FAILED:
                self.reason[lander] = answers.reason[place] if word == FAILED else f"a touchdown ended as {word}"
            elif self.end[lander] in RESTS and attitude is not None:
                self.attitude[lander] = from_frame(self.axes[lander]) * attitude

    def _leaving(self, going: Integers, rise: Array, velocity: Array) -> tuple[Array, Array]:
        """Places [m] and velocities [m/s] with which flights begin, [count, 3], fixed to the ground.

        A touchdown takes the lander for a point on the ground, from which its centre of mass has risen [m], [count]. A
        flight begins as far above the ground. It cannot begin below: what has sunk starts on it, and has paid for the
        way up.
        """
        place = self.position[going]
        if not rise.any():
            return place, velocity
        up = np.empty_like(place)
        for ground, there in self.on_each(going):
            shape = ground.body.shape
            up[there] = shape.normals[shape.nearest(place[there])[1]]
        outward, upward = (np.einsum("ni,ni->n", one, up) for one in (self.acceleration(going), velocity))
        paid = np.sqrt(np.maximum(upward**2 + 2.0 * -outward * np.minimum(rise, 0.0), 0.0))
        change = np.where((rise < 0.0) & (upward > 0.0), paid - upward, 0.0)
        return place + np.maximum(rise, 0.0)[:, None] * up, velocity + change[:, None] * up

    def _among_stars(self, going: Integers, spin: Array) -> Array:
        """Spins against the stars [rad/s] along the axes of flights, [count, 3], from those against the ground.

        Turns attitudes into these axes.
        """
        spin, when = spin + self.ground_spin(going), self.moments(going)
        for ground, there in self.on_each(going):
            turns = ground.turns(when.at(there))
            if turns is not None:
                spin[there] = out_of_frame(turns, spin[there])
                self.turn_attitudes(going[there], turns.transpose(0, 2, 1))
        return spin

    def _flown(self, going: Integers, place: Array, velocity: Array) -> "Flights":
        """Fly landers from places [m] and velocities [m/s] on the ground to their next impact, as long as they have."""
        from lithobrake.smallbody.flight import fly

        start, speed, when = np.empty_like(place), np.empty_like(velocity), self.moments(going)
        for ground, there in self.on_each(going):
            start[there], speed[there] = ground.states_of_flights(place[there], velocity[there], when.at(there))
        flights = fly(
            *(self.body, start, speed, self.duration - self.time[going]),
            gravity=self.gravity,
            start_time=when.time,
            mass=when.mass,
            spin_period=when.spin_period,
            # One flight has nothing to share among threads, and starting them would take longer.
            threads=1 if len(going) == 1 else self.threads,
        )
        self._end_flights(going, flights, place)
        return flights

    def _end_flights(self, going: Integers, flights: "Flights", place: Array) -> None:
        """Put landers where their flights have ended, which began at these places on the ground [m]."""
        before, landed = self.ground[going], LANDED[: len(self.grounds)]
        self.is_down[going] = np.isin(flights.status, landed)
        self.ground[going] = np.where(self.is_down[going] & (flights.status == FlightStatus.PARTNER), 1, 0)
        self.position[going] = np.where(self.is_down[going, None], flights.on_ground[0], flights.position)
        # On the ground that it has left a lander has come as far as that says; else along the axes of flights.
        stays = (self.ground[going] == before)[:, None]
        ways = np.where(stays, self.position[going] - place, flights.position - flights.start.position)
        # The norms of single rows: that of an array rounds otherwise.
        self.path_length[going] += [float(np.linalg.norm(way)) for way in ways]
        self.time[going] += flights.time
        self.end[going] = ["" if word in landed else str(ENDS[FlightStatus(word)]) for word in flights.status.tolist()]

    def _arrive(self, down: Integers, flights: "Flights", hits: Integers, spin: Array) -> None:
        """Landers at the ends of their flights: the ground that they meet, and how they turn.

        hits: places of theirs among the flights; spin: at the start of these against the stars [rad/s], [count, 3],
        along their axes.
        """
        start, time, period = (one[hits] for one in (flights.start.time, flights.time, flights.start.spin_period))
        self._meet_ground(down, flights, hits)
        spin, when = self._turned(down, spin, start, time, period), Moments(start + time, self.mass[down], period)
        for ground, there in self.on_each(down):
            turns = ground.turns(when.at(there))
            if turns is not None:
                spin[there] = into_frame(turns, spin[there])
                self.turn_attitudes(down[there], turns)
        self.spin[down] = spin - self.ground_spin(down, when)

    def _meet_ground(self, down: Integers, flights: "Flights", hits: Integers) -> None:
        """Lay the frames of the next touchdowns."""
        velocity, incidence = flights.on_ground[1][hits], flights.incidence[hits]
        self.axes[down], met = self.ground_met(down, velocity, flights.normals[hits], incidence)
        self.speed[down] = flights.impact_speed[hits]
        self.incidence_deg[down], self.mean_incidence_deg[down] = np.degrees(met), np.degrees(incidence)

    def ground_met(self, down: Integers, velocity: Array, up: Array, incidence: Array) -> tuple[Array, Array]:
        """Axes in rows, [count, 3, 3], and incidences [rad] on the ground that landers meet: here the facets.

        velocity [m/s], and up, the normals of the facets, [count, 3]; incidence: against these [rad], [count].
        """
        from lithobrake.smallbody.bounce import impact_frame

        return impact_frame(velocity, up), incidence

    def _turned(self, down: Integers, spin: Array, start: Array, time: Array, period: Array) -> Array:
        """Spins after flights [rad/s], [count, 3], against axes that do not turn, from those before; turns attitudes.

        A lander whose attitude is not known keeps its spin, as a ball does: how it tumbles is in the scatter of what
        answers its touchdowns.
        """
        from lithobrake.smallbody.rotation import kept_among_stars
        from lithobrake.smallbody.tumbling import turned_freely

        ground = self.body.rotation
        after = kept_among_stars(ground, spin, start, time, period)
        for place, lander in enumerate(down.tolist()):
            attitude = self.attitude[lander]
            if attitude is not None:
                self.attitude[lander], after[place] = turned_freely(
                    *(self.inertia(lander), attitude, spin[place], float(period[place]), float(time[place])),
                    ground=ground,
                    start=float(start[place]),
                )
        return after


def follow(landers: Landers, touchdown: Touchdown, show: Callable[[int], None] | None = None) -> Landers:
    """Follow landers from touchdown to touchdown until each has ended, all of them together; gives them back.

    touchdown: says how each touchdown ends; show: called with the number of landers that have ended.
    """
    while len(going := landers.going):
        if show:
            show(len(landers) - len(going))
        landers.go_on(going, touchdown.answers(landers.impacts(going)))
    return landers
