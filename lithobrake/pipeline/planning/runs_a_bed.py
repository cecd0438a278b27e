"""How many runs each bed of a study has, beside the number with which the interval is narrowest for the time."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from lithobrake.campaign import Record
from lithobrake.pipeline.planning.expected_steps import ExpectedSoil
from lithobrake.pipeline.planning.expected_time import journey_time, pour_time, run_time
from lithobrake.pipeline.planning.expected_width import expected_correlation
from lithobrake.pipeline.planning.pace import machine_pace
from lithobrake.study import Study
from lithobrake.study.bed_section import FEWEST_BEDS

# Counts that cost less than this part more than the best are as good: what a bed costs is not known better.
AS_GOOD = 0.1


@dataclass(frozen=True)
class RunsABed:
    """Runs on each bed of a drawn study.

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
        """All of it in a sentence."""
        one, more = self.runs
        cost = f"{self.bed_cost:.2g} {one if self.bed_cost == 1.0 else more}"
        judged = "is as good"
        if self.over_best >= AS_GOOD:
            judged = f"takes {100 * self.over_best:.0f} % more time for the same interval; bed.bed_count changes it"
        return (
            f"{more.capitalize()} on each bed: {self.count:.3g}. A bed takes the time of about {cost}, so about "
            f"{max(round(self.best), 1)} on each, on at least {FEWEST_BEDS} beds, give the narrowest interval for the "
            f"time (correlation of two on one bed {self.correlation:g}); {self.count:.3g} {judged}."
        )


def runs_a_bed(study: Study, soil: ExpectedSoil | None, ended: Sequence[Record]) -> RunsABed | None:
    """Those of a drawn study on several beds of its own; None for any other. ended: runs of this study that have."""
    from lithobrake.analysis import best_runs_a_bed, cost_over_best

    if study.design.method != "drawn" or study.bed_count == 1 or soil is None:
        return None
    pace = machine_pace() or 1.0
    if study.journey is None:
        span, runs = run_time(soil, ended, pace), ("landing", "landings")
    else:
        span, runs = journey_time(soil, pace), ("journey", "journeys")
    if span is None:
        return None
    # A span reaches as many times below its middle as above it.
    run_count, cost = study.design.run_count, pace * pour_time(soil) / math.sqrt(math.prod(span))
    count, correlation = run_count / study.bed_count, expected_correlation(study)
    best = min(best_runs_a_bed(cost, correlation), max(run_count / FEWEST_BEDS, 1.0))
    over_best = cost_over_best(count, best, cost, correlation) - 1.0
    return RunsABed(runs, count, cost, best, over_best, correlation)
