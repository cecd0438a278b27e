"""The soil as a bounce of flights that go on: the refined expansion, asked again at every impact."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.designs import design_inputs, points
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.outgoing import VELOCITY, outgoing, rolling_spin
from lithobrake.pipeline.run_noise import Scatter
from lithobrake.pipeline.samples import CAPTURED, CLEAR, outcome_model
from lithobrake.pipeline.sequence import inputs_of, sequence_rows
from lithobrake.study import Study

if TYPE_CHECKING:
    from lithobrake.analysis import OutcomeModel
    from lithobrake.chaos import Surrogate
    from lithobrake.smallbody import Impacts, Rebounds

# Without these two among the uncertain inputs the expansion says nothing about an impact that differs from the first.
NEEDED = ("impact.speed", "impact.incidence_deg")
SPIN = ("impact.spin_x", "impact.spin_y", "impact.spin_z")


def why_no_soil(study: Study) -> str | None:
    """Why the soil cannot be asked about the impacts after the first; None where it can."""
    absent = [name for name in NEEDED if name not in design_inputs(study)]
    if not absent:
        return None
    return (
        f"{' and '.join(absent)} {'is' if len(absent) == 1 else 'are'} no uncertain input, so the runs do not "
        "tell of the impacts after the first; give it a distribution that reaches over the impacts to come"
    )


def trained_ranges(study: Study) -> dict[str, tuple[float, float]]:
    """Smallest and largest value of each input in the runs in which all vary, in the file's units, by dotted key."""
    inputs = design_inputs(study)
    paper = study.design.method == "paper"
    x = points(study, "screening", ()) if paper else inputs_of(sequence_rows(study), tuple(inputs))
    columns = zip(inputs, x.min(axis=0).tolist(), x.max(axis=0).tolist(), strict=True)
    return {name: (lower, upper) for name, lower, upper in columns}


@dataclass(frozen=True)
class SoilBounce:
    """The refined expansion as a bounce of smallbody.hop.

    inputs    of each lander, by dotted key in the file's units, each of shape [lander_count]: the soil that a lander
              has met at first is the soil that it meets again
    ranges    of the runs; an impact outside them is not answered
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
        spin = rolling_spin(velocity, np.maximum(outputs[:, names.index("spin_out")], 0.0))
        return Rebounds(velocity, spin, captured, outside)


def inputs_at(
    impacts: "Impacts", inputs: Mapping[str, np.ndarray], ranges: Mapping[str, tuple[float, float]]
) -> tuple[np.ndarray, np.ndarray]:
    """All inputs at the impacts, [count, input_count], and which of these are outside the ranges, [count].

    inputs: of each lander. Those outside have the inputs of the first impact in place of theirs.
    """
    felt = {"impact.speed": impacts.speed, "impact.incidence_deg": np.degrees(impacts.incidence)}
    felt |= dict(zip(SPIN, impacts.spin.T, strict=True)) | {"surface.gravity": -impacts.effective_acceleration}
    x = np.column_stack([values[impacts.lander] for values in inputs.values()])
    outside = np.zeros(len(x), dtype=bool)
    for index, name in enumerate(inputs):
        if name in felt:
            lower, upper = ranges[name]
            known = (felt[name] >= lower) & (felt[name] <= upper)
            x[known, index] = felt[name][known]
            outside |= ~known
    return x, outside


def soil_bounce(job: Job, inputs: dict[str, np.ndarray]) -> SoilBounce:
    """The bounce of a study for landers with these inputs, each of shape [lander_count]."""
    from lithobrake.chaos import load

    study, refined = job.study, load(job.folder / "refined.json")
    scatter = Scatter.of(job, refined) if study.monte_carlo.scatter else None
    return SoilBounce(refined, outcome_model(job), inputs, trained_ranges(study), scatter)
