"""Limit states of whole journeys: which of them meet one, with its probability by landings and by the emulator."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lithobrake import analysis
from lithobrake.analysis.ground_spread import share_over_grounds
from lithobrake.analysis.paired_differences import difference_bounds
from lithobrake.analysis.subset_simulation import limit_state_met
from lithobrake.analysis.unseen_event import runs_by_bed
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.correlated_inputs import significant_together
from lithobrake.pipeline.answer.emulated_ends import EmulatedTable
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.mean_miss import mean_miss, offsets
from lithobrake.pipeline.answer.run_answers import is_on_one_ground, why_no_interval
from lithobrake.pipeline.answer.run_estimates import inputs_of_journeys
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.emulated_journeys import FRESH
from lithobrake.pipeline.journeys.touchdown_emulator import why_no_emulator
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.pipeline.study_folder import AGAIN, StudyFolder
from lithobrake.results.questions import LimitStateInput, LimitStateResult
from lithobrake.study import Study
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import SKY_FILE, TOUCHDOWN_EMULATOR_FILE
from lithobrake.vocabulary.journey_names import FACES, JOURNEY_NUMBERS, JOURNEY_WORDS, SKY_HOURS
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.quantities import UNKNOWN_END

Columns = Mapping[str, np.ndarray]
# How a journey ends of which nothing is known.
UNKNOWN = (JourneyEnd.FAILED.value, UNKNOWN_END)
DAY_HOURS = 24.0


def rest_values(end: np.ndarray, numbers: Columns, face: np.ndarray | None = None) -> dict[str, np.ndarray]:
    """What limit states may name of journeys, [count] each: words 1 or 0, and numbers; NaN where it is not known.

    end: how each ended; numbers: columns by their names in journeys.csv, of those at rest; face: the side that is down,
    "" where none is known.
    """
    unknown, rests = np.isin(end, UNKNOWN), end == JourneyEnd.AT_REST
    values = {word: np.where(unknown, np.nan, end == word) for word in JOURNEY_WORDS}
    nothing = np.full(np.shape(end), np.nan)
    values |= {name: np.where(rests, numbers.get(name, nothing), np.nan) for name in JOURNEY_NUMBERS}
    down = np.full(np.shape(end), "") if face is None else face
    # Only what rests has a side down.
    open_ = unknown | (rests & (down == ""))
    return values | {word: np.where(open_, np.nan, rests & (down == side)) for word, side in FACES.items()}


def journeys_met(study: Study, folder: StudyFolder, table: JourneyTable, state: LimitState) -> np.ndarray:
    """Which journeys meet a limit state: 1, 0, or NaN where that is not known, [journey_count]."""
    hours = {name: _hours(folder, table, name) for name in state.journey if name in SKY_HOURS}
    face = None if study.lander.is_ball else table.face
    return limit_state_met(state, rest_values(table.end, {**table.numbers, **hours}, face))


def all_met(study: Study, folder: StudyFolder, table: JourneyTable) -> dict[str, np.ndarray]:
    """The same of every limit state of journeys of a study, by name."""
    states = {name: LimitState.of(text) for name, text in study.limit_states.conditions().items()}
    return {name: journeys_met(study, folder, table, one) for name, one in states.items() if one.journey}


def _hours(folder: StudyFolder, table: JourneyTable, name: str) -> np.ndarray:
    """Hours of 24 in which each lander at rest sees a body, NaN of the others [journey_count]."""
    found = np.full(len(table.end), np.nan)
    # A study of which none rests has nothing to look up.
    rows = read_rows(folder / SKY_FILE, ("journey", "body", "day_fraction"), AGAIN) if table.rests.any() else []
    for row in rows:
        if row["body"] == SKY_HOURS[name] and table.rests[int(row["journey"])]:
            found[int(row["journey"])] = DAY_HOURS * float(row["day_fraction"] or "nan")
    return found


def journey_limit_state(job: Job, name: str, state: LimitState, table: JourneyTable) -> LimitStateResult:
    """The results of one limit state of journeys, without its statement.

    Raises ValueError for one that cannot be decided for any journey.
    """
    met, why = journeys_met(job.study, job.folder, table, state), why_no_interval(job.study)
    if not np.isfinite(met).any():
        raise ValueError(
            f"limit_states.{name} is {state.text!r}, which cannot be decided for any journey (journeys.csv lists how "
            "each ended, and what is known of it); choose another condition"
        )
    found = analysis.failure_probability(met, table.bed, why=why)
    by_runs = replace(found.by_runs, from_=found.by_runs.from_.replace("landing", "journey"))
    # As of the fraction at rest the landings answer, and the emulator stands beside them.
    by_emulator = None if why is not None else _by_emulator(job, state, table)
    is_one = is_on_one_ground(job.study)
    return LimitStateResult(
        condition=state.text,
        probability=found.probability,
        source=found.source,
        runs=by_runs,
        emulator=by_emulator,
        tail_limit=found.tail_limit,
        why=found.by_runs.share.why_missing,
        failing_runs=float(np.nansum(met)),
        inputs=_inputs(job, met, table),
        statement="",
        of_journey=True,
        agrees=_agrees(job.study, by_runs.share, by_emulator),
        radius_m=state.radius,
        if_aimed=_if_aimed(job, state, met, table, why),
        over_grounds=share_over_grounds(met, table.bed, why=why) if is_one else None,
        grounds=_by_kind(job, met, table, why),
    )


def _by_emulator(job: Job, state: LimitState, table: JourneyTable) -> Estimate | None:
    """Share of the fresh landers of the emulator that meet a limit state, of those of known end; bounds hold whatever
    became of the others.

    None where there are too few, or the emulator says nothing of what the limit state names.
    """
    if not job.study.journey.emulated_count or why_no_emulator(job.folder.read_json(TOUCHDOWN_EMULATOR_FILE)):
        return None
    fresh = EmulatedTable.load(job.folder, FRESH)
    met = limit_state_met(state, rest_values(fresh.end, fresh.numbers))
    # Landers of known end of which it cannot be told: their sides, say.
    if not len(met) or np.isnan(met[~np.isin(fresh.end, UNKNOWN)]).any():
        return None
    counts, known = analysis.drawn_counts(met, fresh.refit, REFIT_COUNT)
    if known.min() < 2:
        return None
    totals, fitted = np.bincount(fresh.refit, minlength=REFIT_COUNT), runs_by_bed(table.bed)
    least, most = (analysis.refit_interval(one, totals, *fitted) for one in (counts, counts + totals - known))
    return Estimate(float(counts.sum() / known.sum()), least.lower, most.upper)


def _if_aimed(job: Job, state: LimitState, met: np.ndarray, table: JourneyTable, why: str | None) -> Estimate | None:
    """The probability of resting within a distance of the mean of the landers at rest, by arcs.

    So it would be if all places were turned about the centre until this mean is on the aim point. On unknown ground it
    has the interval of one ground. None for other limit states, and where the mean cannot be told from the aim point.
    """
    miss = None if state.radius is None else mean_miss(job, table)
    if state.radius is None or miss is None or not miss.is_distinct:
        return None
    places = table.of_rest("latitude_deg"), table.of_rest("longitude_deg")
    away = np.linalg.norm(offsets(job.site, *places, (miss.latitude_deg, miss.longitude_deg)), axis=1)
    near = np.where(np.isnan(met), np.nan, table.rests & (away < state.radius))
    if is_on_one_ground(job.study):
        return share_over_grounds(near, table.bed, why=why)
    return analysis.share_estimate(near, table.bed, why=why).share


def _agrees(study: Study, landings: Estimate, emulator: Estimate | None) -> bool | None:
    # Landers of the emulator go on to rest, whatever the landings are followed for.
    if study.journey.touchdowns is not None:
        return None
    bounds = None if emulator is None else difference_bounds(landings, emulator)
    return None if bounds is None else bounds[0] <= 0.0 <= bounds[1]


def _by_kind(job: Job, met: np.ndarray, table: JourneyTable, why: str | None) -> dict[str, Estimate]:
    """The probability on each kind of ground alone; empty for one ground, and where landers meet several."""
    if job.study.ground is None or job.study.ground.unknown != "everywhere":
        return {}
    kinds = np.array([one.kind for one in job.design.grounds.each])[table.bed]
    here = {name: kinds == name for name in job.study.ground.kind}
    return {
        name: analysis.share_estimate(met[own], table.bed[own], why=why).share
        for name, own in here.items()
        if np.isfinite(met[own]).any()
    }


def _inputs(job: Job, met: np.ndarray, table: JourneyTable) -> dict[str, LimitStateInput]:
    """Inputs of the deliveries and first touchdowns among the journeys that meet it; empty on one bed."""
    runs = DesignRuns.load(job.folder, "drawn")
    own = met[runs.inputs["journey"].astype(int)]
    if len(np.unique(runs.inputs["bed"][np.isfinite(own)])) < 2:
        return {}
    inputs = inputs_of_journeys(job, runs)
    laws, x = {name: law for name, (law, _) in inputs.items()}, [values for _, values in inputs.values()]
    if not laws:
        return {}
    found = analysis.failure_inputs(laws, np.column_stack(x), own, runs.inputs["bed"], job.study.seed)
    return significant_together(job.study, found)
