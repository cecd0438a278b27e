"""Least and most that an output of a touchdown may be, for runs of which it is not known what became of them."""

import math

import numpy as np

from lithobrake.analysis.missing_runs import Limits
from lithobrake.pipeline.answer.run_answers import unknown_runs
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.energy_bound import bound_of_runs, runs_beyond
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.vocabulary.outcomes import RETURNS

VELOCITY = ("velocity_out_x", "velocity_out_y", "velocity_out_z")
# Outputs that are never below 0, without a largest value.
POSITIVE = ("contact_duration", "peak_acceleration")


def output_limits(job: Job, runs: DesignRuns) -> dict[str, Limits]:
    """By output, and for the return fraction of a run; an output that is not named has no limits.

    Empty where every run has an outcome.

    Speed and spin are limited by the energy of the impact; a study of which a run left with more has no such limits.
    """
    if not unknown_runs(runs).any():
        return {}
    bound = bound_of_runs(job.design, job.folder, runs)
    speed, spin = (bound.speed, bound.spin()) if not runs_beyond(runs, bound) else (np.inf, np.inf)
    found: dict[str, Limits] = {RETURNS: (0.0, 1.0), "speed_out": (0.0, speed), "elevation_out": (0.0, 0.5 * math.pi)}
    found |= {"spin_out": (0.0, spin)} | {name: (-np.asarray(speed), speed) for name in VELOCITY}
    return found | dict.fromkeys(POSITIVE, (0.0, math.inf))
