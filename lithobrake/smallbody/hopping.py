"""From bounce to bounce until a lander rests, escapes, or the time is over."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.smallbody.body import Body
from lithobrake.smallbody.bounce import Bounce, Impacts
from lithobrake.smallbody.flight import fly
from lithobrake.smallbody.flight_results import Flights

GRAZE = 1e-5  # cosine of the incidence below which a lander does not hit the ground but slides along it


@dataclass(frozen=True)
class Journeys:
    """Where each lander ended; every array has one entry or row a lander.

    status         "settled": captured where the ground holds it; "lofted": captured where gravity and rotation together
                   push outwards; "flying": the time was over; "escaped"; "partner": on the partner, where no bounce is
                   followed; "outside": an impact that the bounce does not know; "sliding": it moves along the ground,
                   which is not followed; "bouncing": bounce_limit was reached
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


def hop(
    body: Body,
    position: ArrayLike,
    velocity: ArrayLike,
    bounce: Bounce,
    duration: float,
    *,
    spin: ArrayLike = (0.0, 0.0, 0.0),
    start_time: ArrayLike = 0.0,
    mass: ArrayLike | None = None,
    spin_period: ArrayLike | None = None,
    gravity: str = "table",
    bounce_limit: int = 1000,
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Journeys:
    """Fly, bounce and fly again from start states as of `fly`, for at most `duration` [s] in all.

    bounce     called once a round with the impacts of all landers still under way and a generator of random numbers
    spin       angular velocity at the start, body-fixed axes, relative to the stars [rad/s], [count, 3] or [3]
    start_time   as of `fly`, and so are mass and spin_period
    seed       of the generator: the same call gives the same result
    progress   called with the share of landers that have ended
    """
    start = np.array(np.atleast_2d(np.asarray(position, dtype=np.float64)))
    masses, periods = (
        np.array(np.broadcast_to(np.asarray(own if given is None else given, dtype=np.float64), len(start)))
        for own, given in ((body.mass, mass), (body.spin_period, spin_period))
    )
    state = _State(body, start, np.array(np.atleast_2d(np.asarray(velocity, dtype=np.float64))), masses, periods)
    state.spin[:] = np.asarray(spin, dtype=np.float64)
    begin = np.array(np.broadcast_to(np.asarray(start_time, dtype=np.float64), len(start)))
    going = np.arange(len(start))
    for number in range(bounce_limit + 1):
        where, rate, left = state.position[going], state.velocity[going], duration - state.time[going]
        now = begin[going] + state.time[going]
        flights = fly(
            *(body, where, rate, left),
            gravity=gravity,
            start_time=now,
            mass=masses[going],
            spin_period=periods[going],
            threads=threads,
        )
        state.advance(going, flights)
        slides = (flights.status == "impact") & (np.cos(flights.incidence) < GRAZE)
        state.status[going[slides]] = "sliding"
        bounces = (flights.status == "impact") & ~slides
        going, facet = going[bounces], flights.facet[bounces]
        if number < bounce_limit and len(going):
            going = state.rebound(going, facet, bounce, np.random.default_rng([seed, number]))
            going = going[state.time[going] < duration]
        elif len(going):
            state.status[going] = "bouncing"
            going = going[:0]
        if progress:
            progress(1.0 - len(going) / len(start))
        if not len(going):
            break
    return state.journeys()


@dataclass
class _State:
    """Where all landers are now."""

    body: Body
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    mass: NDArray[np.float64]
    spin_period: NDArray[np.float64]
    spin: NDArray[np.float64] = field(init=False)
    time: NDArray[np.float64] = field(init=False)
    status: NDArray[Any] = field(init=False)
    bounce_count: NDArray[np.int64] = field(init=False)
    path_length: NDArray[np.float64] = field(init=False)
    impact_speed: NDArray[np.float64] = field(init=False)
    incidence: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        count = len(self.position)
        self.spin, self.time, self.path_length = np.zeros((count, 3)), np.zeros(count), np.zeros(count)
        self.status, self.bounce_count = np.full(count, "flying", dtype="<U8"), np.zeros(count, dtype=np.int64)
        self.impact_speed, self.incidence = np.full(count, np.nan), np.full(count, np.nan)

    def journeys(self) -> Journeys:
        """What has become of the landers."""
        names = ("status", "time", "position", "spin", "bounce_count", "path_length", "impact_speed", "incidence")
        return Journeys(self.body, *(getattr(self, name) for name in names))

    def advance(self, going: NDArray[np.int64], flights: Flights) -> None:
        """Take the ends of the flights of the landers `going`."""
        self.path_length[going] += np.linalg.norm(flights.position - self.position[going], axis=1)
        self.position[going], self.velocity[going] = flights.position, flights.velocity
        self.time[going] += flights.time
        self.status[going] = np.where(flights.status == "impact", "flying", flights.status)
        hit = flights.facet >= 0
        self.impact_speed[going[hit]], self.incidence[going[hit]] = flights.impact_speed[hit], flights.incidence[hit]
        # The body turns on while a spin stays among the stars.
        turn = 2.0 * np.pi / self.spin_period[going] * flights.time
        c, s = np.cos(turn), np.sin(turn)
        x, y = self.spin[going, 0], self.spin[going, 1]
        self.spin[going, 0], self.spin[going, 1] = c * x + s * y, c * y - s * x

    def _push(self, going: NDArray[np.int64]) -> NDArray[np.float64]:
        """Gravity and centrifugal acceleration [m/s2] at the landers `going`, [count, 3]."""
        place = self.position[going]
        gravity = self.body.acceleration(place) * (self.mass[going] / self.body.mass)[:, None]
        spin_rate = 2.0 * np.pi / self.spin_period[going]
        push: NDArray[np.float64] = gravity + (spin_rate**2)[:, None] * place * np.array([1.0, 1.0, 0.0])
        return push

    def rebound(
        self, going: NDArray[np.int64], facet: NDArray[np.int64], bounce: Bounce, random: np.random.Generator
    ) -> NDArray[np.int64]:
        """Bounce the landers `going` off their facets; gives those that fly on."""
        up = self.body.shape.normals[facet]
        velocity = self.velocity[going]
        axes = impact_frame(velocity, up)
        speed, incidence = self.impact_speed[going], self.incidence[going]
        push = np.einsum("ni,ni->n", self._push(going), up)
        local_spin = np.einsum("nij,nj->ni", axes, self.spin[going])
        result = bounce(Impacts(speed, incidence, local_spin, push, going), random)
        stays = result.captured & ~result.outside
        self.status[going[result.outside]] = "outside"
        self.status[going[stays]] = np.where(push[stays] < 0.0, "settled", "lofted")
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
