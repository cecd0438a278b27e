"""Sequential sampling: runs are added until the half-width of the answer is that of design.half_width.

What comes next follows from the runs that have ended, which the ledger has, and from their flights, which the folder
has. So a study that is stopped and run again goes the same way, and whoever only looks at its folder knows how many
runs it has by now.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from lithobrake.analysis import half_width_of, next_run_count
from lithobrake.analysis.subset_simulation import limit_state_met
from lithobrake.campaign import Record
from lithobrake.pipeline.answer import run_answers
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.journey_limit_states import journeys_met, rest_values
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown.run_flights import RUN_FLIGHTS_FILE, RunFlights
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.outdated_files import stage_keys
from lithobrake.pipeline.runs.landings import known_runs
from lithobrake.pipeline.runs.run_table import DesignRuns, file_of
from lithobrake.pipeline.stages import RUNS
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.study import Study
from lithobrake.vocabulary.file_names import JOURNEYS_FILE
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.outcomes import FlightStatus


def flown_shares(study: Study, folder: StudyFolder) -> dict[str, float]:
    """Share of its flights with which each drawn run of a study answers, by key, NaN where it has no answer.

    Of a study with more or fewer runs too: a run flies from the same sites in all of them. None at all where the file
    is not there or not whole, or was made otherwise than the study says.
    """
    state = _asked_state(study)
    if run_answers.answers_rest(study) or (state is not None and state.journey):
        return _of_journeys(study, folder, state)
    key = folder.key_of(RUN_FLIGHTS_FILE)
    if key is None:
        return {}
    shares = run_answers.read_shares(folder)
    # The file is of the number of runs that there were, which enters its key; two is the least that a study has.
    made_for = study.with_run_count(max(len(shares), 2))
    if stage_keys(made_for)[run_answers.ANSWERED_AFTER] != key:
        return {}
    return shares if state is None else _failing_shares(state, folder)


def _asked_state(study: Study) -> LimitState | None:
    """The limit state that the half width is asked of; None for another answer."""
    name = study.design.half_width_of
    return None if name is None else LimitState.of(study.limit_states.conditions()[name])


def _of_journeys(study: Study, folder: StudyFolder, state: LimitState | None) -> dict[str, float]:
    """1 for each journey that meets a limit state and 0 for each other, by the key of its first touchdown.

    state: None for that of coming to rest. Journeys without a touchdown are left out: `answers_of_design` adds them.
    """
    key = folder.key_of(JOURNEYS_FILE)
    if key is None or folder.key_of(file_of("drawn")) is None:
        return {}
    keys, table = DesignRuns.load(folder, "drawn").keys, JourneyTable.load(folder)
    if stage_keys(study.with_run_count(max(len(table.end), 2)))[RUNS.name] != key:
        return {}
    met = table.told(table.rests) if state is None else journeys_met(study, folder, table, state)
    return dict(zip(keys, met[table.numbers["touchdowns"] > 0.0].tolist(), strict=True))


def answers_of_design(
    design: DrawnDesign, known: Mapping[str, Record], flown: Mapping[str, float]
) -> tuple[np.ndarray, np.ndarray]:
    """`run_answers.answers_of` of the runs of a design, and of the landers that are flown and never touch down."""
    values, bed = run_answers.answers_of(design.keys, known, flown)
    aloft, bed_of_aloft = answers_aloft(design)
    return np.concatenate([values, aloft]), np.concatenate([bed, bed_of_aloft])


def answers_aloft(design: DrawnDesign) -> tuple[np.ndarray, np.ndarray]:
    """The answer of each lander that is flown to the ground and never touches down, and its bed, both [count].

    None of them rests or returns. A limit state of journeys may hold for them, by the end of the flight; one of first
    touchdowns, which they do not have, is not known of them.
    """
    if design.descents is None:
        return np.empty(0), np.empty(0)
    from lithobrake.smallbody.landers import ENDS

    aloft, state = ~design.descents.touches_down, _asked_state(design.study)
    bed = np.array(design.beds, dtype=float)[aloft]
    if state is None:
        return np.zeros(len(bed)), bed
    if not state.journey:
        return np.full(len(bed), np.nan), bed
    end = np.array(
        [str(ENDS[FlightStatus(word)]) for word in design.descents.flights.status[aloft].tolist()], dtype=str
    )
    return limit_state_met(state, rest_values(end, {})), bed


def _failing_shares(state: LimitState, folder: StudyFolder) -> dict[str, float]:
    """Share of its flights in which each run meets the limit state that the half width is asked of, by key."""
    if folder.key_of(file_of("drawn")) is None:
        return {}
    runs, fates = DesignRuns.load(folder, "drawn"), RunFlights.load(folder, "drawn").fates
    if runs.run_count != len(fates):
        # More runs have been made since, which have not flown.
        return {}
    return dict(zip(runs.keys, run_answers.failing_runs(state, runs, fates).tolist(), strict=True))


def grown(design: DrawnDesign, folder: StudyFolder) -> DrawnDesign:
    """The design with as many runs as its half width asks for, as far as the runs that have ended can tell."""
    study, asked = design.study, design.study.design
    if asked.half_width is None:
        return design
    known, flown = known_runs(study, folder), flown_shares(study, folder)
    # More than one step where a folder has runs of a larger count already.
    while known.keys() & flown.keys() >= set(design.keys):
        values, bed = answers_of_design(design, known, flown)
        count = next_run_count(values, bed, asked.half_width, asked.most_runs, _bed_count_of(study))
        if count is None:
            break
        design = design.with_run_count(count)
    return design


def grow(job: Job, make_runs: Callable[[Job], None]) -> Job:
    """Make runs until the half width is met, or there may be no more; give the job of the study with all of them.

    make_runs: makes the runs of the study of a job, with all that they need.
    """
    make_runs(job)
    while len((design := grown(job.design, job.folder)).beds) > len(job.design.beds):
        job.say(f"{width_sentence(job)}: going on to {len(design.beds)} runs on {design.study.bed_count} beds")
        job = replace(job, design=design)
        make_runs(job)
    job.say(f"{width_sentence(job)}: {_end(job)}")
    return job


def width_sentence(job: Job) -> str:
    width, design = _width(job), job.study.design
    known = "not known within any bound yet" if width is None else f"known to +- {100 * width:.2g} points"
    return (
        f"{run_answers.answer_words(job.study)} is {known} from {design.run_count} runs on {job.study.bed_count} beds, "
        f"and design.half_width asks for +- {100 * (design.half_width or 0.0):.2g}"
    )


def _end(job: Job) -> str:
    width, design = _width(job), job.study.design
    if width is not None and width <= (design.half_width or 0.0):
        return "that is enough"
    return f"no more are made, since design.largest_run_count is {design.most_runs}"


def _width(job: Job) -> float | None:
    known, flown = known_runs(job.study, job.folder), flown_shares(job.study, job.folder)
    return half_width_of(*answers_of_design(job.design, known, flown))


def _bed_count_of(study: Study) -> Callable[[int], int]:
    return lambda run_count: study.with_run_count(run_count).bed_count
