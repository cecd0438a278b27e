"""The emulator of the drawn runs: fitted, and fitted again to beds drawn with replacement."""

import math
from collections.abc import Mapping, Sequence
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
    from lithobrake.chaos import Distribution
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
    from lithobrake.emulator.training import FEWEST

    runs = DesignRuns.load(job.folder, "drawn")
    left = int(runs.has_outputs.sum())
    if left < FEWEST:
        raise ValueError(
            f"{left} of {runs.run_count} runs left the surface, but an emulator needs {FEWEST}; raise design.run_count"
        )
    values = {name: runs.inputs[name] for name in job.design.inputs}
    bound = energy_bound(job.design, height_of_beds(job.study, job.folder), values, runs.run_count)
    outputs = outputs_of_runs(runs, RIDERS)
    fitted(job, job.design.inputs, runs, outputs, bound, tuple(TouchdownOutcome)).save(job.folder / FILE)


def fitted(
    job: Job,
    inputs: "Mapping[str, Distribution]",
    runs: DesignRuns,
    outputs: dict[str, np.ndarray],
    bound: EnergyBound,
    outcomes: Sequence[str],
) -> "Emulator":
    """The emulator of runs that ended in one of some outcomes; runs of a bed are left out together.

    outputs: by name [run_count], as `outputs_of_runs` gives them. bound: what energy allows each run; it does not count
    where some run left with more.
    """
    from lithobrake import emulator

    ended = np.isin(runs.outcomes, outcomes)
    bed = runs.inputs["bed"].astype(int)[ended]
    upper = np.full((runs.run_count, len(outputs)), np.inf)
    upper[:, list(outputs).index(ELEVATION)] = STEEPEST
    if _is_kept(job, runs, bound):
        upper[:, list(outputs).index(SPEED)], upper[:, list(outputs).index(SPIN)] = bound.speed, bound.spin()
    modelled = (SPEED, ELEVATION, SPIN)
    return emulator.fit(
        inputs,
        runs.columns(list(inputs))[ended],
        np.column_stack(list(outputs.values()))[ended],
        groups=bed if len(np.unique(bed[runs.has_outputs[ended]])) > 1 else None,
        outcome=np.array(runs.outcomes)[ended],
        outcomes=outcomes,
        lower=[0.0 if name in modelled else -np.inf for name in outputs],
        upper=upper[ended],
        riders=[name for name in outputs if name not in modelled],
        output_names=list(outputs),
    )


def _is_kept(job: Job, runs: DesignRuns, bound: EnergyBound) -> bool:
    """Whether every run left within what energy allows; said aloud where some did not."""
    # At the bound of the speed nothing is left for a spin.
    beyond = int((runs.output(SPIN) >= bound.spin(runs.output(SPEED))).sum())
    if beyond:
        job.say(
            f"{beyond} of {runs.run_count} runs left with more speed and spin than the impact energy allows, so the "
            "emulator bounds neither; find the source of energy in the program that simulates the touchdowns, or give "
            "lander.inertia"
        )
    return not beyond


def outputs_of_runs(runs: DesignRuns, riders: Sequence[str]) -> dict[str, np.ndarray]:
    """What the emulator draws, by name [run_count]: NaN in the runs that did not leave, and in no other."""
    left = runs.has_outputs
    found = {name: runs.output(name) for name in (SPEED, ELEVATION, SPIN, *riders)}
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
