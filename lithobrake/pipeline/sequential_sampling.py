"""A sequence that goes on until its answer is as well known as asked: design.half_width.

What comes next follows from the runs that have ended, which the ledger has, and from their flights, which the folder
has. So a study that is stopped and run again goes the same way, and whoever only looks at its folder knows how many
runs it has by now.
"""

from collections.abc import Callable
from dataclasses import replace

from lithobrake.pipeline.answer.answer_of_run import answer_words, answers_of, flown_shares
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.drawn_design import sequence_rows
from lithobrake.pipeline.runs.known_runs import known_runs
from lithobrake.pipeline.runs.touchdown_runs import touchdown_keys
from lithobrake.study import Study


def sequence_keys(study: Study) -> list[str]:
    """The keys in the ledger of the runs of a study's sequence, in order."""
    return touchdown_keys(study, sequence_rows(study), 0)


def grown(study: Study, folder: StudyFolder) -> Study:
    """The study with as many runs as its half width asks for, as far as the runs that have ended can tell."""
    from lithobrake.analysis import next_run_count

    design = study.design
    if design.half_width is None:
        return study
    known, flown = known_runs(study, folder), flown_shares(study, folder)
    while known.keys() & flown.keys() >= set(keys := sequence_keys(study)):
        values, bed = answers_of(keys, known, flown)
        count = next_run_count(values, bed, design.half_width, design.most_runs, _bed_count_of(study))
        if count is None:
            break
        study = study.with_run_count(count)
    return study


def grow(job: Job, make_runs: Callable[[Job], None]) -> Job:
    """Make runs until the half width is met, or there may be no more; give the job of the study with all of them.

    make_runs: makes the runs of the study of a job, with all that they need.
    """
    make_runs(job)
    while (study := grown(job.study, job.folder)).design.run_count > job.study.design.run_count:
        job.say(f"{width_sentence(job)}: going on to {study.design.run_count} runs on {study.bed_count} beds")
        job = replace(job, study=study)
        make_runs(job)
    job.say(f"{width_sentence(job)}: {_end(job)}")
    return job


def width_sentence(job: Job) -> str:
    """How well the answer is known by the runs of a study, beside what is asked."""
    width, design = _width(job), job.study.design
    known = "not known to any width yet" if width is None else f"known to +- {100 * width:.2g} points"
    return (
        f"{answer_words(job.study)} is {known} from {design.run_count} runs on {job.study.bed_count} beds, and "
        f"design.half_width asks for +- {100 * (design.half_width or 0.0):.2g}"
    )


def _end(job: Job) -> str:
    width, design = _width(job), job.study.design
    if width is not None and width <= (design.half_width or 0.0):
        return "that is enough"
    return f"no more are made, since design.largest_run_count is {design.most_runs}"


def _width(job: Job) -> float | None:
    from lithobrake.analysis import half_width_of

    known, flown = known_runs(job.study, job.folder), flown_shares(job.study, job.folder)
    return half_width_of(*answers_of(sequence_keys(job.study), known, flown))


def _bed_count_of(study: Study) -> Callable[[int], int]:
    """On how many beds so many runs of a study come down."""
    return lambda run_count: study.with_run_count(run_count).bed_count
