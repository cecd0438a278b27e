"""Monte Carlo on the refined expansion: what leaves the surface, how fast and where to, and what stays."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.atomic import atomic_path
from lithobrake.pipeline.expansions import DESIGNS, DesignRuns, design_inputs, design_runs
from lithobrake.pipeline.folder import StudyFolder, json_hash
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.scatter import Scatter
from lithobrake.quantity import median
from lithobrake.study import Study

if TYPE_CHECKING:
    from lithobrake.analysis import CaptureModel
    from lithobrake.chaos import Surrogate

FORMAT_VERSION = 1
# Points at which the expansion is evaluated at once; between two blocks progress is shown.
_BLOCK = 1 << 20


@dataclass(frozen=True)
class Samples:
    """Samples of the Monte Carlo.

    inputs [sample_count, input_count], in the file's units; outputs [sample_count, output_count], SI, in the local
    frame; captured [sample_count]: by the draw of the capture probability; stays [sample_count]: captured, or without
    outward velocity; without_scatter: the outputs of the expansion alone, where scatter was added, else None.
    """

    input_names: list[str]
    output_names: list[str]
    inputs: np.ndarray
    outputs: np.ndarray
    capture_probability: np.ndarray
    captured: np.ndarray
    stays: np.ndarray
    without_scatter: np.ndarray | None = None

    def output(self, name: str) -> np.ndarray:
        """One output, shape [sample_count]."""
        return self.outputs[:, self.output_names.index(name)]

    def expansion_alone(self) -> "Samples":
        """The samples without the scatter from run to run; themselves where none was added."""
        if self.without_scatter is None:
            return self
        outward = self.without_scatter[:, self.output_names.index("velocity_out_z")] > 0
        stays = self.captured | ~outward
        return replace(self, outputs=self.without_scatter, stays=stays, without_scatter=None)

    def save(self, folder: StudyFolder) -> None:
        """Write samples.h5."""
        import h5py

        with atomic_path(folder / "samples.h5") as draft, h5py.File(draft, "w") as file:
            for name in ("inputs", "outputs", "capture_probability", "captured", "stays"):
                file.create_dataset(name, data=getattr(self, name))
            if self.without_scatter is not None:
                file.create_dataset("without_scatter", data=self.without_scatter)
            file.attrs["format_version"] = FORMAT_VERSION
            file.attrs["input_names"], file.attrs["output_names"] = self.input_names, self.output_names

    @classmethod
    def load(cls, folder: StudyFolder) -> "Samples":
        """Read samples.h5."""
        import h5py

        with h5py.File(folder / "samples.h5") as file:
            arrays = {name: data[()] for name, data in file.items()}
            return cls(list(file.attrs["input_names"]), list(file.attrs["output_names"]), **arrays)


def sampling_seed(study: Study, purpose: str) -> int:
    """Seed of the random numbers of one purpose."""
    return int(json_hash([study.seed, purpose])[:12], 16)


def draw_samples(job: Job) -> None:
    """Sample all inputs, evaluate the expansion, and decide for each sample whether the lander stays."""
    from lithobrake.analysis import sample_inputs
    from lithobrake.chaos import load

    study, inputs = job.study, design_inputs(job.study)
    refined = load(job.folder / "refined.json")
    x = sample_inputs(inputs, study.monte_carlo.sample_count, sampling_seed(study, "samples"))
    smooth = _evaluate(refined, x[:, [list(inputs).index(name) for name in refined.input_names]], job)
    job.progress(0, 1, "chance of capture")
    probability = capture_model(job, refined).probability(x)
    draws = np.random.Generator(np.random.PCG64(sampling_seed(study, "capture"))).random(len(x))
    is_captured, outputs, without_scatter = draws < probability, smooth, None
    if study.monte_carlo.scatter:
        speed = touchdown_values(study, inputs, x, "impact.speed")
        generator = np.random.Generator(np.random.PCG64(sampling_seed(study, "scatter")))
        outputs, without_scatter = smooth + Scatter.of(job, refined).draw(speed, generator), smooth
    outward = outputs[:, refined.output_names.index("velocity_out_z")] > 0
    stays = is_captured | ~outward
    Samples(list(inputs), refined.output_names, x, outputs, probability, is_captured, stays, without_scatter).save(
        job.folder
    )


def touchdown_values(study: Study, inputs: Iterable[str], x: np.ndarray, name: str) -> np.ndarray:
    """One touchdown value in the file's units, shape [sample_count]: its column of x, or what the study fixes it to.

    x: [sample_count, input_count], of the inputs in their order.
    """
    columns = list(inputs)
    if name in columns:
        drawn: np.ndarray = x[:, columns.index(name)]
        return drawn
    return np.full(len(x), median(study.touchdown_values()[name]))


def capture_model(job: Job, refined: "Surrogate") -> "CaptureModel":
    """The chance of capture, learnt from all runs of the study."""
    from lithobrake.analysis import CaptureModel

    runs = [design_runs(job, design, refined.input_names) for design in DESIGNS]
    return CaptureModel(design_inputs(job.study), *capture_runs(runs))


def capture_runs(designs: list[DesignRuns]) -> tuple[np.ndarray, np.ndarray]:
    """Points of all runs that ended clear or captured [run_count, input_count], and which were captured [run_count].

    A run that failed, left sideways or ran out of time says nothing about capture. Raises ValueError when none says.
    """
    x = np.concatenate([design.x for design in designs])
    outcomes = np.array([outcome for design in designs for outcome in design.runs.outcomes])
    says = np.isin(outcomes, ("clear", "captured"))
    if not says.any():
        raise ValueError("no run ended clear or captured (see runs.sqlite); raise landing.time_limit or widen the bed")
    return x[says], outcomes[says] == "captured"


def _evaluate(surrogate: "Surrogate", x: np.ndarray, job: Job) -> np.ndarray:
    outputs = np.empty((len(x), len(surrogate.output_names)))
    for start in range(0, len(x), _BLOCK):
        outputs[start : start + _BLOCK] = surrogate(x[start : start + _BLOCK])
        job.progress(min(start + _BLOCK, len(x)), len(x), "samples")
    return outputs
