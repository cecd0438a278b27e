"""Ends of journeys by the emulator beside those of landings: whether the two agree, and what the first do for these."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lithobrake.analysis import refit_interval
from lithobrake.analysis.confidence import numbered_beds
from lithobrake.analysis.control_variate import control_factor
from lithobrake.analysis.paired_difference import difference_bounds
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.answer.journey_ends import JourneyTable, end_share
from lithobrake.pipeline.answer.scope import why_no_interval
from lithobrake.pipeline.emulate.fitted_emulator import REFIT_COUNT
from lithobrake.pipeline.emulated.emulated_journeys import COPIES, FRESH, OWN, most_landings
from lithobrake.pipeline.emulated.touchdown_emulator import FILE as EMULATOR
from lithobrake.pipeline.emulated.touchdown_emulator import why_no_emulator
from lithobrake.pipeline.folder.study_folder import AGAIN, StudyFolder
from lithobrake.pipeline.job import Job
from lithobrake.results.emulated_results import ControlVariate, EmulatedJourneys
from lithobrake.results.journey_results import EndShare
from lithobrake.study import Study
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.percentages import LEVEL, percent, with_interval
from lithobrake.vocabulary.quantities import EMULATED, EMULATED_FILE, UNKNOWN_END

Shares = Mapping[str, EndShare]
EMULATED_ENDS = tuple(end.value for end in JourneyEnd if end != JourneyEnd.FAILED)


@dataclass(frozen=True)
class EmulatedTable:
    """emulated.csv of one kind of landers, all arrays [lander_count]."""

    journey: np.ndarray
    refit: np.ndarray
    end: np.ndarray
    beyond: np.ndarray
    landings: np.ndarray

    @classmethod
    def load(cls, folder: StudyFolder, landers: str) -> "EmulatedTable":
        """Those of a folder. Raises DamagedFileError for another file."""
        rows = read_rows(folder / EMULATED_FILE, tuple(EMULATED)[:-1], AGAIN)
        own = [row for row in rows if row["landers"] == landers]
        whole = (np.array([int(row[name]) for row in own]) for name in ("journey", "refit", "beyond", "landings"))
        journey, refit, beyond, landings = whole
        return cls(journey, refit, np.array([row["end"] for row in own], dtype=object), beyond == 1, landings)

    def without_landings(self, end: str) -> np.ndarray:
        """Which landers ended so by the emulator alone, [lander_count]."""
        met: np.ndarray = (self.end == end) & ~self.beyond
        return met


def emulated_ends(job: Job, table: JourneyTable, plain: Shares) -> tuple[EmulatedJourneys, Shares]:
    """What the emulator's journeys say, and the shares of the ends of the journeys, narrowed where they can be."""
    why = why_no_emulator(job.folder.read_json(EMULATOR))
    if why is not None:
        return EmulatedJourneys(why, 0, 0, 0, 0.0, {}, None, None, why), plain
    most = most_landings(job)
    fresh, own = (EmulatedTable.load(job.folder, one) for one in (FRESH, OWN))
    if not len(fresh.end):
        return EmulatedJourneys(None, 0, 0, most, 0.0, {}, None, None, ""), plain
    ends = _fresh_shares(job.study, table, fresh)
    control, shares = _narrowed(table, plain, fresh, own)
    agrees = _agrees(plain, ends)
    unknown = float(np.mean(fresh.end == UNKNOWN_END))
    counts = len(fresh.end), int(fresh.landings.sum()), most
    return EmulatedJourneys(None, *counts, unknown, ends, agrees, control, _statement(ends, agrees, unknown)), shares


def _fresh_shares(study: Study, table: JourneyTable, fresh: EmulatedTable) -> dict[str, EndShare]:
    """Shares of the landers of known end, with bounds that hold whatever becomes of the others."""
    totals, known = np.bincount(fresh.refit, minlength=REFIT_COUNT), fresh.end != UNKNOWN_END
    why, beds = why_no_interval(study), len(np.unique(table.bed))
    found = {}
    for end in (*EMULATED_ENDS, JourneyEnd.FAILED.value):
        met = fresh.end == end
        share, count = float(met.sum() / max(known.sum(), 1)), int(met.sum())
        if why is not None or totals.min() < 2:
            found[end] = EndShare(count, share, None, None, why)
            continue
        least, most = (
            refit_interval(np.bincount(fresh.refit[one], minlength=REFIT_COUNT), totals, beds)
            for one in (met, met | ~known)
        )
        found[end] = EndShare(count, share, least.lower, most.upper)
    return found


def _agrees(landings: Shares, emulator: Shares) -> bool | None:
    """Whether no end differs by more than both intervals together allow; None without intervals."""
    agreed = []
    for end in EMULATED_ENDS:
        one, other = landings[end], emulator[end]
        if one.lower is None or one.upper is None or other.lower is None or other.upper is None:
            return None
        lower, upper = difference_bounds((one.share, one.lower, one.upper), (other.share, other.lower, other.upper))
        agreed.append(lower <= 0.0 <= upper)
    return all(agreed)


def _narrowed(
    table: JourneyTable, plain: Shares, fresh: EmulatedTable, own: EmulatedTable
) -> tuple[ControlVariate | None, Shares]:
    """Shares with what the emulator predicts of each journey taken off, where that narrows the share at rest."""
    rests, met = JourneyEnd.AT_REST.value, [end for end, one in plain.items() if one.count]
    at_rest = plain[rests]
    if at_rest.lower is None or at_rest.upper is None or len(met) < 2 or rests not in met:
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
    narrow = found[rests]
    assert narrow.lower is not None
    assert narrow.upper is not None
    before, after = 0.5 * (at_rest.upper - at_rest.lower), 0.5 * (narrow.upper - narrow.lower)
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


def _statement(ends: Shares, agrees: bool | None, unknown: float) -> str:
    """Whether emulator and landings agree, in a sentence."""
    at_rest = ends[JourneyEnd.AT_REST]
    said = f"The emulator of all touchdowns gives {with_interval(at_rest)} at rest"
    more = f" and {percent(unknown)} with an unknown outcome" if unknown >= 0.005 else ""
    if agrees is None:
        return f"{said}{more}."
    verdict = "agree" if agrees else "do not agree"
    return f"{said}{more}: emulator and landings {verdict} within their {percent(LEVEL)} intervals."
