"""How wide the interval of a study's answer will be, and how many runs each bed has for it."""

import math
import statistics
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from lithobrake.analysis import LEVEL, best_runs_a_bed, cost_over_best, scatter_of
from lithobrake.analysis.confidence import answered_runs
from lithobrake.analysis.half_width import (
    CORRELATION,
    JOURNEY_CORRELATION,
    SPREAD_RANGE,
    AllOrNothing,
    LikeRuns,
    Shares,
    half_width_range,
)
from lithobrake.campaign import Record
from lithobrake.pipeline.answer.run_answers import answer_words, answers_of, answers_rest
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.planning.expected_steps import ExpectedSoil
from lithobrake.pipeline.planning.expected_time import journey_time, machine_pace, pour_time, run_time
from lithobrake.pipeline.planning.study_warnings import expected_loss
from lithobrake.pipeline.sequential_sampling import answers_aloft, flown_shares
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.statements.ends import assumed_at_rest
from lithobrake.study import Study
from lithobrake.vocabulary.constants import FEWEST_BEDS_OF_INTERVAL
from lithobrake.vocabulary.number_words import at_level, percent

if TYPE_CHECKING:
    from lithobrake.analysis.half_width import RunLaw

# Fraction at rest that may be expected at least, before a study has journeys.
LEAST_AT_REST = 0.5
# Fractions of which the half width is told, too: at rest, and of landings that return.
TOLD_AT_REST, TOLD_OF_RETURNS = (1.0, 0.95, 0.8, 0.5), (1.0,)
# Of studies with randomised impact points; where it lies hardly matters for the half width.
RETURN_FRACTION = 0.75
# Fewer answers say nothing of how they scatter.
FEWEST_ANSWERS = 20
# Counts that cost less than this part more than the best are as good: what a bed costs is not known better.
AS_GOOD = 0.1


@dataclass(frozen=True)
class ExpectedHalfWidth:
    """Half the interval of the answer of a study with so many runs on so many beds; shares of 1.

    answer           what it is of, in words
    lower, upper     half widths of nine in ten such studies lie between; with runs that have ended, of studies which go
                     on as these
    median           half of them are wider
    by_fraction      median half width by the fraction that comes out; none with runs that have ended
    assumed          what it rests on, in a sentence
    own_run_count    runs with an outcome on which it rests; 0 before enough have ended
    missing          fraction of the runs to come that are taken to have no outcome
    level            probability that the interval stands for
    """

    run_count: int
    bed_count: int
    answer: str
    lower: float
    median: float
    upper: float
    by_fraction: Mapping[str, float]
    assumed: str
    own_run_count: int
    missing: float
    level: float

    def lines(self) -> list[str]:
        width = f"{_points(self.lower)} to {_points(self.upper)} points in nine of ten such studies"
        if self.lower == self.upper:
            width = f"{_points(self.lower)} points"
        lines = [
            f"Expected half-width of the {at_level(self.level)} of {self.answer} ({self.run_count} runs on "
            f"{self.bed_count} beds): {width}."
        ]
        if self.by_fraction:
            told = ", ".join(f"{_points(width)} at {share}" for share, width in self.by_fraction.items())
            lines.append(f"  By the resulting fraction: {told}.")
        return [*lines, f"  {self.assumed}"]


def expected_width(
    design: DrawnDesign, known: Mapping[str, Record], folder: StudyFolder, soil: ExpectedSoil | None = None
) -> ExpectedHalfWidth | None:
    """What to expect of the drawn landers; None where none is drawn, and for one bed, which gives no interval.

    known: runs that have ended, by key; folder: where they may have flown; soil: its beds, where it has any.
    """
    study = design.study
    if not study.design.run_count or study.bed_count == 1:
        return None
    values, bed = answers_of(design.keys, known, flown_shares(study, folder))
    own = int(np.isfinite(values).sum())
    own = own if own >= FEWEST_ANSWERS and len(np.unique(bed)) > 1 else 0
    reach = 1.0 if design.descents is None else design.descents.reach
    law, words = law_of_runs(values, bed) if own else law_before(study, reach)
    missing = _missing(study, soil, values)
    there, to_come = _runs(design, values, bed)

    foreseen = partial(
        half_width_range, bed=to_come, values=there[0], values_bed=there[1], correlation=expected_correlation(study)
    )
    found = foreseen(law, missing=missing)
    if found is None:
        return None
    told = () if own else TOLD_AT_REST if answers_rest(study) else TOLD_OF_RETURNS
    widths = {percent(share): foreseen(AllOrNothing(share, share)) for share in told}
    lost = f"; {percent(missing, 1)} of all landings have no outcome" if missing else ""
    return ExpectedHalfWidth(
        run_count=study.design.run_count,
        bed_count=study.bed_count,
        answer=answer_words(study),
        lower=found.lower,
        median=found.median,
        upper=found.upper,
        by_fraction={share: width.median for share, width in widths.items() if width},
        assumed=f"{words}{lost}.",
        own_run_count=own,
        missing=missing,
        level=LEVEL,
    )


def expected_correlation(study: Study) -> float:
    return JOURNEY_CORRELATION if answers_rest(study) else CORRELATION


def law_before(study: Study, reach: float = 1.0) -> "tuple[RunLaw, str]":
    """What is taken of a run before enough have ended, in words too, but for the full stop.

    reach: fraction of the landers that reach the ground.
    """
    beds = f"mean correlation {expected_correlation(study):g} of two runs on one bed, as in earlier studies"
    if answers_rest(study):
        who = "the landers" if reach == 1.0 else "those that reach the ground"
        return AllOrNothing(reach, LEAST_AT_REST * reach), (f"{assumed_at_rest(LEAST_AT_REST, who)}; {beds}")
    if study.design.half_width_of is not None:
        return AllOrNothing(0.0, 1.0), f"Assumed: any probability; {beds}"
    low, high = SPREAD_RANGE
    return Shares(RETURN_FRACTION, low, high), (
        f"Assumed: standard deviation {low:g} to {high:g} of the return fraction from landing to landing; {beds}"
    )


def law_of_runs(values: np.ndarray, bed: np.ndarray) -> "tuple[RunLaw, str]":
    """The same by the runs that have ended."""
    known, beds = answered_runs(values, bed)
    scatter = scatter_of(values, bed)
    shown = (
        "all equal"
        if scatter is None
        else (f"standard deviation {scatter[0]:.2g}, correlation of two runs on one bed {scatter[1]:.2g}")
    )
    return LikeRuns(known, beds), f"From the {len(known)} finished runs: mean {known.mean():.2g}, {shown}"


def _missing(study: Study, soil: ExpectedSoil | None, values: np.ndarray) -> float:
    """Fraction of the runs to come that will have no outcome: that of those that have ended, else as foreseen."""
    if answers_rest(study):
        return 0.0
    if len(values) >= FEWEST_ANSWERS:
        return float(np.mean(~np.isfinite(values)))
    if soil is None or soil.recipe.period is not None:
        return 0.0
    return expected_loss(soil.landings[1:], min(soil.recipe.width))


def _runs(design: DrawnDesign, values: np.ndarray, bed: np.ndarray) -> tuple[tuple[np.ndarray, np.ndarray], np.ndarray]:
    """Answers and beds of the runs that there are, and beds of those to come.

    Landers that never touch down are no runs to come: they are there if the answer is one of them, too.
    """
    aloft, bed_of_aloft = answers_aloft(design)
    left = Counter(np.array(design.beds, dtype=float).tolist()) - Counter([*bed.tolist(), *bed_of_aloft.tolist()])
    told = np.isfinite(aloft)
    there = np.concatenate([values, aloft[told]]), np.concatenate([bed, bed_of_aloft[told]])
    return there, np.array(list(left.elements()))


def _points(share: float) -> str:
    return f"{100 * share:.2g}"


@dataclass(frozen=True)
class RunsABed:
    """Runs on each bed.

    runs          what they are, one and more
    count         on each bed, in the mean
    bed_cost      time of a bed that is poured, over that of a run
    best          on each bed, of as many runs on at least 12 beds, for the narrowest interval for the time
    over_best     time of the study for an interval of one width over that with the best number, less 1
    correlation   of two runs on one bed, on which that rests
    """

    runs: tuple[str, str]
    count: float
    bed_cost: float
    best: float
    over_best: float
    correlation: float

    def line(self) -> str:
        one, more = self.runs
        cost = f"{self.bed_cost:.2g} {one if self.bed_cost == 1.0 else more}"
        judged = "is as good"
        if self.over_best >= AS_GOOD:
            judged = f"takes {percent(self.over_best)} more time for the same interval; bed.bed_count changes it"
        return (
            f"{more.capitalize()} on each bed: {self.count:.3g}. A bed takes the time of about {cost}, so about "
            f"{max(round(self.best), 1)} on each, on at least {FEWEST_BEDS_OF_INTERVAL} beds, give the narrowest "
            f"interval for the time (correlation of two on one bed {self.correlation:g}); {self.count:.3g} {judged}."
        )


def runs_a_bed(study: Study, soils: Sequence[ExpectedSoil], ended: Sequence[Record]) -> RunsABed | None:
    """Those of landers on several beds; None where there are none.

    soils: beds as those of the study, each standing for as many; ended: runs of this study that have.
    """
    if not study.design.run_count or study.bed_count == 1 or not soils:
        return None
    pace = machine_pace() or 1.0
    if study.journey.touchdowns == 1:
        span, runs = run_time(soils, ended, pace), ("landing", "landings")
    else:
        span, runs = journey_time(soils, pace), ("journey", "journeys")
    if span is None:
        return None
    # A span reaches as many times below its middle as above it.
    pour = pace * statistics.fmean(map(pour_time, soils))
    run_count, cost = study.design.run_count, pour / math.sqrt(math.prod(span))
    count, correlation = run_count / study.bed_count, expected_correlation(study)
    best = min(best_runs_a_bed(cost, correlation), max(run_count / FEWEST_BEDS_OF_INTERVAL, 1.0))
    over_best = cost_over_best(count, best, cost, correlation) - 1.0
    return RunsABed(runs, count, cost, best, over_best, correlation)
