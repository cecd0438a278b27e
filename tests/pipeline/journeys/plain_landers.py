"""Landers on a body without a study: they are thrown from where they are, and then followed."""

import math
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.landers import StudyLanders
from lithobrake.smallbody import Body, Bounce
from lithobrake.smallbody.ground_touchdowns import Bounces, Sliding
from lithobrake.smallbody.hopping import Thrown
from lithobrake.smallbody.landers import follow
from lithobrake.smallbody.touchdown import Answers, ImpactStates, Touchdown


@dataclass
class Recorded:
    """Touchdowns of a model; seen: the impacts after the first of each lander."""

    touchdown: Touchdown

    def __post_init__(self) -> None:
        self.seen: list[ImpactStates] = []

    def answers(self, impacts: ImpactStates) -> Answers:
        if impacts.number[0] > 0:
            self.seen.append(impacts)
        return self.touchdown.answers(impacts)


def thrown_landers(
    body: Body,
    position: Any,
    *,
    duration: float = 1e5,
    most: int | None = None,
    time: Any = 0.0,
    mass: Any = None,
    gravity: str = "exact",
    roughness_deg: float | None = None,
) -> StudyLanders:
    """Landers at places on the ground [m], [count, 3], in frames whose z is up there; time: as of `fly` [s]."""
    place = np.atleast_2d(np.asarray(position, dtype=float))
    count, up = len(place), body.shape.normals[body.shape.nearest(place)[1]]
    aside = np.cross(up, np.eye(3)[np.argmin(np.abs(up), axis=1)])
    aside /= np.linalg.norm(aside, axis=1, keepdims=True)
    axes = np.stack([np.cross(aside, up), aside, up], axis=1)
    own = {"mass": body.mass if mass is None else mass, "spin_period": body.spin_period}
    site = {name: np.array(np.broadcast_to(one, count), dtype=float) for name, one in own.items()}
    clock = np.array(np.broadcast_to(time, count), dtype=float)
    whole = (np.zeros(count, dtype=int) for _ in range(2))
    begin = Arrivals(np.arange(count), [{}] * count, site, place, axes, clock, *whole)
    study: Any = SimpleNamespace(
        seed=0,
        journey=SimpleNamespace(duration=duration),
        flight=SimpleNamespace(gravity=gravity),
        site=SimpleNamespace(roughness_deg=roughness_deg),
    )
    design: Any = SimpleNamespace(site=SimpleNamespace(body=body), study=study)
    return StudyLanders.of(design, begin, most, threads=1)


def hop(
    body: Body,
    position: Any,
    velocity: Any,
    bounce: Bounce,
    *,
    spin: Any = (0.0, 0.0, 0.0),
    captured: Any = False,
    friction: float = math.inf,
    **settings: Any,
) -> tuple[StudyLanders, Recorded]:
    """Landers thrown with velocities [m/s], body-fixed, that bounce and slide until they have ended."""
    landers = thrown_landers(body, position, **settings)
    vectors = (np.broadcast_to(np.asarray(one, dtype=float), (len(landers), 3)) for one in (velocity, spin))
    lies = np.broadcast_to(captured, len(landers))
    thrown = Recorded(Thrown(Bounces(bounce, 0, "bounces"), *vectors, lies))
    sliding = Sliding(thrown, body, np.full(len(landers), friction), rolls=False)
    return follow(landers, sliding), thrown
