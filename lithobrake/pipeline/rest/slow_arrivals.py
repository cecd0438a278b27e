"""Arrivals that are slower than any run: what cannot leave by its energy is captured, whatever the soil."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.emulate.samples import Samples, touchdown_values
from lithobrake.pipeline.runs.energy_bound import gyrations
from lithobrake.study.touchdown_model import lander

if TYPE_CHECKING:
    from lithobrake.smallbody import Bounce, Impacts, Rebounds


@dataclass(frozen=True)
class SlowArrivals:
    """A bounce that answers for another where that has no answer, and a lander comes too slowly to leave.

    bounce     of the soil
    edge       smallest edge of each lander [m], and gyration, its largest moment of inertia over its mass [m2],
               [lander_count]

    A run calls a lander captured whose energy could not lift it by half of that edge. Contacts only take energy away,
    so what comes with less never leaves. It slides on with the horizontal velocity that it came with.
    """

    bounce: "Bounce"
    edge: np.ndarray
    gyration: np.ndarray

    def __call__(self, impacts: "Impacts", random: np.random.Generator) -> "Rebounds":
        """Ask the bounce, then answer what is too slow for it."""
        from lithobrake.smallbody import Rebounds
        from lithobrake.touchdown.outcome_judge import CAPTURED_APEX

        found, velocity = self.bounce(impacts, random), np.zeros((len(impacts.speed), 3))
        squares = impacts.speed**2 + self.gyration[impacts.lander] * (impacts.spin**2).sum(axis=1)
        lift = -2.0 * impacts.effective_acceleration * CAPTURED_APEX * self.edge[impacts.lander]
        slow = found.outside & (squares < lift)
        velocity[:, 0] = impacts.speed * np.sin(impacts.incidence)
        velocity = np.where(slow[:, None], velocity, found.velocity)
        return Rebounds(velocity, found.spin, found.captured | slow, found.outside & ~slow)


def slow_arrivals(design: DrawnDesign, samples: Samples, bounce: "Bounce") -> SlowArrivals:
    """The bounce of a study for the samples whose place is known, in their order, answering for `bounce`."""
    study, known = design.study, design.medians
    drawn = {name: touchdown_values(study, samples.input_names, samples.inputs, name)[samples.known] for name in known}
    if "lander.diameter" in known:
        edge = drawn["lander.diameter"]
    else:
        edge = np.full(len(drawn["lander.mass"]), lander(study, known).smallest_edge)
    return SlowArrivals(bounce, edge, gyrations(design, drawn)[1])
