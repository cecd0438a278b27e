"""Landings without an outcome: how many, why, and which landings every other number then describes."""

from collections.abc import Mapping, Sequence

import numpy as np

from lithobrake.pipeline.runs.run_table import DesignRuns
from lithobrake.results.run_results import MissingLandings
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.percentages import percent
from lithobrake.vocabulary.quantities import OVER_RIM

FAILED = "failed"
KNOWN = (TouchdownOutcome.CLEAR, TouchdownOutcome.CAPTURED)
# In the order in which a sentence names them.
LOST = (TouchdownOutcome.LEFT_SIDEWAYS, TouchdownOutcome.TIME_LIMIT, FAILED)
# Share of the landings without an outcome above which a study warns of it [-].
WARNED = 0.02
WORDS = {outcome.value: outcome.label for outcome in TouchdownOutcome} | {FAILED: FAILED}
REMEDIES = {
    TouchdownOutcome.LEFT_SIDEWAYS: "a wider bed (bed.width, with bed.grain_count) or a steeper impact "
    "(impact.incidence_deg)",
    TouchdownOutcome.TIME_LIMIT: "a longer landing.time_limit",
    FAILED: "the remedy that the reasons of the failed runs name (runs.sqlite)",
}
# A program of the user's own has neither bed nor time limit in the study file.
OF_A_PROGRAM = "a program that returns clear or captured for every touchdown"


def missing_landings(outcomes: Mapping[str, int]) -> MissingLandings:
    """How many of the landings have no outcome, by how they ended; outcomes: landings by outcome."""
    lost = {str(name): outcomes[name] for name in LOST if outcomes.get(name)}
    count, total = sum(lost.values()), sum(outcomes.values())
    return MissingLandings(count, count / total if total else 0.0, lost)


def missing_words(lost: Mapping[str, int]) -> str:
    """The kinds of missing landings with their counts, as in a list."""
    return ", ".join(f"{count} {WORDS[name]}" for name, count in lost.items())


def missing_warning(study: Study, outcomes: Mapping[str, int]) -> str | None:
    """What missing landings do to the numbers of a study, and how to avoid them; None for few or none."""
    found, total = missing_landings(outcomes), sum(outcomes.values())
    if found.share <= WARNED:
        return None
    remedies = [REMEDIES[name] for name in found.outcomes] if study.has_soil else [OF_A_PROGRAM]
    return (
        f"{found.count} of {total} landings ({percent(found.share)}) have no outcome "
        f"({missing_words(found.outcomes)}): medians, quantiles, variance shares and the emulator describe only the "
        f"other {total - found.count}; to avoid this: {', '.join(remedies)}"
    )


def left_in_flight(runs: DesignRuns) -> np.ndarray:
    """Which runs left across the edge of the bed in flight, [run_count]: the nearest to those that are missing."""
    clear = np.array(runs.outcomes) == TouchdownOutcome.CLEAR
    found: np.ndarray = clear & (runs.output(OVER_RIM) == 1.0)
    return found


def described(known: np.ndarray, outcomes: Sequence[str]) -> str:
    """Which of the landings a number describes, in words; known: those that have one [run_count]."""
    met = {outcome for outcome, one in zip(outcomes, known, strict=True) if one}
    words = " or ".join(
        words for outcome, words in ((KNOWN[0], "left the surface"), (KNOWN[1], "were captured")) if outcome in met
    )
    return f"the {int(known.sum())} of {len(outcomes)} landings that {words or 'have this number'}"
