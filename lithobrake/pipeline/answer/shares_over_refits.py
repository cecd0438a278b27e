"""Intervals of the shares that the emulator gives, from the scatter of its samples over refits."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from lithobrake.analysis import LEVEL, IntervalEstimate, quantile_within, refit_interval, upper_limit
from lithobrake.pipeline.answer.dispersion_statistics import Rows
from lithobrake.pipeline.answer.typed_estimates import finite_estimate
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.emulate.samples import MISSING, SAMPLE_OUTCOMES, Samples
from lithobrake.results.shares import CountedShare, Estimate, ShareInterval
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyStatus, SampleOutcome, TouchdownOutcome


@dataclass(frozen=True)
class Refits:
    """What the refits of an emulator were fitted to: bed_count, run_count; why: a reason for no interval, or None."""

    bed_count: int
    run_count: int
    why: str | None

    def with_intervals(
        self, counts: Mapping[str, CountedShare], sample: np.ndarray, met: Mapping[str, np.ndarray]
    ) -> dict[str, CountedShare]:
        """The shares of events, those of samples [count] that have met each event [count] with their bounds."""
        refit, found = sample % REFIT_COUNT, dict(counts)
        totals = np.bincount(refit, minlength=REFIT_COUNT)
        if self.why is not None or totals.min() < 2:
            return found
        for name, event in met.items():
            one = refit_interval(np.bincount(refit[event], minlength=REFIT_COUNT), totals, self.bed_count)
            found[name] = replace(found[name], lower=one.lower, upper=one.upper)
        return found

    def share(self, met: np.ndarray, of: np.ndarray, refit: np.ndarray) -> ShareInterval:
        """Share of some landers that have met an event, with its bounds where there are any, all [lander_count].

        of: which landers it is a share of; refit: that each has met.
        """
        share = float(met.sum() / of.sum())
        counts, totals = (np.bincount(refit[one], minlength=REFIT_COUNT) for one in (met, of))
        # Of one lander of a refit no scatter within it can be told; of few refits none between them.
        told = totals >= 2
        if self.why is not None or told.sum() < REFIT_COUNT // 2:
            return ShareInterval(share, None, None)
        found = refit_interval(counts[told], totals[told], self.bed_count)
        return ShareInterval(share, found.lower, found.upper)

    def widened(self, counts: dict[str, CountedShare], run_outcomes: Mapping[str, int]) -> dict[str, CountedShare]:
        """The same with bounds of an outcome that no run had from 0 to what so many beds can say of it."""
        limit = upper_limit(self.bed_count, LEVEL)
        for outcome in set(TouchdownOutcome) - {TouchdownOutcome.CLEAR, *run_outcomes}:
            one = counts[outcome.value]
            if one.upper is not None:
                counts[outcome.value] = replace(one, lower=0.0, upper=max(one.upper, limit))
        return counts


def quantile_of_some(
    values: np.ndarray, which: np.ndarray, level: float, share: Callable[[np.ndarray], ShareInterval]
) -> Estimate | None:
    """A quantile of the values of some landers, both [lander_count], with its interval; None where there are none.

    share: that of those of them which have met an event [lander_count], with its interval, if it has one.
    """
    if not which.any():
        return None
    point = quantile_within(values[which], level, (level, level))[0]
    below = share(which & (values <= point))
    if below.lower is None or below.upper is None:
        return Estimate(quantile_within(values[which], level, (0.0, 1.0))[0], None, None)
    return finite_estimate(IntervalEstimate(*quantile_within(values[which], level, (below.lower, below.upper))))


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
