"""The stages of the emulator and its samples."""

from typing import Any

from lithobrake.pipeline.emulate.emulator_samples import draw_emulator_samples
from lithobrake.pipeline.emulate.explorer_tables import FILE as EXPLORER
from lithobrake.pipeline.emulate.explorer_tables import write_explorer
from lithobrake.pipeline.emulate.fitted_emulator import FILE, fit_emulator
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.stage import Stage, same_files
from lithobrake.study import Study

PARTS = (
    "pipeline/emulate",
    "pipeline/runs/energy_bound.py",
    "emulator",
    "chaos",
    "analysis",
    "results/explorer_tables.py",
    "vocabulary/quantities.py",
)


def sample_dependencies(study: Study) -> Any:
    """What the samples depend on beside the model that they are of."""
    return study.monte_carlo.model_dump()


def _fit(job: Job) -> None:
    fit_emulator(job)
    write_explorer(job)


EMULATOR = Stage("emulator", "emulator", same_files(FILE, EXPLORER), _fit, ("runs",), parts=PARTS)
SAMPLE = Stage(
    "sample", "samples", same_files("samples.h5"), draw_emulator_samples, ("emulator",), sample_dependencies, PARTS
)
