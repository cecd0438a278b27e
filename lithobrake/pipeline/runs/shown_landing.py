"""Landings of a study to look at, with their pictures: one before all runs, and one that the runs say is telling."""

from typing import Any

import numpy as np

from lithobrake.pipeline.design.dependencies import bed_files, touchdown_dependencies
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.kernels import compile_kernels
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.study import Study
from lithobrake.study.touchdown_model import draw, in_words_of_the_study, lander, landing, stored_bed
from lithobrake.vocabulary.outcomes import TouchdownOutcome

SNAPSHOT_FRAMES = 120
FIRST, TELLING = "landing.h5", "telling_landing.h5"


def landing_files(study: Study) -> list[str]:
    """Name of the file of the landing to look at before all runs."""
    return [FIRST] if study.has_soil else []


def telling_files(study: Study) -> list[str]:
    """Name of the file of the landing that the runs have shown to be telling."""
    return [TELLING] if study.has_soil and study.design.method == "drawn" else []


def landing_dependencies(study: Study) -> dict[str, Any]:
    """What the landing to look at depends on."""
    return {"touchdown": touchdown_dependencies(study), "values": landing_values(DrawnDesign(study))}


def landing_values(design: DrawnDesign) -> dict[str, float]:
    """All inputs of the landing to look at: the first drawn run, or that at the medians of all inputs."""
    if design.study.design.method == "paper":
        return draw(design.study, design.medians, design.study.seed)
    return design.shown_row


def land_once(job: Job) -> None:
    """Land once before all runs and keep the pictures."""
    compile_kernels(job.progress)
    _land(job, landing_values(job.design), FIRST)


def land_tellingly(job: Job) -> None:
    """Make the telling run again, for its pictures.

    Says where it comes out otherwise than as a run: another machine may have made that.
    """
    runs = DesignRuns.load(job.folder, "drawn")
    row = telling_run(runs)
    ended = _land(job, job.design.rows[row], TELLING, run=runs.keys[row])
    if ended != runs.outcomes[row]:
        job.say(f"the landing shown, run {runs.keys[row][:8]}, ended as {ended} here: {runs.outcomes[row]} as a run")


def telling_run(runs: DesignRuns) -> int:
    """The row of the run with the median speed [m/s] of those that leave, of two the slower; of none, the first.

    First that has ended: a run that failed has nothing to show.
    """
    left = np.flatnonzero(runs.has_outputs)
    if len(left):
        by_speed = left[np.argsort(runs.output("speed_out")[left], kind="stable")]
        return int(by_speed[(len(left) - 1) // 2])
    return next(row for row, outcome in enumerate(runs.outcomes) if outcome in list(TouchdownOutcome))


def _land(job: Job, values: dict[str, float], file: str, **notes: str) -> str:
    """Land with all these inputs, keep the pictures with notes, and return how it ended."""
    from lithobrake.touchdown import land

    bed = stored_bed(job.folder / bed_files(job.study)[round(values["bed"])])
    with in_words_of_the_study():
        body, arrival = lander(job.study, values), landing(job.study, values)
        outcome = land(bed, body, arrival, SNAPSHOT_FRAMES, lambda fraction, what: job.progress(fraction, 1.0, what))
    outcome.save_frames(job.folder / file, bed, body, arrival, **notes)
    return str(outcome.status)
