"""What the study file asks for under [limit_states]: the probability of each, and which inputs make the failures."""

from typing import Any

import numpy as np

from lithobrake.analysis import drawn_counts, failure_inputs, failure_probability, regression_terms
from lithobrake.outcomes import FlightStatus, SampleOutcome, TouchdownOutcome
from lithobrake.outputs import TOUCHDOWN
from lithobrake.pipeline.design_runs import DesignRuns
from lithobrake.pipeline.designs import design_inputs
from lithobrake.pipeline.dispersion_statistics import Rows
from lithobrake.pipeline.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.folder import StudyFolder
from lithobrake.pipeline.run_flights import FATES as RUN_FATES
from lithobrake.pipeline.run_flights import FLIGHT_COUNT, RunFlights
from lithobrake.pipeline.run_flights import STAYS as STAYING
from lithobrake.pipeline.samples import Samples
from lithobrake.pipeline.scope import why_no_interval
from lithobrake.pipeline.shares_over_refits import sample_fates
from lithobrake.study import Study
from lithobrake.study.limit_state import FATES, STAYS, LimitState

CAPTURED = TouchdownOutcome.CAPTURED.value
# Words of a run that its touchdown alone decides; all others take flights.
OF_TOUCHDOWN = (CAPTURED,)


def limit_state_results(study: Study, folder: StudyFolder, flights: Rows, *, holds: bool) -> dict[str, Any]:
    """The results of every limit state of a study, by its name; holds: whether the site holds what lies there.

    Raises ValueError for an output that no run has.
    """
    conditions = study.limit_states.conditions()
    if not conditions:
        return {}
    runs, samples = DesignRuns.load(folder, "sequence"), Samples.load(folder)
    fates = RunFlights.load(folder, "sequence").fates
    of_samples = _values_of_samples(samples, sample_fates(samples, flights, holds=holds))
    return {name: _one(study, name, LimitState.of(text), runs, fates, of_samples) for name, text in conditions.items()}


def _one(
    study: Study,
    name: str,
    state: LimitState,
    runs: DesignRuns,
    fates: np.ndarray,
    of_samples: dict[str, np.ndarray],
) -> dict[str, Any]:
    """The results of one limit state."""
    for output in state.outputs:
        if not np.isfinite(runs.output(output)).any():
            raise ValueError(
                f"limit_states.{name} asks for {output}, which no run has; let the program that makes the touchdowns "
                "give it, or leave the limit state out"
            )
    failing, inputs = failing_runs(state, runs, fates), design_inputs(study)
    if not np.isfinite(failing).any():
        raise ValueError(
            f"limit_states.{name} is {state.text!r}, of which no run is known to meet it or not (runs.sqlite has how "
            "each ended); ask for something else, or mend what the runs say"
        )
    x = runs.columns(list(inputs))
    found = failure_probability(
        failing,
        runs.inputs["bed"],
        terms=regression_terms(inputs, x),
        drawn=_drawn(state, of_samples),
        flight_count=FLIGHT_COUNT if set(state.fates) - set(OF_TOUCHDOWN) else None,
        why=why_no_interval(study),
    )
    several = len(np.unique(runs.inputs["bed"][np.isfinite(failing)])) > 1
    of_inputs = failure_inputs(inputs, x, failing, runs.inputs["bed"], study.seed) if several else {}
    return {
        "condition": state.text,
        **found.summary(),
        "failing_runs": float(np.nansum(failing)),
        "inputs": {key: one.summary() for key, one in of_inputs.items()},
    }


def failing_runs(state: LimitState, runs: DesignRuns, fates: np.ndarray) -> np.ndarray:
    """Share of the flights of each run that meet a limit state, NaN where nobody knows, [run_count].

    fates [run_count, len(RUN_FATES)]: how many of its flights ended so.
    """
    outcomes = np.array(runs.outcomes)
    values = {name: runs.output(name) for name in TOUCHDOWN}
    # A run without a known end was neither captured nor not.
    ended = np.isin(outcomes, [TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED])
    values[CAPTURED] = np.where(ended, (outcomes == CAPTURED).astype(float), np.nan)
    unflown = {word: np.full(runs.run_count, np.nan) for word in FATES if word != CAPTURED}
    found = state.met(values | unflown)
    counts = fates.sum(axis=1)
    if set(state.fates) <= set(OF_TOUCHDOWN) or not counts.any():
        return found
    by_fate = np.column_stack([state.met(values | _words(fate, runs.run_count)) for fate in RUN_FATES])
    met = np.where(fates > 0, fates * by_fate, 0.0).sum(axis=1)
    return np.where(counts > 0, met / np.maximum(counts, 1), found)


def _words(fate: str, count: int) -> dict[str, np.ndarray]:
    """Whether each word of the grammar holds of flights that ended so, [count] each; `captured` is of the touchdown."""
    held = {status.value: status == fate for status in FlightStatus} | {STAYS: fate in STAYING}
    return {word: np.full(count, float(one)) for word, one in held.items()}


def _values_of_samples(samples: Samples, met: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """What limit states may name, of the samples up to the last that was looked at, and which of them are known."""
    total = len(met["remains"])
    known = ~met["missing"]
    words = {status.value: met[status] for status in FlightStatus}
    words |= {STAYS: met["remains"], CAPTURED: met[SampleOutcome.CAPTURED]}
    values = {name: samples.output(name)[:total] for name in samples.output_names}
    return values | {word: np.where(known, one.astype(float), np.nan) for word, one in words.items()}


def _drawn(state: LimitState, values: dict[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray] | None:
    """How many samples of each refit meet a limit state, and how many are known; None where samples cannot tell.

    The emulator draws no outputs of landers that are captured: where one decides, only the runs can tell.
    """
    if any(name not in values for name in state.outputs):
        return None
    met, refit = state.met(values), np.arange(len(values[CAPTURED])) % REFIT_COUNT
    if np.isnan(met[values[CAPTURED] == 1.0]).any():
        return None
    drawn = drawn_counts(met, refit, REFIT_COUNT)
    # Of so few samples no scatter between refits can be told.
    return drawn if drawn[1].min() >= 2 else None
