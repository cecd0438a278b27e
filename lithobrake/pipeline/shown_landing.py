"""One landing of a study to look at, with its pictures."""

from typing import Any

from lithobrake.pipeline.beds import bed_files, touchdown_reads
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.kernels import compile_kernels
from lithobrake.pipeline.sequence import sequence_rows
from lithobrake.study import Study
from lithobrake.touchdown_model import draw, in_words_of_the_study, lander, landing, medians, stored_bed

SNAPSHOT_FRAMES = 120


def landing_files(study: Study) -> list[str]:
    """Name of the file of the landing to look at."""
    return [] if not study.has_soil else ["landing.h5"]


def landing_reads(study: Study) -> dict[str, Any]:
    """What the landing to look at depends on."""
    return {"touchdown": touchdown_reads(study), "values": landing_values(study)}


def landing_values(study: Study) -> dict[str, float]:
    """All inputs of the landing to look at: the first run of a sequence, or that at the medians of all inputs."""
    if study.design.method == "paper":
        return draw(study, medians(study), study.seed)
    return sequence_rows(study, 1)[0]


def land_once(job: Job) -> None:
    """Land once and keep the pictures."""
    from lithobrake.touchdown import land

    compile_kernels(job)
    values = landing_values(job.study)
    bed = stored_bed(job.folder / bed_files(job.study)[round(values["bed"])])
    with in_words_of_the_study():
        body, arrival = lander(job.study, values), landing(job.study, values)
        outcome = land(bed, body, arrival, SNAPSHOT_FRAMES, lambda fraction, what: job.progress(fraction, 1.0, what))
    outcome.save_frames(job.folder / "landing.h5", bed, body, arrival)
