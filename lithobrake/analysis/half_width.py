"""How wide an interval will be before anything has run, and how many runs a width asks for."""

import math

from lithobrake.analysis.confidence import t_quantile
from lithobrake.vocabulary.given_numbers import LARGEST, finite_number, whole_number

# Standard deviation of a run's share of flights that return, as measured on studies in which some do and some do not
# (docs/estimates.md): the range, and the larger one, which promises no more than a study keeps.
SPREAD_RANGE = (0.04, 0.21)
SPREAD = SPREAD_RANGE[1]
# Correlation of two runs on one bed in the mean over studies, of the return fraction of landings and of the fraction at
# rest of journeys (docs/estimates.md).
CORRELATION, JOURNEY_CORRELATION = 0.02, 0.07
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


def best_runs_a_bed(bed_cost: float, correlation: float = CORRELATION) -> float:
    """Runs on each bed that give the narrowest interval for their time, sqrt(c (1 - rho) / rho), at least 1.

    bed_cost: of a bed, c, in runs, above 0; correlation of two runs on one bed, rho: 0 gives infinity, 1 gives 1.
    Raises ValueError for numbers that cannot be. Source: [Cochran-1977], section 10.6.
    """
    finite_number("bed_cost", bed_cost, above=0.0)
    _check_scatter(0.0, correlation)
    return max(math.sqrt(bed_cost * (1.0 - correlation) / correlation), 1.0) if correlation else math.inf


def cost_over_best(runs_a_bed: float, best: float, bed_cost: float, correlation: float = CORRELATION) -> float:
    """Time for an interval of one width with so many runs on each bed, over that with another number of them.

    runs_a_bed, best, bed_cost (in runs): above 0. Student's t, which falls with more beds, is left out.
    Raises ValueError for numbers that cannot be. Source: [Cochran-1977], section 10.6.
    """
    for name, value in (("runs_a_bed", runs_a_bed), ("best", best), ("bed_cost", bed_cost)):
        finite_number(name, value, above=0.0)
    _check_scatter(0.0, correlation)
    # Cost of a run with its part of the bed, times variance of the mean over that of independent runs.
    costs = [(1.0 + bed_cost / one) * (1.0 + (one - 1.0) * correlation) for one in (runs_a_bed, best)]
    return costs[0] / costs[1]


def runs_for_half_width(
    half_width: float, runs_per_bed: int = 20, *, spread: float = SPREAD, correlation: float = CORRELATION
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
