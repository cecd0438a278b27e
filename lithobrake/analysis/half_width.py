"""How wide an interval will be before anything has run, and how many runs a width asks for."""

import math

from lithobrake.analysis.confidence import t_quantile
from lithobrake.vocabulary.given_numbers import LARGEST, finite_number, whole_number

# Standard deviation of a run's share of flights that return, as measured on three studies with randomised impact points
# (0.148, 0.211, 0.212): the range, and the larger one, which promises no more than a study keeps.
SPREAD_RANGE = (0.15, 0.21)
SPREAD = SPREAD_RANGE[1]
# Correlation of two runs on one bed.
CORRELATION = 0.05
# Narrower intervals than this part of the spread would take a million million runs.
NARROWEST = 1e-6


def expected_half_width(
    run_count: int, bed_count: int, *, spread: float = SPREAD, correlation: float = CORRELATION
) -> float | None:
    """Half width of the interval of a mean over runs on beds of equal counts [unit of spread]; None for one bed.

    spread: standard deviation of a run at what the inputs leave open; correlation of two runs on one bed, 0 to 1.
    Raises ValueError for counts or numbers that cannot be. Source: [Cochran-1977], section 10.3 (two stages).
    """
    whole_number("bed_count", bed_count, 1, whole_number("run_count", run_count, 1))
    _check_scatter(spread, correlation)
    if bed_count == 1:
        return None
    variance = spread**2 * (correlation / bed_count + (1.0 - correlation) / run_count)
    return t_quantile(bed_count - 1) * math.sqrt(variance)


def expected_half_widths(
    run_count: int, bed_count: int, *, correlation: float = CORRELATION
) -> tuple[float, float] | None:
    """Least and largest half width to expect of the return fraction, by the spreads measured; None for one bed.

    Raises ValueError as `expected_half_width` does.
    """
    ends = [expected_half_width(run_count, bed_count, spread=one, correlation=correlation) for one in SPREAD_RANGE]
    return None if ends[0] is None or ends[1] is None else (ends[0], ends[1])


def runs_for_half_width(
    half_width: float, runs_per_bed: int = 10, *, spread: float = SPREAD, correlation: float = CORRELATION
) -> int:
    """Fewest runs, a whole number of beds of so many, whose expected half width is at most this one.

    Raises ValueError for a half width below a millionth of the spread, and for numbers that cannot be.
    """
    _check_scatter(spread, correlation)
    finite_number("half_width", half_width, above=0.0, at_least=NARROWEST * spread)
    whole_number("runs_per_bed", runs_per_bed, 1)

    def width(bed_count: int) -> float:
        found = expected_half_width(bed_count * runs_per_bed, bed_count, spread=spread, correlation=correlation)
        return math.inf if found is None else found

    # The width falls with every bed, so doubling and halving the step finds the fewest.
    upper = 2
    while width(upper) > half_width:
        upper *= 2
    lower = upper // 2
    while upper - lower > 1:
        middle = (lower + upper) // 2
        lower, upper = (middle, upper) if width(middle) > half_width else (lower, middle)
    return upper * runs_per_bed


def _check_scatter(spread: float, correlation: float) -> None:
    """Refuse a spread below 0, and a correlation outside 0 to 1, with a ValueError."""
    finite_number("spread", spread, at_least=0.0, at_most=LARGEST)
    finite_number("correlation", correlation, at_least=0.0, at_most=1.0)
