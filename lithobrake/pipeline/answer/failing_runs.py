"""Which runs meet a limit state of the study file, by their touchdowns and by how their flights ended."""

import numpy as np

from lithobrake.analysis.limit_state_evaluation import limit_state_met
from lithobrake.pipeline.fly.run_flights import FATES as RUN_FATES
from lithobrake.pipeline.fly.run_flights import RETURNS as RETURNING
from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.vocabulary.limit_state import FATES, RETURNS, LimitState
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import TOUCHDOWN

CAPTURED = TouchdownOutcome.CAPTURED.value
# Words of a run that its touchdown alone decides; all others take flights.
OF_TOUCHDOWN = (CAPTURED,)


def failing_runs(state: LimitState, runs: DesignRuns, fates: np.ndarray) -> np.ndarray:
    """Share of the flights of each run that meet a limit state, NaN where nobody knows, [run_count].

    fates [run_count, len(RUN_FATES)]: how many of its flights ended so.
    """
    values = values_of_runs(runs)
    unflown = {word: np.full(runs.run_count, np.nan) for word in FATES if word != CAPTURED}
    found = limit_state_met(state, values | unflown)
    counts = fates.sum(axis=1)
    if set(state.fates) <= set(OF_TOUCHDOWN) or not counts.any():
        return found
    by_fate = np.column_stack([limit_state_met(state, values | _words(fate, runs.run_count)) for fate in RUN_FATES])
    met = np.where(fates > 0, fates * by_fate, 0.0).sum(axis=1)
    return np.where(counts > 0, met / np.maximum(counts, 1), found)


def values_of_runs(runs: DesignRuns) -> dict[str, np.ndarray]:
    """What limit states may name of touchdowns, [run_count] each: outputs, and whether the lander was captured."""
    outcomes = np.array(runs.outcomes)
    # A run without a known end was neither captured nor not.
    ended = np.isin(outcomes, [TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED])
    captured = np.where(ended, (outcomes == CAPTURED).astype(float), np.nan)
    return {name: runs.output(name) for name in TOUCHDOWN} | {CAPTURED: captured}


def _words(fate: str, count: int) -> dict[str, np.ndarray]:
    """Whether each word of the grammar holds of flights that ended so, [count] each; `captured` is of the touchdown."""
    held = {word: word == fate for word in RUN_FATES} | {RETURNS: fate in RETURNING}
    return {word: np.full(count, float(one)) for word, one in held.items()}
