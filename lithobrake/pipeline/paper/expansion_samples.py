"""Monte Carlo on the refined expansion: what leaves the surface, how fast and where to, and what does not."""

from typing import TYPE_CHECKING

import numpy as np

from lithobrake.pipeline.emulate.samples import Samples, sampling_seed, touchdown_values
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.paper.run_noise import Scatter
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import PAPER_DESIGNS

if TYPE_CHECKING:
    from lithobrake.analysis import OutcomeModel
    from lithobrake.chaos import Surrogate

# Points at which the expansion is evaluated at once; between two blocks progress is shown.
_BLOCK = 1 << 20


def draw_samples(job: Job) -> None:
    """Sample all inputs, evaluate the expansion, and draw for each sample how the touchdown ends."""
    from lithobrake.analysis import sample_inputs
    from lithobrake.chaos import load

    study, inputs = job.study, job.design.inputs
    refined = load(job.folder / "refined.json")
    x = sample_inputs(inputs, study.monte_carlo.sample_count, sampling_seed(study, "samples"))
    smooth = _evaluate(refined, x[:, [list(inputs).index(name) for name in refined.input_names]], job)
    job.progress(0, 1, "chances of the outcomes")
    random = np.random.Generator(np.random.PCG64(sampling_seed(study, "capture")))
    drawn = outcome_model(job).draw(x, random)
    outputs, without_scatter = smooth, None
    if study.monte_carlo.scatter:
        speed = touchdown_values(study, inputs, x, "impact.speed")
        generator = np.random.Generator(np.random.PCG64(sampling_seed(study, "scatter")))
        outputs, without_scatter = smooth + Scatter.of(job, refined).draw(speed, generator), smooth
    Samples.of(inputs, refined.output_names, x, outputs, drawn, without_scatter).save(job.folder)


def outcome_model(job: Job) -> "OutcomeModel":
    """The chances of the outcomes, learnt from all runs of the study that have one; a run that failed says nothing.

    Raises ValueError when no run has ended.
    """
    from lithobrake.analysis import OutcomeModel

    inputs = job.design.inputs
    runs = [DesignRuns.load(job.folder, design) for design in PAPER_DESIGNS]
    x = np.concatenate([one.columns(list(inputs)) for one in runs])
    outcomes = [outcome for one in runs for outcome in one.outcomes]
    names = tuple(TouchdownOutcome)
    ended = np.isin(outcomes, names)
    if not ended.any():
        raise ValueError("every run has failed (runs.sqlite has the reasons); remove their cause")
    return OutcomeModel(inputs, x[ended], [outcome for outcome in outcomes if outcome in names], names)


def _evaluate(surrogate: "Surrogate", x: np.ndarray, job: Job) -> np.ndarray:
    outputs = np.empty((len(x), len(surrogate.output_names)))
    for start in range(0, len(x), _BLOCK):
        outputs[start : start + _BLOCK] = surrogate(x[start : start + _BLOCK])
        job.progress(min(start + _BLOCK, len(x)), len(x), "samples")
    return outputs
