"""Estimates of the analysis in the shape of the results: the one place where a field could be left out."""

import math

from lithobrake.analysis import (
    DirectionEstimate,
    FailureInput,
    FailureProbability,
    IntervalEstimate,
    ShareEstimate,
    VarianceShares,
)
from lithobrake.results.questions import LimitStateInput, LimitStateResult, LimitStateRuns
from lithobrake.results.run_results import (
    CountedShare,
    Estimate,
    OutputDirection,
    ReturnFraction,
    ShareInterval,
    VariancePart,
    VarianceParts,
)

NO_BOUNDS = (None, None)


def finite_estimate(one: IntervalEstimate) -> Estimate:
    """A number with its bounds, None for those that are infinite: few beds give no interval of a tail."""
    lower, upper = (bound if math.isfinite(bound) else None for bound in (one.lower, one.upper))
    return Estimate(one.value, lower, upper)


def share_interval(one: IntervalEstimate) -> ShareInterval:
    """A share with its bounds."""
    return ShareInterval(one.value, one.lower, one.upper)


def fraction(found: ShareEstimate) -> ReturnFraction:
    """A fraction of the landings with all that they show of it."""
    fields = vars(found)
    return ReturnFraction(from_=found.source, **{key: fields[key] for key in fields if key != "source"})


def counted(count: int, found: ReturnFraction) -> CountedShare:
    """A fraction of the landings beside the flights that it comes from."""
    return CountedShare(count, found.share, found.lower, found.upper)


def variance_part(one: IntervalEstimate) -> VariancePart:
    """A part of a variance."""
    return VariancePart(one.value, one.lower, one.upper)


def variance_parts(found: VarianceShares, of: str) -> VarianceParts:
    """The parts of a variance, as they are printed; of: which landings they describe."""
    return VarianceParts(
        soil=variance_part(found.soil),
        soil_doubled=variance_part(found.soil_doubled),
        terms=found.terms,
        soil_by_input={name: variance_part(one) for name, one in found.soil_by_input.items()},
        arrival=None if found.arrival is None else variance_part(found.arrival),
        attitude=None if found.attitude is None else variance_part(found.attitude),
        bed=variance_part(found.bed),
        place=variance_part(found.place),
        chaos=None if found.chaos is None else variance_part(found.chaos),
        of=of,
    )


def direction(found: DirectionEstimate, of: str) -> OutputDirection:
    """Mean direction and resultant length of an angle; of: which landings they describe."""
    return OutputDirection(
        Estimate(found.mean_direction, *(found.mean_direction_bounds or NO_BOUNDS)),
        Estimate(found.resultant_length, *(found.resultant_length_bounds or NO_BOUNDS)),
        of,
    )


def limit_state(
    condition: str, found: FailureProbability, failing_runs: float, inputs: dict[str, FailureInput]
) -> LimitStateResult:
    """The probability of a limit state and the inputs of the runs that meet it, without the statement."""
    runs = found.by_runs
    return LimitStateResult(
        condition, found.probability, found.lower, found.upper, found.level, found.source,
        LimitStateRuns(
            runs.share, runs.lower, runs.upper, runs.source, runs.next_bed, runs.if_missing, runs.missing
        ),
        None if found.by_emulator is None else share_interval(found.by_emulator),
        found.tail_limit, found.why, failing_runs,
        {key: limit_state_input(one) for key, one in inputs.items()},
        statement="",
    )  # fmt: skip


def limit_state_input(one: FailureInput) -> LimitStateInput:
    """An input among the runs that meet a limit state."""
    return LimitStateInput(
        one.distance, one.lower, one.upper, one.luck, one.median, one.median_of_all, one.found
    )  # fmt: skip
