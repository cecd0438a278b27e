"""From bounce to bounce until a lander rests, escapes, or the time is over."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.outcomes import FlightStatus, JourneyStatus
from lithobrake.smallbody.body import Body
from lithobrake.smallbody.bounce import Bounce, Impacts
from lithobrake.smallbody.flight import fly
from lithobrake.smallbody.flight_results import Flights

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
    impact_speed   at the last impact, against the ground [m/s]; nan where there was none
    incidence      there, of the velocity from the inward normal [rad]; nan likewise
    """

    body: Body
    status: NDArray[np.str_]
    time: NDArray[np.float64]
    position: NDArray[np.float64]
    spin: NDArray[np.float64]
    bounce_count: NDArray[np.int64]
    path_length: NDArray[np.float64]
    impact_speed: NDArray[np.float64]
    incidence: NDArray[np.float64]

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
    mass           of the body [kg] and spin_period [s], in place of its own: for a body that is not well known
    """

    position: ArrayLike
    velocity: ArrayLike
    spin: ArrayLike = (0.0, 0.0, 0.0)
    time: ArrayLike = 0.0
    mass: ArrayLike | None = None
    spin_period: ArrayLike | None = None


def hop(
    body: Body,
    launch: Launch,
    bounce: Bounce,
    duration: float,
    *,
    gravity: str = "table",
    bounce_limit: int = 1000,
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Journeys:
    """Fly, bounce and fly again, for at most `duration` [s] in all.

    bounce     called once a round with the impacts of all landers still under way and a generator of random numbers
    gravity    as of `fly`, and so are threads
    seed       of the generator: the same call gives the same result
    progress   called with the fraction of landers that have ended
    """
    state = _State.of(body, launch)
    going = np.arange(len(state.time))
    for number in range(bounce_limit + 1):
        flights = fly(
            *(body, state.position[going], state.velocity[going], duration - state.time[going]),
            gravity=gravity,
            start_time=state.begin[going] + state.time[going],
            mass=state.mass[going],
            spin_period=state.spin_period[going],
            threads=threads,
        )
        state.advance(going, flights)
        hits = flights.status == FlightStatus.IMPACT
        slides = hits & (np.cos(flights.incidence) < GRAZE)
        state.status[going[slides]] = JourneyStatus.SLIDING
        bounces = hits & ~slides
        going, facet = going[bounces], flights.facet[bounces]
        if number < bounce_limit and len(going):
            going = state.rebound(going, facet, bounce, np.random.default_rng([seed, number]))
            going = going[state.time[going] < duration]
        elif len(going):
            state.status[going] = JourneyStatus.BOUNCING
            going = going[:0]
        if progress:
            progress(1.0 - len(going) / max(len(state.time), 1))
        if not len(going):
            break
    return state.journeys()


@dataclass
class _State:
    """Where all landers are now; arrays as in Journeys, begin, mass and spin_period as in Launch."""

    body: Body
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
    impact_speed: NDArray[np.float64]
    incidence: NDArray[np.float64]

    @classmethod
    def of(cls, body: Body, launch: Launch) -> "_State":
        """The landers at the start."""
        position = np.array(np.atleast_2d(np.asarray(launch.position, dtype=np.float64)))
        count = len(position)

        def each(name: str, given: ArrayLike, *shape: int) -> NDArray[np.float64]:
            array = np.asarray(given, dtype=np.float64)
            if array.shape not in (shape, (count, *shape)):
                raise ValueError(
                    f"launch: {name} has shape {array.shape} for {count} landers; it must be {shape}, for all of them, "
                    f"or {(count, *shape)}."
                )
            return np.array(np.broadcast_to(array, (count, *shape)))

        return cls(
            body=body,
            begin=each("time", launch.time),
            mass=each("mass", body.mass if launch.mass is None else launch.mass),
            spin_period=each("spin_period", body.spin_period if launch.spin_period is None else launch.spin_period),
            position=position,
            velocity=each("velocity", launch.velocity, 3),
            spin=each("spin", launch.spin, 3),
            time=np.zeros(count),
            status=np.full(count, JourneyStatus.FLYING.value, dtype="<U8"),
            bounce_count=np.zeros(count, dtype=np.int64),
            path_length=np.zeros(count),
            impact_speed=np.full(count, np.nan),
            incidence=np.full(count, np.nan),
        )

    def journeys(self) -> Journeys:
        """What has become of the landers."""
        names = ("status", "time", "position", "spin", "bounce_count", "path_length", "impact_speed", "incidence")
        return Journeys(self.body, *(getattr(self, name) for name in names))

    def advance(self, going: NDArray[np.int64], flights: Flights) -> None:
        """Take the ends of the flights of the landers `going`."""
        self.path_length[going] += np.linalg.norm(flights.position - self.position[going], axis=1)
        self.position[going], self.velocity[going] = flights.position, flights.velocity
        self.time[going] += flights.time
        self.status[going] = np.where(flights.status == FlightStatus.IMPACT, JourneyStatus.FLYING, flights.status)
        hit = flights.facet >= 0
        self.impact_speed[going[hit]], self.incidence[going[hit]] = flights.impact_speed[hit], flights.incidence[hit]
        # The body turns on while a spin stays among the stars.
        turn = 2.0 * np.pi / self.spin_period[going] * flights.time
        c, s = np.cos(turn), np.sin(turn)
        x, y = self.spin[going, 0], self.spin[going, 1]
        self.spin[going, 0], self.spin[going, 1] = c * x + s * y, c * y - s * x

    def rebound(
        self, going: NDArray[np.int64], facet: NDArray[np.int64], bounce: Bounce, random: np.random.Generator
    ) -> NDArray[np.int64]:
        """Bounce the landers `going` off their facets; gives those that fly on."""
        up = self.body.shape.normals[facet]
        velocity = self.velocity[going]
        axes = impact_frame(velocity, up)
        speed, incidence = self.impact_speed[going], self.incidence[going]
        felt = self.body.effective_acceleration(
            self.position[going], mass=self.mass[going], spin_period=self.spin_period[going]
        )
        outward = np.einsum("ni,ni->n", felt, up)
        local_spin = np.einsum("nij,nj->ni", axes, self.spin[going])
        result = bounce(Impacts(speed, incidence, local_spin, outward, going), random)
        stays = result.captured & ~result.outside
        self.status[going[result.outside]] = JourneyStatus.OUTSIDE
        self.status[going[stays]] = np.where(outward[stays] < 0.0, JourneyStatus.SETTLED, JourneyStatus.LOFTED)
        on = ~(stays | result.outside)
        if not (result.velocity[on, 2] > 0.0).all():
            raise ValueError("a bounce sent a lander into the ground; it must call it captured or outside instead.")
        self.velocity[going[on]] = np.einsum("nji,nj->ni", axes[on], result.velocity[on])
        self.spin[going[on]] = np.einsum("nji,nj->ni", axes[on], result.spin[on])
        self.bounce_count[going[on]] += 1
        return going[on]


def impact_frame(velocity: NDArray[np.float64], up: NDArray[np.float64]) -> NDArray[np.float64]:
    """Axes in rows, [count, 3, 3]: x along the horizontal velocity, y = z cross x, z = up, the unit normal."""
    level = velocity - np.einsum("ni,ni->n", velocity, up)[:, None] * up
    # A vertical impact has no horizontal direction; any will do.
    aside = np.eye(3)[np.argmin(np.abs(up), axis=1)]
    length = np.linalg.norm(level, axis=1, keepdims=True)
    level = np.where(length > 1e-12 * np.linalg.norm(velocity, axis=1, keepdims=True), level, np.cross(up, aside))
    x = level / np.linalg.norm(level, axis=1, keepdims=True)
    return np.stack([x, np.cross(up, x), up], axis=1)
