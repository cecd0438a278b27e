"""Landers of a study on other ground: too slow to leave, and sliding on once they are captured."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.dem.law.restitution import pair_value
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown import bounce_laws
from lithobrake.pipeline.journeys.first_arrivals import Arrivals
from lithobrake.pipeline.runs.energy_bound import gyrations
from lithobrake.smallbody.touchdown import Answers, ImpactStates, Touchdown, horizontal_velocity
from lithobrake.touchdown.lander_model import lander
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.outcomes import TouchdownOutcome

if TYPE_CHECKING:
    from lithobrake.smallbody.ground_touchdowns import Sliding


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


def sliding(design: DrawnDesign, begin: Arrivals, touchdown: Touchdown, friction: Array | None = None) -> "Sliding":
    """Touchdowns of a study's landers with the sliding of captured ones.

    friction: under each lander, [lander_count]; None: that of the soil. hard_ground.rolling_friction takes its place
    where landers roll.
    """
    from lithobrake.smallbody.ground_touchdowns import Sliding

    rolling = design.study.hard_ground.rolling_friction
    if rolling is not None:
        friction = np.full(len(begin.rows), rolling)
    elif friction is None:
        friction = soil_friction(design, begin)
    return Sliding(touchdown, design.site.body, friction, rolling is not None)
