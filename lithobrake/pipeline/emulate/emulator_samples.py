"""Samples of a drawn study: draws of the input law through the emulator, outcome, velocity and spin together."""

import numpy as np

from lithobrake.analysis import sample_inputs
from lithobrake.files.hashing import hashed_seed
from lithobrake.pipeline.emulate.drawn_landings import DrawnLandings
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT, refits
from lithobrake.pipeline.emulate.samples import Samples
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.energy_bound import energy_bound, height_of_beds


def draw_emulator_samples(job: Job) -> None:
    """Sample all inputs and draw a landing for each; sample i comes from refit i modulo REFIT_COUNT.

    So every share of the samples has its scatter over refits in itself, and no flight is made for an interval alone.
    """
    study = job.study
    x = sample_inputs(job.design.inputs, study.monte_carlo.sample_count, hashed_seed(study.seed, "samples"))
    drawn_samples(job, x, "draws").save(job.folder)


def drawn_samples(job: Job, x: np.ndarray, purpose: str) -> Samples:
    """Draw a landing at each x [sample_count, input_count]; sample i by refit i modulo that.

    purpose: of the random numbers.
    """
    study, inputs = job.study, job.design.inputs
    bound = energy_bound(job.design, height_of_beds(study, job.folder), dict(zip(inputs, x.T, strict=True)), len(x))
    models = refits(job)
    names: list[str] = []
    outputs, outcome = np.empty((len(x), 0)), np.empty(len(x), dtype=np.uint8)
    for number, model in enumerate(models):
        job.progress(number, len(models), "samples")
        part = slice(number, None, REFIT_COUNT)
        drawn = DrawnLandings.of(model, x[part], bound.at(part), hashed_seed(study.seed, purpose, number))
        table = drawn.table()
        if not names:
            names, outputs = list(table), np.empty((len(x), len(table)))
        outputs[part], outcome[part] = np.column_stack(list(table.values())), drawn.outcome
    return Samples(list(inputs), names, x, outputs, outcome)
