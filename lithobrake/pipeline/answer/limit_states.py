"""What the study file asks for under [limit_states]: the probability of each, and which inputs make the failures."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from lithobrake.analysis import drawn_counts, failure_inputs, failure_probability, regression_terms
from lithobrake.analysis.limit_state_evaluation import limit_state_met
from lithobrake.pipeline.answer.dispersion_statistics import Rows
from lithobrake.pipeline.answer.drawn_answer import limit_statement
from lithobrake.pipeline.answer.failing_runs import CAPTURED, failing_runs
from lithobrake.pipeline.answer.missing_landings import left_in_flight
from lithobrake.pipeline.answer.scope import why_no_interval
from lithobrake.pipeline.answer.shares_over_refits import sample_fates
from lithobrake.pipeline.answer.typed_estimates import limit_state
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.emulate.samples import Samples
from lithobrake.pipeline.fly.run_flights import RunFlights
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.limit_state_results import LimitStateResult
from lithobrake.results.shares import CountedShare, ShareInterval
from lithobrake.study import Study
from lithobrake.vocabulary.limit_state import LOFTED, RETURNS, SETTLED, LimitState
from lithobrake.vocabulary.outcomes import FlightStatus, SampleOutcome


def limit_state_results(
    study: Study, folder: StudyFolder, flights: Rows, shares: Mapping[str, CountedShare], *, holds: bool
) -> dict[str, LimitStateResult]:
    """The results of every limit state of a study, by its name; holds: whether the site holds what lies there.

    shares: the table of how landings end (`run_shares`), from which a limit state of one of its words has its numbers.

    Raises ValueError for an output that no run has.
    """
    conditions = study.limit_states.conditions()
    if not conditions:
        return {}
    runs, samples = DesignRuns.load(folder, "drawn"), Samples.load(folder)
    fates = RunFlights.load(folder, "drawn").fates
    of_samples = _values_of_samples(samples, sample_fates(samples, flights, holds=holds), holds=holds)
    states = {name: LimitState.of(text) for name, text in conditions.items()}
    found = {}
    for name, state in states.items():
        one, of_word = _one(study, name, state, runs, fates, of_samples), _of_one_word(state, shares)
        if of_word is not None:
            one = replace(one, probability=of_word.share, lower=of_word.lower, upper=of_word.upper)
            one = replace(one, runs=replace(one.runs, **vars(of_word)))
        found[name] = replace(one, statement=limit_statement(name, one))
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
    failing, inputs = failing_runs(state, runs, fates), DrawnDesign(study).inputs
    if not np.isfinite(failing).any():
        raise ValueError(
            f"limit_states.{name} is {state.text!r}, which cannot be decided for any run (runs.sqlite lists how each "
            "ended); choose another condition, or correct the outcomes"
        )
    x = runs.columns(list(inputs))
    found = failure_probability(
        failing,
        runs.inputs["bed"],
        terms=regression_terms(inputs, x),
        drawn=_drawn(state, of_samples),
        like_missing=left_in_flight(runs),
        why=why_no_interval(study),
    )
    several = len(np.unique(runs.inputs["bed"][np.isfinite(failing)])) > 1
    of_inputs = failure_inputs(inputs, x, failing, runs.inputs["bed"], study.seed) if several else {}
    return limit_state(state.text, found, float(np.nansum(failing)), of_inputs)


def _of_one_word(state: LimitState, shares: Mapping[str, CountedShare]) -> ShareInterval | None:
    """Probability and bounds of a limit state that is a fate, or its opposite; None of another."""
    if state.outputs or len(state.fates) != 1:
        return None
    (word,) = state.fates
    one = shares[word]
    so, otherwise = (
        limit_state_met(state, {CAPTURED: np.full(1, end), word: np.full(1, end)})[0] for end in (1.0, 0.0)
    )
    if so == otherwise:
        return None
    if otherwise:
        lower, upper = (None if end is None else 1.0 - end for end in (one.upper, one.lower))
        return ShareInterval(1.0 - one.share, lower, upper)
    return ShareInterval(one.share, one.lower, one.upper)


def _values_of_samples(samples: Samples, met: dict[str, np.ndarray], *, holds: bool) -> dict[str, np.ndarray]:
    """What limit states may name, of the samples up to the last that was looked at, and which of them are known."""
    total = len(met["returns"])
    known = ~met["missing"]
    words = {status.value: met[status] for status in FlightStatus}
    captured = met[SampleOutcome.CAPTURED]
    words |= {RETURNS: met["returns"], CAPTURED: captured, SETTLED: captured & holds, LOFTED: captured & (not holds)}
    values = {name: samples.output(name)[:total] for name in samples.output_names}
    return values | {word: np.where(known, one.astype(float), np.nan) for word, one in words.items()}


def _drawn(state: LimitState, values: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray] | None:
    """How many samples of each refit meet a limit state, and how many are known; None where the runs alone are asked.

    Of a fate alone the flights of the runs are an estimate already, that of results.shares. And the emulator samples no
    outputs of landers that are captured: where one decides, only the runs can tell.
    """
    if not state.outputs or any(name not in values for name in state.outputs):
        return None
    met, refit = limit_state_met(state, values), np.arange(len(values[CAPTURED])) % REFIT_COUNT
    if np.isnan(met[values[CAPTURED] == 1.0]).any():
        return None
    drawn = drawn_counts(met, refit, REFIT_COUNT)
    # Of so few samples no scatter between refits can be told.
    return drawn if drawn[1].min() >= 2 else None
