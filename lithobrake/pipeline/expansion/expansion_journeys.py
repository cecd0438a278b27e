"""The refined expansion, asked about every impact of a lander."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.expansion.expansion_samples import Scatter, outcome_model
from lithobrake.pipeline.first_touchdown.bounce_laws import inputs_at
from lithobrake.pipeline.first_touchdown.samples import CAPTURED, CLEAR, VELOCITY, outgoing, rolling_spin
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.vocabulary.file_names import REFINED_FILE

if TYPE_CHECKING:
    from lithobrake.analysis import OutcomeModel
    from lithobrake.chaos import Surrogate
    from lithobrake.smallbody import Impacts, Rebounds


@dataclass(frozen=True)
class SoilBounce:
    """The refined expansion as a bounce.

    inputs    of each lander, by dotted key in the file's units, each of shape [lander_count]: the soil that a lander
              has met at first is the soil that it meets again
    ranges    of runs and first impacts; an impact outside them is not answered
    scatter   drawn anew at each impact; None: none

    Of speed, incidence, spin and effective acceleration at an impact those enter that are inputs of the
    study; the others stay as the study has them. The expansion gives the size of the outgoing spin; its axis is taken
    as that of rolling along the outgoing velocity.
    """

    surrogate: "Surrogate"
    outcome: "OutcomeModel"
    inputs: dict[str, np.ndarray]
    ranges: dict[str, tuple[float, float]]
    scatter: Scatter | None

    def __call__(self, impacts: "Impacts", random: np.random.Generator) -> "Rebounds":
        """Answer each impact with the outputs of the expansion, a draw of its scatter and a draw of the outcome.

        A lander that leaves the bed sideways, is still in contact at the time limit, or is drawn with an elevation
        outside 0 to 90 degrees, has no answer.
        """
        from lithobrake.smallbody import Rebounds

        x, outside = inputs_at(impacts, self.inputs, self.ranges)
        columns = [list(self.inputs).index(name) for name in self.surrogate.input_names]
        outputs = np.asarray(self.surrogate(x[:, columns]))
        if self.scatter is not None:
            outputs = outputs + self.scatter.draw(impacts.speed, random)
        names = self.surrogate.output_names
        outputs, possible = outgoing(outputs, names)
        drawn = self.outcome.draw(x, random)
        captured = drawn == CAPTURED
        outside |= ~captured & ~((drawn == CLEAR) & possible)
        velocity = outputs[:, [names.index(name) for name in VELOCITY]]
        velocity[captured] = 0.0
        # An expansion of a size may fall below 0.
        spin = rolling_spin(velocity, np.maximum(outputs[:, names.index("spin_out")], 0.0))
        return Rebounds(velocity, spin, captured, outside)


def soil_bounce(job: Job, inputs: dict[str, np.ndarray]) -> SoilBounce:
    """The bounce of a study for landers with these inputs, each of shape [lander_count]."""
    from lithobrake.chaos import load

    refined = load(job.folder / REFINED_FILE)
    # In the refined runs the inputs that the screening drops are at their medians, and have no range. First impacts are
    # drawn from the distributions for which the expansion stands, which runs need not cover to their ends.
    of_runs = DesignRuns.load(job.folder, "screening").ranges(inputs)
    ranges = {
        name: (min(lower, inputs[name].min()), max(upper, inputs[name].max()))
        for name, (lower, upper) in of_runs.items()
    }
    scatter = Scatter.of(job, refined) if job.study.monte_carlo.scatter else None
    return SoilBounce(refined, outcome_model(job), inputs, ranges, scatter)
