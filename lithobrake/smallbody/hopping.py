"""From bounce to bounce until a lander rests, escapes, or the time is over."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.smallbody.body import Body
from lithobrake.smallbody.bounce import Bounce, Impacts
from lithobrake.smallbody.facet_grid import near_heights
from lithobrake.smallbody.flight import fly
from lithobrake.smallbody.flight_results import Arcs, Flights
from lithobrake.smallbody.rotation import ground_spin, kept_among_stars
from lithobrake.smallbody.sliding import OnGround, slide
from lithobrake.vocabulary.given_numbers import numbers, whole_number
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus

GRAZE = 1e-5  # cosine of the incidence below which a lander does not hit the ground but slides along it


@dataclass(frozen=True)
class Journeys:
    """Where each lander ended; every array has one entry or row a lander.

    status         words of JourneyStatus
    time           from the start to the end [s]; of a settled lander, to rest
    position       at the end, body-fixed [m], [count, 3]
    latitude       planetocentric [deg], longitude east in (-180, 180] [deg], of that position
    spin           angular velocity at the end, body-fixed axes [rad/s], [count, 3]
    bounce_count   impacts after which the lander went on
    path_length    sum of the straight lines between starts and ends of the flights [m]
    slid_length    way along the ground in contact with it [m], and slid_time: how long it took, part of time [s]
    impact_speed   at the last impact, against the ground [m/s]; nan where there was none
    incidence      there, of the velocity from the inward normal [rad]; nan likewise
    arcs           the flights of the first landers, as many as were asked for
    """

    body: Body
    status: NDArray[np.str_]
    time: NDArray[np.float64]
    position: NDArray[np.float64]
    spin: NDArray[np.float64]
    bounce_count: NDArray[np.int64]
    path_length: NDArray[np.float64]
    slid_length: NDArray[np.float64]
    slid_time: NDArray[np.float64]
    impact_speed: NDArray[np.float64]
    incidence: NDArray[np.float64]
    arcs: Arcs

    @cached_property
    def latitude(self) -> NDArray[np.float64]:
        """Planetocentric latitude at the end [deg]."""
        return self.body.shape.latitude_longitude(self.position)[0]

    @cached_property
    def longitude(self) -> NDArray[np.float64]:
        """East longitude at the end, in (-180, 180] [deg]."""
        return self.body.shape.latitude_longitude(self.position)[1]


@dataclass(frozen=True)
class Launch:
    """How landers start: one row or entry a lander, or one for all.

    position       [m] and velocity [m/s], body-fixed as of `fly`, [count, 3] or [3]
    spin           angular velocity, body-fixed axes, relative to the stars [rad/s], [count, 3] or [3]
    time           of the start [s]: start_time of `fly`
    captured       it does not fly but is captured where it is, and slides on from there
    mass           of the body [kg] and spin_period [s], in place of its own: for a body that is not well known
    """

    position: ArrayLike
    velocity: ArrayLike
    spin: ArrayLike = (0.0, 0.0, 0.0)
    time: ArrayLike = 0.0
    captured: ArrayLike = False
    mass: ArrayLike | None = None
    spin_period: ArrayLike | None = None


def hop(
    body: Body,
    launch: Launch,
    bounce: Bounce,
    duration: float,
    *,
    friction: ArrayLike = np.inf,
    rolls: bool = False,
    gravity: str = "table",
    bounce_limit: int = 1000,
    arc_landers: int = 0,
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Journeys:
    """Fly, bounce and fly again, slide where captured, for at most `duration` [s] in all.

    bounce     called once a round with the impacts of all landers still under way and a generator of random numbers
    friction   of the ground under landers that are captured or come in along it, which slide on until they rest or
               leave the ground again: a coefficient for each or for all; infinite: they rest where they are
    rolls      they roll like balls, and friction is the resistance to that
    gravity    as of `fly`, and so are threads
    arc_landers   how many landers, the first ones, have their flights in Journeys.arcs: bounce_limit + 1 each at most
    seed       of the generator: the same call gives the same result
    progress   called with the fraction of landers that have ended
    """
    seed, bounce_limit = whole_number("seed", seed, 0), whole_number("bounce_limit", bounce_limit, 0)
    state, parts = _State.of(body, launch, duration, friction, rolls), []
    going = state.first_flights(launch.captured)
    for number in range(bounce_limit + 1):
        if number:
            going = going[state.time[going] < duration]
        begin = state.time[going]
        flights = state.fly(going, gravity, threads)
        parts.append(Arcs.of(flights, going, begin, arc_landers))
        hits = flights.status == FlightStatus.IMPACT
        going, facet = going[hits], flights.facet[hits]
        grazes = np.cos(flights.incidence[hits]) < GRAZE
        on = state.slide(going[grazes])
        going, facet = going[~grazes], facet[~grazes]
        if number < bounce_limit:
            random = np.random.default_rng([seed, number])
            going = np.sort(np.concatenate([state.rebound(going, facet, bounce, random), on]))
        else:
            state.status[going] = state.status[on] = JourneyStatus.BOUNCING
            going = going[:0]
        if progress:
            progress(1.0 - len(going) / max(len(state.time), 1))
        if not len(going):
            break
    return state.journeys(Arcs.joined(parts))


@dataclass
class _State:
    """Where all landers are now; arrays as in Journeys, begin, mass and spin_period as in Launch, the rest of hop."""

    body: Body
    duration: float
    rolls: bool
    friction: NDArray[np.float64]
    begin: NDArray[np.float64]
    mass: NDArray[np.float64]
    spin_period: NDArray[np.float64]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    spin: NDArray[np.float64]
    time: NDArray[np.float64]
    status: NDArray[np.str_]
    bounce_count: NDArray[np.int64]
    path_length: NDArray[np.float64]
    slid_length: NDArray[np.float64]
    slid_time: NDArray[np.float64]
    impact_speed: NDArray[np.float64]
    incidence: NDArray[np.float64]

    @classmethod
    def of(cls, body: Body, launch: Launch, duration: float, friction: ArrayLike, rolls: bool) -> "_State":
        if not (numbers("friction", friction) >= 0.0).all():
            raise ValueError(f"friction is {friction!r}; it must be at least 0 (infinite: a lander rests where it is).")
        position = np.array(np.atleast_2d(numbers("launch: position", launch.position)))
        count = len(position)

        def each(name: str, given: ArrayLike, *shape: int) -> NDArray[np.float64]:
            array = numbers(f"launch: {name}", given)
            if array.shape not in (shape, (count, *shape)):
                raise ValueError(
                    f"launch: {name} has shape {array.shape} for {count} landers; it must be {shape}, for all of them, "
                    f"or {(count, *shape)}."
                )
            return np.array(np.broadcast_to(array, (count, *shape)))

        return cls(
            body=body,
            duration=duration,
            rolls=rolls,
            friction=each("friction", friction),
            begin=each("time", launch.time),
            mass=each("mass", body.mass if launch.mass is None else launch.mass),
            spin_period=each("spin_period", body.spin_period if launch.spin_period is None else launch.spin_period),
            position=position,
            velocity=each("velocity", launch.velocity, 3),
            spin=each("spin", launch.spin, 3),
            time=np.zeros(count),
            # As wide as the longest word of JourneyStatus; NumPy would cut a longer one silently.
            status=np.full(count, JourneyStatus.FLYING.value, dtype="<U8"),
            bounce_count=np.zeros(count, dtype=np.int64),
            path_length=np.zeros(count),
            slid_length=np.zeros(count),
            slid_time=np.zeros(count),
            impact_speed=np.full(count, np.nan),
            incidence=np.full(count, np.nan),
        )

    def journeys(self, arcs: Arcs) -> Journeys:
        names = (field.name for field in fields(Journeys) if field.name != "arcs")
        return Journeys(**{name: getattr(self, name) for name in names}, arcs=arcs)

    def first_flights(self, captured: ArrayLike) -> NDArray[np.int64]:
        """Landers that fly at the start: those that were not captured, and those that slide off the ground."""
        lies = np.broadcast_to(np.asarray(captured, dtype=bool), self.time.shape)
        return np.sort(np.concatenate([np.flatnonzero(~lies), self.slide(np.flatnonzero(lies))]))

    def clock(self, which: NDArray[np.int64]) -> NDArray[np.float64]:
        """Time of some landers as of `fly` [s]."""
        clock: NDArray[np.float64] = self.begin[which] + self.time[which]
        return clock

    def fly(self, going: NDArray[np.int64], gravity: str, threads: int | None) -> Flights:
        flights = fly(
            *(self.body, self.position[going], self.velocity[going], self.duration - self.time[going]),
            gravity=gravity,
            start_time=self.clock(going),
            mass=self.mass[going],
            spin_period=self.spin_period[going],
            threads=threads,
        )
        self.path_length[going] += np.linalg.norm(flights.position - self.position[going], axis=1)
        self.position[going], self.velocity[going] = flights.position, flights.velocity
        self.time[going] += flights.time
        self.status[going] = np.where(flights.status == FlightStatus.IMPACT, JourneyStatus.FLYING, flights.status)
        hit = flights.facet >= 0
        self.impact_speed[going[hit]], self.incidence[going[hit]] = flights.impact_speed[hit], flights.incidence[hit]
        # The body turns on while a spin stays among the stars.
        start, period = flights.start.time, self.spin_period[going]
        self.spin[going] = kept_among_stars(self.body.rotation, self.spin[going], start, flights.time, period)
        return flights

    def rebound(
        self, going: NDArray[np.int64], facet: NDArray[np.int64], bounce: Bounce, random: np.random.Generator
    ) -> NDArray[np.int64]:
        """Bounce the landers `going` off their facets, or let them slide; gives those that fly on."""
        if not len(going):
            return going
        up = self.body.shape.normals[facet]
        velocity = self.velocity[going]
        axes = impact_frame(velocity, up)
        speed, incidence = self.impact_speed[going], self.incidence[going]
        felt = self.body.effective_acceleration(
            self.position[going],
            mass=self.mass[going],
            spin_period=self.spin_period[going],
            time=self.clock(going),
        )
        outward = np.einsum("ni,ni->n", felt, up)
        local_spin = np.einsum("nij,nj->ni", axes, self.spin[going])
        result = bounce(Impacts(speed, incidence, local_spin, outward, going), random)
        self.status[going[result.outside]] = JourneyStatus.OUTSIDE
        stays = result.captured & ~result.outside
        on = ~(stays | result.outside)
        if not (result.velocity[on, 2] > 0.0).all():
            raise ValueError("a bounce sent a lander into the ground; it must call it captured or outside instead.")
        self.velocity[going] = np.einsum("nji,nj->ni", axes, result.velocity)
        self.spin[going[on]] = np.einsum("nji,nj->ni", axes[on], result.spin[on])
        self.bounce_count[going[on]] += 1
        return np.concatenate([going[on], self.slide(going[stays])])

    def slide(self, which: NDArray[np.int64]) -> NDArray[np.int64]:
        """Let landers on the ground slide; gives those that leave it again and fly on.

        Raises ValueError for one that is above the ground.
        """
        shape, height, facet = self.body.shape, np.empty(len(which)), np.empty(len(which), dtype=np.int64)
        # A flight that comes in along the ground may end beside the facet that it has met.
        near_heights(shape.grid, shape.corners, shape.pseudonormals, self.position[which], height, facet)
        if (facet < 0).any():
            raise ValueError("launch: a captured lander is above the ground; give it a position on the surface.")
        own = (self.friction[which], self.mass[which], self.spin_period[which], self.clock(which))
        ground, left = OnGround(self.body, facet, *own, self.rolls), self.duration - self.time[which]
        ends = slide(ground, self.position[which], self.velocity[which], left)
        self.position[which], self.velocity[which] = ends.position, ends.velocity
        for total, part in ((self.time, ends.time), (self.slid_time, ends.time), (self.slid_length, ends.length)):
            total[which] += part
        # What moves along the ground turns with it, or rolls, which counts for little against the stars.
        self.spin[which] = ground_spin(self.body.rotation, self.clock(which), self.spin_period[which])
        # Nothing says how a lander leaves that is pushed off the ground at rest.
        lofted = ends.leaves & ~ends.velocity.any(axis=1)
        ended = (ends.rests, lofted, ends.leaves)
        words = [word.value for word in (JourneyStatus.SETTLED, JourneyStatus.LOFTED, JourneyStatus.FLYING)]
        self.status[which] = np.select(ended, words, JourneyStatus.SLIDING.value)
        return which[ends.leaves & ~lofted]


def impact_frame(velocity: NDArray[np.float64], up: NDArray[np.float64]) -> NDArray[np.float64]:
    """Axes in rows, [count, 3, 3]: x along the horizontal velocity, y = z cross x, z = up, the unit normal."""
    level = velocity - np.einsum("ni,ni->n", velocity, up)[:, None] * up
    # A vertical impact has no horizontal direction; any will do.
    aside = np.eye(3)[np.argmin(np.abs(up), axis=1)]
    length = np.linalg.norm(level, axis=1, keepdims=True)
    level = np.where(length > 1e-12 * np.linalg.norm(velocity, axis=1, keepdims=True), level, np.cross(up, aside))
    x = level / np.linalg.norm(level, axis=1, keepdims=True)
    return np.stack([x, np.cross(up, x), up], axis=1)
