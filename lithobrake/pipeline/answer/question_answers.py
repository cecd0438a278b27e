"""What the study file asks for: the probability of each limit state."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lithobrake import analysis
from lithobrake.analysis.subset_simulation import limit_state_met
from lithobrake.pipeline.answer.correlated_inputs import independent_columns, significant_together
from lithobrake.pipeline.answer.emulated_ends import sample_fates
from lithobrake.pipeline.answer.journey_ends import JourneyTable
from lithobrake.pipeline.answer.journey_limit_states import journey_limit_state
from lithobrake.pipeline.answer.run_answers import failing_runs, left_in_flight, why_no_interval
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.first_touchdown.flights import read_table
from lithobrake.pipeline.first_touchdown.run_flights import RunFlights
from lithobrake.pipeline.first_touchdown.samples import Samples
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.questions import LimitStateResult
from lithobrake.results.run_results import CountedShare
from lithobrake.statements import limits
from lithobrake.study import Study
from lithobrake.vocabulary import outcomes
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.file_names import SAMPLE_FLIGHTS_FILE
from lithobrake.vocabulary.limit_state import LimitState


def limit_state_results(
    job: Job, shares: Mapping[str, CountedShare], ends: Mapping[str, CountedShare]
) -> dict[str, LimitStateResult]:
    """The results of every limit state of a study, by its name.

    shares, ends: the tables of how landings (`run_shares`) and journeys end, from which a limit state of one of their
    words has its numbers.

    Raises ValueError for an output that no run has.
    """
    study, folder = job.study, job.folder
    conditions = study.limit_states.conditions()
    if not conditions:
        return {}
    runs, fates = DesignRuns.load(folder, "drawn"), RunFlights.load(folder, "drawn").fates
    of_samples, table = _values_of_samples(job), JourneyTable.load(folder)
    states = {name: LimitState.of(text) for name, text in conditions.items()}
    found = {}
    for name, state in states.items():
        if state.journey:
            one = journey_limit_state(job, name, state, table)
            # The shares of ends count a failed journey as one that met none of the others.
            of_word = None if one.runs.missing > 0.0 else _of_one_word(state, ends)
        else:
            one, of_word = _one(study, name, state, runs, fates, of_samples), _of_one_word(state, shares)
        if of_word is not None:
            one = replace(one, probability=of_word, runs=replace(one.runs, share=of_word))
        found[name] = replace(one, statement=limits.limit_state(name, one))
    return found


def _one(
    study: Study, name: str, state: LimitState, runs: DesignRuns, fates: np.ndarray, of_samples: dict[str, np.ndarray]
) -> LimitStateResult:
    """The results of one limit state, without its statement."""
    for output in state.outputs:
        if not np.isfinite(runs.output(output)).any():
            raise ValueError(
                f"limit_states.{name} uses {output}, which no run has; have the program that simulates the touchdowns "
                "return it, or leave the limit state out"
            )
    failing, inputs = failing_runs(state, runs, fates), DrawnDesign(study).lawful_inputs
    if not np.isfinite(failing).any():
        raise ValueError(
            f"limit_states.{name} is {state.text!r}, which cannot be decided for any run (runs.sqlite lists how each "
            "ended); choose another condition, or correct the outcomes"
        )
    x, apart = runs.columns(list(inputs)), independent_columns(study, {name: runs.inputs[name] for name in inputs})
    found = analysis.failure_probability(
        failing,
        runs.inputs["bed"],
        terms=analysis.regression_terms(inputs, apart),
        drawn=_drawn(state, of_samples),
        like_missing=left_in_flight(runs),
        why=why_no_interval(study),
    )
    several = len(np.unique(runs.inputs["bed"][np.isfinite(failing)])) > 1
    of_inputs = analysis.failure_inputs(inputs, x, failing, runs.inputs["bed"], study.seed) if several else {}
    return LimitStateResult(
        condition=state.text,
        probability=found.probability,
        source=found.source,
        runs=found.by_runs,
        emulator=found.by_emulator,
        tail_limit=found.tail_limit,
        why=found.by_runs.share.why_missing,
        failing_runs=float(np.nansum(failing)),
        inputs=significant_together(study, of_inputs),
        statement="",
    )


def _of_one_word(state: LimitState, shares: Mapping[str, CountedShare]) -> Estimate | None:
    """Probability and bounds of a limit state that is a fate, or its opposite; None of another."""
    words = (*state.fates, *state.journey)
    if state.outputs or len(words) != 1 or words[0] not in shares:
        return None
    (word,) = words
    one = shares[word].share
    so, otherwise = (
        limit_state_met(state, {outcomes.CAPTURED: np.full(1, end), word: np.full(1, end)})[0] for end in (1.0, 0.0)
    )
    if so == otherwise:
        return None
    if otherwise:
        lower, upper = (None if end is None else 1.0 - end for end in (one.upper, one.lower))
        return Estimate(1.0 - one.value, lower, upper)
    return one


def _values_of_samples(job: Job) -> dict[str, np.ndarray]:
    """What limit states may name, of the samples of the emulator up to the last that was looked at; empty without any.

    NaN where it is not known what became of a sample.
    """
    if not job.study.sample_count or job.study.expansion is not None:
        return {}
    samples, holds = Samples.load(job.folder), job.site.holds
    met = sample_fates(samples, read_table(job.folder, SAMPLE_FLIGHTS_FILE), holds=holds)
    total = len(met["returns"])
    known = ~met["missing"]
    words = {status.value: met[status] for status in outcomes.FlightStatus}
    captured = met[outcomes.SampleOutcome.CAPTURED]
    words |= {
        outcomes.RETURNS: met["returns"],
        outcomes.CAPTURED: captured,
        outcomes.SETTLED: captured & holds,
        outcomes.LOFTED: captured & (not holds),
    }
    values = {name: samples.output(name)[:total] for name in samples.output_names}
    return values | {word: np.where(known, one.astype(float), np.nan) for word, one in words.items()}


def _drawn(state: LimitState, values: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray] | None:
    """How many samples of each refit meet a limit state, and how many are known; None where the runs alone are asked.

    Of a fate alone the flights of the runs are an estimate already, that of results.shares. And the emulator samples no
    outputs of landers that are captured: where one decides, only the runs can tell.
    """
    if not state.outputs or any(name not in values for name in state.outputs):
        return None
    met, refit = limit_state_met(state, values), np.arange(len(values[outcomes.CAPTURED])) % REFIT_COUNT
    if np.isnan(met[values[outcomes.CAPTURED] == 1.0]).any():
        return None
    drawn = analysis.drawn_counts(met, refit, REFIT_COUNT)
    # Of so few samples no scatter between refits can be told.
    return drawn if drawn[1].min() >= 2 else None
