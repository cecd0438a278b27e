"""From bounce to bounce on a body without a study: landers that are thrown, and then followed."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.smallbody.body import Body
from lithobrake.smallbody.bounce import Bounce, impact_frame
from lithobrake.smallbody.ground_touchdowns import Bounces, Sliding
from lithobrake.smallbody.landers import Landers, follow
from lithobrake.smallbody.rotation import ground_spin
from lithobrake.smallbody.touchdown import Answers, ImpactStates, Touchdown, into_frame
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import numbers, whole_number
from lithobrake.vocabulary.outcomes import TouchdownOutcome


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

    def landers(self, body: Body, **following: Any) -> Landers:
        """The landers at their start; following: duration, most, gravity and threads of `Landers`."""
        position = np.array(np.atleast_2d(numbers("launch: position", self.position)))
        count = len(position)
        velocity, period = per_lander(count, "velocity", self.velocity, 3), self.spin_period
        return Landers(
            body=body,
            start=per_lander(count, "time", self.time),
            mass=per_lander(count, "mass", body.mass if self.mass is None else self.mass),
            spin_period=per_lander(count, "spin_period", body.spin_period if period is None else period),
            position=position,
            axes=impact_frame(velocity, body.shape.normals[body.shape.nearest(position)[1]]),
            speed=np.zeros(count),
            incidence_deg=np.zeros(count),
            mean_incidence_deg=np.zeros(count),
            spin=np.zeros((count, 3)),
            **following,
        )


def per_lander(count: int, name: str, given: ArrayLike, *shape: int) -> Array:
    """What is given for each lander or for all, [count, *shape]. Raises ValueError for an array of another shape."""
    array = numbers(f"launch: {name}", given)
    if array.shape not in (shape, (count, *shape)):
        raise ValueError(
            f"launch: {name} has shape {array.shape} for {count} landers; it must be {shape}, for all of them, "
            f"or {(count, *shape)}."
        )
    return np.array(np.broadcast_to(array, (count, *shape)))


@dataclass(frozen=True)
class Thrown:
    """Touchdowns of which each first one ends as it is told; the others are answered by another model.

    velocity [m/s] and spin against the ground [rad/s], fixed to the body, [lander_count, 3].
    """

    touchdown: Touchdown
    velocity: Array
    spin: Array
    captured: np.ndarray

    def answers(self, impacts: ImpactStates) -> Answers:
        """The throws, or the answers of the other model."""
        if impacts.number[0] > 0:
            return self.touchdown.answers(impacts)
        found, which = Answers.unknown(len(impacts)), impacts.lander
        found.outcome[:] = np.where(self.captured[which], TouchdownOutcome.CAPTURED, TouchdownOutcome.CLEAR)
        found.velocity[:], found.spin[:] = (into_frame(impacts.axes, one[which]) for one in (self.velocity, self.spin))
        return found


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
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Landers:
    """Fly, bounce and fly again, slide where captured, for at most `duration` [s] in all.

    bounce     called once a round with the impacts of all landers still under way and a generator of random numbers
    friction   of the ground under landers that are captured or come in along it, which slide on until they rest or
               leave the ground again: a coefficient for each or for all; infinite: they rest where they are
    rolls      they roll like balls, and friction is the resistance to that
    gravity    as of `fly`, and so are threads
    bounce_limit   a lander that has bounced so often is still under way
    seed       of the generator: the same call gives the same result
    progress   called with the fraction of landers that have ended

    The result has the landers at their ends: end (at_rest, escaped, under_way; partner: at rest on the partner of the
    body, or on a planet; "unknown" where the bounce had no answer, or the ground pushes off what lies on it), ground (0
    the body, 1 its partner), time [s], and on that body position [m], latitude, longitude [deg], touchdowns (the launch
    is the first), path_length, contact_length [m]. Raises ValueError for what is no number, for arrays of
    other shapes, and for a bounce into the ground.
    """
    seed, bounce_limit = whole_number("seed", seed, 0), whole_number("bounce_limit", bounce_limit, 0)
    if not (numbers("friction", friction) >= 0.0).all():
        raise ValueError(f"friction is {friction!r}; it must be at least 0 (infinite: a lander rests where it is).")
    landers = launch.landers(body, duration=duration, gravity=gravity, most=bounce_limit + 1, threads=threads)
    count = len(landers)
    spin = per_lander(count, "spin", launch.spin, 3) - ground_spin(body.rotation, landers.start, landers.spin_period)
    captured = np.broadcast_to(np.asarray(launch.captured, dtype=bool), count)
    velocity = per_lander(count, "velocity", launch.velocity, 3)
    thrown = Thrown(Bounces(bounce, seed, "bounces"), velocity, spin, captured)
    sliding = Sliding(thrown, body, per_lander(count, "friction", friction), rolls)
    return follow(landers, sliding, None if progress is None else lambda ended: progress(ended / max(count, 1)))
