"""Intervals of the shares that the emulator gives, from the scatter of its samples over refits."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from lithobrake.analysis import LEVEL, refit_interval, upper_limit
from lithobrake.pipeline.answer.dispersion_statistics import Rows
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.emulate.samples import MISSING, SAMPLE_OUTCOMES, Samples
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, SampleOutcome, TouchdownOutcome


@dataclass(frozen=True)
class Refits:
    """What the refits of an emulator were fitted to: bed_count, run_count; why: a reason for no interval, or None."""

    bed_count: int
    run_count: int
    why: str | None

    def put_intervals(self, table: dict[str, Any], sample: np.ndarray, met: Mapping[str, np.ndarray]) -> None:
        """Fill in lower and upper of the shares of a table, of samples [count] that have met each event [count]."""
        table |= {"level": LEVEL, "why": self.why}
        refit = sample % REFIT_COUNT
        totals = np.bincount(refit, minlength=REFIT_COUNT)
        if self.why is not None or totals.min() < 2:
            return
        for name, event in met.items():
            counts = np.bincount(refit[event], minlength=REFIT_COUNT)
            found = refit_interval(counts, totals, self.bed_count)
            table[name] |= {"lower": found.lower, "upper": found.upper}

    def widen_what_no_run_met(self, table: dict[str, Any], run_outcomes: Mapping[str, int]) -> None:
        """Let the bounds of an outcome that no run had reach from 0 to what so many beds can say of it."""
        for name in set(TouchdownOutcome) - {TouchdownOutcome.CLEAR, *run_outcomes}:
            entry = table[name]
            if entry["upper"] is not None:
                entry |= {"lower": 0.0, "upper": max(entry["upper"], upper_limit(self.bed_count, LEVEL))}


def sample_fates(samples: Samples, flights: Rows, *, holds: bool) -> dict[str, np.ndarray]:
    """Which of the samples up to the last that was looked at have met each fate, by the words of results.shares."""
    words = np.array([str(word) for word in SAMPLE_OUTCOMES], dtype=object)[samples.outcome]
    total = len(words)
    if len(flights) < int(samples.leaves.sum()):
        total = int(flights[-1]["sample"]) + 1
    for row in flights:
        words[int(row["sample"])] = row["status"]
    met = {str(name): words[:total] == name for name in (*SampleOutcome, *FlightStatus) if name != SampleOutcome.CLEAR}
    returning = met[FlightStatus.IMPACT] | met[SampleOutcome.CAPTURED] if holds else met[FlightStatus.IMPACT]
    return met | {"returns": returning, "missing": np.isin(words[:total], MISSING)}


def journey_ends(rows: Sequence[Mapping[str, str]]) -> dict[str, np.ndarray]:
    """Which of the journeys met each end, and which moved along the ground."""
    status = np.array([row["status"] for row in rows], dtype=object)
    slid = np.array([float(row["slid_length"]) > 0.0 for row in rows], dtype=bool)
    return {str(name): status == name for name in JourneyStatus} | {"slid": slid}
