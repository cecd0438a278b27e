"""The emulator of the drawn runs: fitted, and fitted again to beds drawn with replacement."""

import math
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.files.hashing import hashed_seed
from lithobrake.pipeline.emulate.outgoing import VELOCITY
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.energy_bound import EnergyBound, energy_bound, height_of_beds
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import SPIN_OUT

if TYPE_CHECKING:
    from lithobrake.emulator import Emulator

FILE = "emulator.json"
SPEED, ELEVATION, AZIMUTH, SPIN = "speed_out", "elevation_out", "azimuth_out", "spin_out"
STEEPEST = 0.5 * math.pi
# What is drawn with its run: directions, and numbers beside the motion.
RIDERS = (AZIMUTH, *SPIN_OUT, "contact_duration", "penetration", "peak_acceleration", "energy_lost")
# Fits to beds drawn with replacement: each sample is of one of them and keeps it from bounce to bounce.
REFIT_COUNT = 50
# A lander that leaves straight up, or does not turn, is put this far inside the bounds of what is drawn.
MARGIN = 1e-6


def fit_emulator(job: Job) -> None:
    """Fit the emulator to the drawn runs and write it; a run that failed says nothing."""
    from lithobrake import emulator
    from lithobrake.emulator.training import FEWEST

    runs = DesignRuns.load(job.folder, "drawn")
    inputs, outcomes = job.design.inputs, tuple(TouchdownOutcome)
    ended = np.isin(runs.outcomes, outcomes)
    left = int(runs.has_outputs.sum())
    if left < FEWEST:
        raise ValueError(
            f"{left} of {runs.run_count} runs left the surface, and an emulator needs {FEWEST}; raise design.run_count"
        )
    x, bed = runs.columns(list(inputs)), runs.inputs["bed"].astype(int)[ended]
    outputs = _outputs(runs)
    upper = np.full((runs.run_count, len(outputs)), np.inf)
    upper[:, list(outputs).index(ELEVATION)] = STEEPEST
    if (bound := _kept_bound(job, runs)) is not None:
        upper[:, list(outputs).index(SPEED)], upper[:, list(outputs).index(SPIN)] = bound.speed, bound.spin()
    modelled = [name for name in outputs if name not in RIDERS]
    model = emulator.fit(
        inputs,
        x[ended],
        np.column_stack(list(outputs.values()))[ended],
        groups=bed if len(np.unique(bed[runs.has_outputs[ended]])) > 1 else None,
        outcome=np.array(runs.outcomes)[ended],
        outcomes=outcomes,
        lower=[0.0 if name in modelled else -np.inf for name in outputs],
        upper=upper[ended],
        riders=[name for name in outputs if name not in modelled],
        output_names=list(outputs),
    )
    model.save(job.folder / FILE)


def _kept_bound(job: Job, runs: DesignRuns) -> EnergyBound | None:
    """What energy allows each run; None, said aloud, where some left with more."""
    values = {name: runs.inputs[name] for name in job.design.inputs}
    bound = energy_bound(job.design, height_of_beds(job.study, job.folder), values, runs.run_count)
    # At the bound of the speed nothing is left for a spin.
    beyond = int((runs.output(SPIN) >= bound.spin(runs.output(SPEED))).sum())
    if not beyond:
        return bound
    job.say(
        f"{beyond} of {runs.run_count} runs left with more speed and spin than the energy of their arrival allows, so "
        "the emulator sets both no limit; look for what gives the lander energy in the program that makes the "
        "touchdowns, or give lander.inertia"
    )
    return None


def _outputs(runs: DesignRuns) -> dict[str, np.ndarray]:
    """What the emulator draws, by name [run_count]: NaN in the runs that did not leave, and in no other."""
    left = runs.has_outputs
    found = {name: runs.output(name) for name in (SPEED, ELEVATION, SPIN, *RIDERS)}
    _, across, _ = VELOCITY
    found[AZIMUTH] = np.arctan2(runs.output(across), runs.output(VELOCITY[0]))
    found[ELEVATION] = np.clip(found[ELEVATION], MARGIN * STEEPEST, (1.0 - MARGIN) * STEEPEST)
    found[SPIN] = np.maximum(found[SPIN], MARGIN * max(float(np.max(found[SPIN][left], initial=0.0)), MARGIN))
    # A program of the user's own may leave out what no flight needs.
    return {name: np.where(left, y, np.nan) for name, y in found.items() if np.isfinite(y[left]).all()}


def refits(job: Job) -> "list[Emulator]":
    """The emulator fitted anew to beds drawn with replacement, the same ones at every call."""
    from lithobrake import emulator

    return emulator.load(job.folder / FILE).refits(REFIT_COUNT, hashed_seed(job.study.seed, "refits"))
