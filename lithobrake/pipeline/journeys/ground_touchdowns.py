"""Touchdowns by a law of the bounce, and captured landers that slide on."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.dem.law.restitution import pair_value
from lithobrake.files.reading import hashed_seed
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_bounces import bounce_laws
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.journeys.touchdown import Answers, ImpactStates, Touchdown, into_frame, out_of_frame
from lithobrake.pipeline.runs.energy_bound import gyrations
from lithobrake.touchdown.lander_model import lander
from lithobrake.vocabulary.array_types import Array, Integers
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import UNKNOWN_END

if TYPE_CHECKING:
    from lithobrake.smallbody import Body, Bounce

# Cosine of the incidence below which a lander does not hit the ground but slides along it.
GRAZE = 1e-5


@dataclass(frozen=True)
class Bounces:
    """Touchdowns by a bounce, without duration or path; title and seed name its random numbers."""

    bounce: "Bounce"
    seed: int
    title: str

    def answers(self, impacts: ImpactStates) -> Answers:
        """Bounce; a lander that comes in along the ground is captured, with the velocity that it has."""
        from lithobrake.smallbody import Impacts

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


def horizontal_velocity(impacts: ImpactStates) -> Array:
    """Incoming velocities along the ground [m/s], [count, 3], in the frames of the touchdowns."""
    velocity = np.zeros((len(impacts), 3))
    velocity[:, 0] = impacts.speed * np.sin(np.radians(impacts.incidence_deg))
    return velocity


@dataclass(frozen=True)
class Sliding:
    """Another model's touchdowns, after which captured landers slide on until they rest or leave the ground.

    friction: under each lander, [lander_count]; infinite: it rests where it is. rolls: they roll like balls, and
    friction is the resistance to that.
    """

    touchdown: Touchdown
    body: "Body"
    friction: Array
    rolls: bool

    def answers(self, impacts: ImpactStates) -> Answers:
        """As the other model, and then slide. Of a lander that the ground pushes off at rest the end is not known."""
        from lithobrake.smallbody.sliding import OnGround, slide

        found = self.touchdown.answers(impacts)
        on = np.flatnonzero(found.outcome == TouchdownOutcome.CAPTURED)
        if not len(on):
            return found
        here = impacts.at(on)
        facet, friction = self._facets(here.position), self.friction[here.lander]
        ground = OnGround(self.body, facet, friction, here.mass, here.spin_period, here.clock, self.rolls)
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
        return found

    def _facets(self, position: Array) -> Integers:
        """Facets under landers that touch the ground."""
        from lithobrake.smallbody.facet_grid import near_heights

        shape, height = self.body.shape, np.empty(len(position))
        facet = np.empty(len(position), dtype=np.int64)
        # A flight that comes in along the ground may end beside the facet that it has met.
        near_heights(shape.grid, shape.corners, shape.pseudonormals, position, height, facet)
        if (facet < 0).any():
            raise ValueError("a captured lander is above the ground; it must be on the surface.")
        return facet


@dataclass(frozen=True)
class SlowArrivals:
    """Another model's touchdowns; what comes too slowly to leave is captured where that model has no answer.

    edge: smallest edge of each lander [m], and gyration, its largest moment of inertia over its mass [m2],
    [lander_count].

    A run calls a lander captured whose energy could not lift it by half of that edge. Contacts only take energy away,
    so what comes with less never leaves. It slides on with the horizontal velocity that it came with.
    """

    touchdown: Touchdown
    edge: Array
    gyration: Array

    @classmethod
    def of(cls, design: DrawnDesign, begin: Arrivals, touchdown: Touchdown) -> "SlowArrivals":
        """For landers of a study, in place of a model without an answer."""
        drawn = {name: begin.column(name) for name in design.medians}
        if "lander.diameter" in drawn:
            edge = drawn["lander.diameter"]
        else:
            edge = np.full(len(begin.rows), lander(design.study, design.medians).smallest_edge)
        return cls(touchdown, edge, gyrations(design, drawn)[1])

    def answers(self, impacts: ImpactStates) -> Answers:
        """As the other model, and captured where that has no answer and the energy is too low to leave."""
        from lithobrake.touchdown.outcome_judge import CAPTURED_APEX

        found = self.touchdown.answers(impacts)
        squares = impacts.speed**2 + self.gyration[impacts.lander] * (impacts.spin**2).sum(axis=1)
        lift = -2.0 * impacts.acceleration[:, 2] * CAPTURED_APEX * self.edge[impacts.lander]
        slow = ~found.is_known & (squares < lift)
        found.outcome[slow] = TouchdownOutcome.CAPTURED
        found.velocity[slow] = horizontal_velocity(impacts)[slow]
        return found


def soil_friction(design: DrawnDesign, begin: Arrivals) -> Array:
    """Friction that stops each captured lander on soil, [lander_count]: of hull and grain, or the law for hulls."""
    study = design.study
    rule, hull = study.contact.pair_rule, "grain" if study.lander.friction is None else "lander"
    pairs = (_frictions(row, hull) for row in begin.rows)
    of_contacts = np.array([pair_value(one, other, rule) for one, other in pairs])
    return bounce_laws.effective_friction(of_contacts) if bounce_laws.has_measured_size(design) else of_contacts


def _frictions(row: Mapping[str, float], hull: str) -> tuple[float, float]:
    return row["grain.friction"], row[f"{hull}.friction"]


def sliding(design: DrawnDesign, begin: Arrivals, touchdown: Touchdown, friction: Array | None = None) -> Sliding:
    """Touchdowns of a study's landers with the sliding of captured ones.

    friction: under each lander, [lander_count]; None: that of the soil. hard_ground.rolling_friction takes its place
    where landers roll.
    """
    rolling = design.study.hard_ground.rolling_friction
    if rolling is not None:
        friction = np.full(len(begin.rows), rolling)
    elif friction is None:
        friction = soil_friction(design, begin)
    return Sliding(touchdown, design.site.body, friction, rolling is not None)
