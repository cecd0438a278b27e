"""Touchdowns by a law of the bounce, and captured landers that slide on."""

from dataclasses import dataclass

import numpy as np

from lithobrake.files.reading import hashed_seed
from lithobrake.smallbody.body import Body
from lithobrake.smallbody.bounce import Bounce, Impacts
from lithobrake.smallbody.facet_grid import near_heights
from lithobrake.smallbody.grounds import grounds_of
from lithobrake.smallbody.sliding import OnGround, slide
from lithobrake.smallbody.touchdown import (
    Answers,
    ImpactStates,
    Touchdown,
    horizontal_velocity,
    into_frame,
    out_of_frame,
)
from lithobrake.vocabulary.array_types import Array, Integers
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import UNKNOWN_END

# Cosine of the incidence below which a lander does not hit the ground but slides along it.
GRAZE = 1e-5


@dataclass(frozen=True)
class Bounces:
    """Touchdowns by a bounce, without duration or path; title and seed name its random numbers."""

    bounce: Bounce
    seed: int
    title: str

    def answers(self, impacts: ImpactStates) -> Answers:
        """Bounce; a lander that comes in along the ground is captured, with the velocity that it has."""
        incidence = np.radians(impacts.incidence_deg)
        met = Impacts(impacts.speed, incidence, impacts.local_spin, impacts.acceleration[:, 2], impacts.lander)
        random = np.random.default_rng(hashed_seed(self.seed, self.title, int(impacts.number[0])))
        rebounds, found = self.bounce(met, random), Answers.unknown(len(impacts))
        grazes = np.cos(incidence) < GRAZE
        captured = (rebounds.captured & ~rebounds.outside) | grazes
        left = ~captured & ~rebounds.outside
        if not (rebounds.velocity[left, 2] > 0.0).all():
            raise ValueError("a bounce sent a lander into the ground; it must call it captured or outside instead.")
        found.outcome[captured], found.outcome[left] = TouchdownOutcome.CAPTURED, TouchdownOutcome.CLEAR
        found.velocity[:] = np.where(grazes[:, None], horizontal_velocity(impacts), rebounds.velocity)
        found.spin[:], found.contacts[:] = rebounds.spin, 1
        return found


@dataclass(frozen=True)
class Sliding:
    """Another model's touchdowns, after which captured landers slide on until they rest or leave the ground.

    body: about which they fly. friction: under each lander, [lander_count]; infinite: it rests where it is. rolls: they
    roll like balls, and friction is the resistance to that.
    """

    touchdown: Touchdown
    body: Body
    friction: Array
    rolls: bool

    def answers(self, impacts: ImpactStates) -> Answers:
        """As the other model, and then slide. Of a lander that the ground pushes off at rest the end is not known."""
        found = self.touchdown.answers(impacts)
        on = np.flatnonzero(found.outcome == TouchdownOutcome.CAPTURED)
        for number, ground in enumerate(grounds_of(self.body)):
            if len(there := on[impacts.ground[on] == number]):
                self._slide(found, there, impacts.at(there), ground.body)
        return found

    def _slide(self, found: Answers, on: Integers, here: ImpactStates, body: Body) -> None:
        """Let captured landers slide, all on the ground of one body; on: their places in what is found."""
        facet, friction = _facets(body, here.position), self.friction[here.lander]
        ground = OnGround(body, facet, friction, here.mass, here.spin_period, here.clock, self.rolls)
        velocity = out_of_frame(here.axes, found.velocity[on])
        ends = slide(ground, here.position, velocity, here.left - found.duration[on])
        lofted = ends.leaves & ~ends.velocity.any(axis=1)
        words = [TouchdownOutcome.CAPTURED.value, UNKNOWN_END, TouchdownOutcome.CLEAR.value]
        found.outcome[on] = np.select([ends.rests, lofted, ends.leaves], words, TouchdownOutcome.TIME_LIMIT.value)
        found.velocity[on] = into_frame(here.axes, ends.velocity)
        # What moves along the ground turns with it, or rolls, which counts for little.
        found.spin[on] = 0.0
        found.way[on] = into_frame(here.axes, ends.position - here.position)
        found.length[on] += ends.length
        found.duration[on] += ends.time


def _facets(body: Body, position: Array) -> Integers:
    """Facets under landers that touch the ground."""
    shape, height = body.shape, np.empty(len(position))
    facet = np.empty(len(position), dtype=np.int64)
    # A flight that comes in along the ground may end beside the facet that it has met.
    near_heights(shape.grid, shape.corners, shape.pseudonormals, position, height, facet)
    if (facet < 0).any():
        raise ValueError("a captured lander is above the ground; it must be on the surface.")
    return facet
