"""Shares and ends of journeys that the emulator gives, with intervals from its refits."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from lithobrake.analysis import quantile_within, refit_interval
from lithobrake.analysis.confidence import numbered_beds
from lithobrake.analysis.control_variate import control_factor
from lithobrake.analysis.paired_difference import difference_bounds
from lithobrake.analysis.unseen_event import RunCounts, limit_of_runs, runs_by_bed
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.dispersion_statistics import Rows
from lithobrake.pipeline.answer.journey_ends import JourneyTable, end_share
from lithobrake.pipeline.answer.run_answers import why_no_interval
from lithobrake.pipeline.first_touchdown.samples import MISSING, SAMPLE_OUTCOMES, Samples
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys.emulated_journeys import COPIES, FRESH, OWN, most_landings
from lithobrake.pipeline.journeys.touchdown_emulator import TOUCHDOWN_EMULATOR_FILE, why_no_emulator
from lithobrake.pipeline.study_folder import AGAIN, StudyFolder
from lithobrake.results.journey_results import ControlVariate, EmulatedJourneys
from lithobrake.results.run_results import CountedShare
from lithobrake.statements.journeys import emulated_ends as emulated_statement
from lithobrake.study import Study
from lithobrake.vocabulary.constants import REFIT_COUNT
from lithobrake.vocabulary.estimate import LEVEL, Estimate
from lithobrake.vocabulary.outcomes import FlightStatus, JourneyEnd, SampleOutcome, TouchdownOutcome
from lithobrake.vocabulary.quantities import EMULATED, EMULATED_FILE, REST_NUMBERS, UNKNOWN_END

Shares = Mapping[str, CountedShare]
EMULATED_ENDS = tuple(end.value for end in JourneyEnd if end != JourneyEnd.FAILED)


@dataclass(frozen=True)
class EmulatedTable:
    """emulated.csv of one kind of landers, all arrays [lander_count]; numbers: of those at rest, by column."""

    journey: np.ndarray
    refit: np.ndarray
    end: np.ndarray
    beyond: np.ndarray
    landings: np.ndarray
    numbers: dict[str, np.ndarray] = field(default_factory=dict)

    @classmethod
    def load(cls, folder: StudyFolder, landers: str) -> "EmulatedTable":
        """Those of a folder. Raises DamagedFileError for another file."""
        rows = read_rows(folder / EMULATED_FILE, tuple(EMULATED)[: -len(REST_NUMBERS)], AGAIN)
        own = [row for row in rows if row["landers"] == landers]
        whole = (np.array([int(row[name]) for row in own]) for name in ("journey", "refit", "beyond", "landings"))
        journey, refit, beyond, landings = whole
        end = np.array([row["end"] for row in own], dtype=object)
        titles = {title.partition(" ")[0]: title for title in (rows[0] if rows else ())}
        numbers = {name: np.array([float(row[titles[name]] or "nan") for row in own]) for name in REST_NUMBERS if own}
        return cls(journey, refit, end, beyond == 1, landings, numbers)

    def without_landings(self, end: str) -> np.ndarray:
        """Which landers ended so by the emulator alone, [lander_count]."""
        met: np.ndarray = (self.end == end) & ~self.beyond
        return met


def emulated_ends(job: Job, table: JourneyTable, plain: Shares) -> tuple[EmulatedJourneys, Shares]:
    """What the emulator's journeys say, and the shares of the ends of the journeys, narrowed where they can be."""
    why = why_no_emulator(job.folder.read_json(TOUCHDOWN_EMULATOR_FILE))
    if why is not None:
        return EmulatedJourneys(why, 0, 0, 0, 0.0, {}, None, None, why), plain
    most = most_landings(job)
    fresh, own = (EmulatedTable.load(job.folder, one) for one in (FRESH, OWN))
    if not len(fresh.end):
        return EmulatedJourneys(None, 0, 0, most, 0.0, {}, None, None, ""), plain
    ends = _fresh_shares(job.study, table, fresh)
    control, shares = _narrowed(table, plain, fresh, own)
    # Landers of the emulator go on to rest, whatever the landings are followed for.
    agrees = _agrees(plain, ends) if job.study.journey.touchdowns is None else None
    unknown = float(np.mean(fresh.end == UNKNOWN_END))
    said = emulated_statement(ends, agrees, unknown)
    counts = len(fresh.end), int(fresh.landings.sum()), most
    return EmulatedJourneys(None, *counts, unknown, ends, agrees, control, said), shares


def _fresh_shares(study: Study, table: JourneyTable, fresh: EmulatedTable) -> dict[str, CountedShare]:
    """Shares of the landers of known end, with bounds that hold whatever becomes of the others."""
    totals, why = np.bincount(fresh.refit, minlength=REFIT_COUNT), why_no_interval(study)
    fitted, failed, found = runs_by_bed(table.bed), JourneyEnd.FAILED.value, {}
    for end in (*EMULATED_ENDS, failed):
        # A lander whose landing failed has an unknown end, too.
        met, known = fresh.end == end, ~np.isin(fresh.end, [UNKNOWN_END] if end == failed else [UNKNOWN_END, failed])
        share, count = float(met.sum() / max(known.sum(), 1)), int(met.sum())
        if why is not None or totals.min() < 2:
            found[end] = CountedShare(count, Estimate(share, None, None, why_missing=why))
            continue
        least, most = (
            refit_interval(np.bincount(fresh.refit[one], minlength=REFIT_COUNT), totals, *fitted)
            for one in (met, met | ~known)
        )
        found[end] = CountedShare(count, Estimate(share, least.lower, most.upper))
    return found


def _agrees(landings: Shares, emulator: Shares) -> bool | None:
    """Whether no end differs by more than both intervals together allow; None without intervals."""
    agreed = []
    for end in EMULATED_ENDS:
        bounds = difference_bounds(landings[end].share, emulator[end].share)
        if bounds is None:
            return None
        agreed.append(bounds[0] <= 0.0 <= bounds[1])
    return all(agreed)


def _narrowed(
    table: JourneyTable, plain: Shares, fresh: EmulatedTable, own: EmulatedTable
) -> tuple[ControlVariate | None, Shares]:
    """Shares with what the emulator predicts of each journey taken off, where that narrows the share at rest."""
    rests, met = JourneyEnd.AT_REST.value, [end for end, one in plain.items() if one.count]
    before = plain[rests].share.half_width
    # What is predicted narrows nothing where an end is not known.
    if before is None or len(met) < 2 or rests not in met or table.unknown.any():
        return None, plain
    if len(own.end) != COPIES * len(table.end):
        return None, plain
    predicted = {end: _predicted(end, fresh, own) for end in met if end != rests}
    # So the predictions of all ends that occurred add up to nothing, and the shares to one.
    predicted[rests] = -np.sum(list(predicted.values()), axis=0)
    factor = control_factor(predicted[rests], table.rests.astype(float), numbered_beds(table.bed, len(table.bed)))
    if not (factor * predicted[rests]).any():
        return None, plain
    taken = {end: factor * predicted[end] for end in met}
    means = [float(np.mean((table.end == end) - taken[end])) for end in met]
    if min(means) <= 0.0 or max(means) >= 1.0:
        return None, plain
    found = {**plain, **{end: end_share(table.end == end, table.bed, explained=taken[end]) for end in met}}
    after = found[rests].share.half_width
    assert after is not None
    return ControlVariate(after < before, before, after), found if after < before else plain


def _predicted(end: str, fresh: EmulatedTable, own: EmulatedTable) -> np.ndarray:
    """What refits that have not seen the bed of a journey predict of it, less the mean of these over fresh landers.

    [journey_count]. A refit has seen none of the two, so over journeys the mean is 0.
    """
    there = fresh.without_landings(end)
    counts, totals = (
        np.bincount(fresh.refit[one], minlength=REFIT_COUNT) for one in (there, np.full(len(there), True))
    )
    expected = counts / np.maximum(totals, 1)
    each: np.ndarray = own.without_landings(end) - expected[own.refit]
    return each.reshape(-1, COPIES).mean(axis=1)


@dataclass(frozen=True)
class Refits:
    """What the refits of an emulator were fitted to: bed_count, run_count; why: a reason for no interval, or None.

    run_count: of what an event is one of, landings or whole journeys, in all or on each bed: it limits an event that
    none of them has met.
    """

    bed_count: int
    run_count: RunCounts
    why: str | None

    @classmethod
    def of_journeys(cls, study: Study, table: JourneyTable) -> "Refits":
        """For events of a lander, of which a journey shows one, however many touchdowns it has."""
        return cls(*runs_by_bed(table.bed), why_no_interval(study))

    def with_intervals(
        self, counts: Mapping[str, CountedShare], sample: np.ndarray, met: Mapping[str, np.ndarray]
    ) -> dict[str, CountedShare]:
        """The shares of events, those of samples [count] that have met each event [count] with their bounds."""
        refit, found = sample % REFIT_COUNT, dict(counts)
        totals = np.bincount(refit, minlength=REFIT_COUNT)
        if self.why is not None or totals.min() < 2:
            return found
        for name, event in met.items():
            counted = np.bincount(refit[event], minlength=REFIT_COUNT)
            one = refit_interval(counted, totals, self.bed_count, self.run_count)
            found[name] = found[name].within(one.lower, one.upper)
        return found

    def share(self, met: np.ndarray, of: np.ndarray, refit: np.ndarray, level: float = LEVEL) -> Estimate:
        """Share of some landers that have met an event, with its bounds where there are any, all [lander_count].

        of: which landers it is a share of; refit: that each has met.
        """
        share = float(met.sum() / of.sum())
        counts, totals = (np.bincount(refit[one], minlength=REFIT_COUNT) for one in (met, of))
        # Of one lander of a refit no scatter within it can be told; of few refits none between them.
        told = totals >= 2
        if self.why is not None or told.sum() < REFIT_COUNT // 2:
            return Estimate(share, None, None)
        found = refit_interval(counts[told], totals[told], self.bed_count, self.run_count, level)
        return replace(found, value=share)

    def share_of_known(self, met: np.ndarray, known: np.ndarray, refit: np.ndarray, level: float = LEVEL) -> Estimate:
        """Share of the landers of known end that have met an event; bounds hold whatever becomes of the others.

        met, known, refit: all [lander_count]. Of no known end the share is not known.
        """
        told = np.where(known, met.astype(float), np.nan)
        return share_of_known(told, lambda one, of: self.share(one, of, refit, level), level)

    def widened(self, counts: dict[str, CountedShare], run_outcomes: Mapping[str, int]) -> dict[str, CountedShare]:
        """The same with bounds of an outcome that no run had from 0 to what so many runs can say of it."""
        limit = limit_of_runs(self.run_count, self.bed_count)
        for outcome in set(TouchdownOutcome) - {TouchdownOutcome.CLEAR, *run_outcomes}:
            one = counts[outcome.value]
            if one.share.upper is not None:
                counts[outcome.value] = one.within(0.0, max(one.share.upper, limit))
        return counts


def share_of_known(
    met: np.ndarray, share: Callable[[np.ndarray, np.ndarray], Estimate], level: float = LEVEL
) -> Estimate:
    """Share of the landers of known end that have met an event [lander_count: 1, 0 or NaN], NaN where no end is known.

    Bounds hold whatever becomes of the others. share: of landers which have met an event among some.
    """
    everyone, known = np.ones(len(met), dtype=bool), np.isfinite(met)
    least, most = (share(np.where(known, met, end) == 1.0, everyone) for end in (0.0, 1.0))
    return Estimate(float(met[known].mean()) if known.any() else math.nan, least.lower, most.upper, level)


def quantile_of_some(
    values: np.ndarray,
    which: np.ndarray,
    level: float,
    share: Callable[[np.ndarray, np.ndarray], Estimate],
    unknown: np.ndarray,
) -> Estimate | None:
    """A quantile of the values of some landers, both [lander_count], with its interval; None where there are none.

    share: that of some landers (its second argument) which have met an event (its first), both [lander_count], with its
    interval, if it has one. unknown [lander_count]: landers that may be of these, with a value below or above all.
    """
    if not which.any():
        return None
    own, of = values[which], which | unknown
    point = quantile_within(own, level, (level, level))[0]
    part = float(unknown.sum() / of.sum())
    # Unknown landers lie below all values for the lower bound, above them for the upper one.
    below = share(which & (values <= point) | unknown, of), share(which & (values <= point), of)
    if below[0].bounds is None or below[1].bounds is None:
        return Estimate(point, None, None)
    if not part:
        levels = below[0].bounds
    else:
        least, most = level - below[0].value + below[0].bounds[0], level - below[1].value + below[1].bounds[1]
        levels = max((least - part) / (1.0 - part), 0.0), min(most / (1.0 - part), 1.0)
    value, *bounds = quantile_within(own, level, levels)
    # Few landers give no interval of a tail.
    lower, upper = (end if math.isfinite(end) else None for end in bounds)
    return Estimate(value, lower, upper)


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
