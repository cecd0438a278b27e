"""The soil as a bounce of flights that go on: the emulator, asked again at every impact."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.emulate.drawn_landings import DrawnLandings
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT, refits
from lithobrake.pipeline.emulate.samples import CAPTURED, CLEAR, Samples
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.rest.bounce_inputs import inputs_at
from lithobrake.pipeline.runs.energy_bound import EnergyBound, energy_bound, height_of_beds
from lithobrake.pipeline.runs.run_table import DesignRuns

if TYPE_CHECKING:
    from lithobrake.emulator import Emulator
    from lithobrake.smallbody import Impacts, Rebounds


@dataclass(frozen=True)
class EmulatorBounce:
    """The emulator as a bounce of smallbody.hop.

    refits    fits to beds drawn with replacement, of which each lander keeps one through its journey
    refit     place of that of each lander, [lander_count]
    inputs    of each lander, by dotted key in the file's units, each of shape [lander_count]: the soil that a lander
              has met at first is the soil that it meets again, on another bed and place and in another attitude
    ranges    of the runs; an impact outside them is not answered
    bound     what energy allows landers after impacts with inputs [count, input_count]
    """

    refits: "list[Emulator]"
    refit: np.ndarray
    inputs: dict[str, np.ndarray]
    ranges: dict[str, tuple[float, float]]
    bound: Callable[[np.ndarray], EnergyBound]

    def __call__(self, impacts: "Impacts", random: np.random.Generator) -> "Rebounds":
        """Answer each impact with a draw; a lander that goes over the rim or stays in contact has no answer."""
        from lithobrake.smallbody import Rebounds

        x, outside = inputs_at(impacts, self.inputs, self.ranges)
        velocity, spin = np.zeros((len(x), 3)), np.zeros((len(x), 3))
        outcome, bound = np.full(len(x), CLEAR), self.bound(x)
        # All refits take a seed, whether landers of theirs hit or not.
        for number, seed in enumerate(random.integers(2**31, size=len(self.refits)).tolist()):
            of_refit = np.flatnonzero(self.refit[impacts.lander] == number)
            if len(of_refit):
                drawn = DrawnLandings.of(self.refits[number], x[of_refit], bound.at(of_refit), seed)
                velocity[of_refit], spin[of_refit], outcome[of_refit] = drawn.velocity, drawn.spin, drawn.outcome
        captured = outcome == CAPTURED
        velocity[captured] = 0.0
        return Rebounds(velocity, spin, captured, outside | ~(captured | (outcome == CLEAR)))


def emulator_bounce(job: Job, samples: Samples) -> EmulatorBounce:
    """The bounce of a study for samples whose place is known, in their order; each keeps the refit it was drawn of."""
    known, names = np.flatnonzero(samples.known), list(samples.input_names)
    inputs = dict(zip(names, samples.inputs[known].T, strict=True))
    # Every bed is read for it, which no impact should wait for.
    height = height_of_beds(job.study, job.folder)

    def bound(x: np.ndarray) -> EnergyBound:
        return energy_bound(job.design, height, dict(zip(names, x.T, strict=True)), len(x))

    ranges = DesignRuns.load(job.folder, "drawn").ranges(names)
    return EmulatorBounce(refits(job), known % REFIT_COUNT, inputs, ranges, bound)
