"""How likely an event may be that none of the runs has met, which are alike on one bed to an unknown extent."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike
from scipy import optimize, special

from lithobrake.analysis.confidence import LEVEL
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.constants import LARGEST_CORRELATION
from lithobrake.vocabulary.given_numbers import finite_number, labels, numbers, whole_number
from lithobrake.vocabulary.number_words import EXPANSION_LEVEL

# More units than any study has; a float holds their number.
MOST_UNITS = 2**53
# An event that fewer runs are expected to have met is as one that none has met.
HALF_RUN = 0.5
# How many runs there are in all, or on each bed.
RunCounts = int | Sequence[int]


def upper_limit(unit_count: int, level: float = EXPANSION_LEVEL) -> float:
    """Upper confidence limit of the probability of an event that occurred in none of so many independent units.

    Units are independent: runs that have no bed in common, or beds where runs on one may be alike (`unseen_limit`).
    Raises ValueError for a count below 0, and for a level outside 0 to 1.
    Source: [Clopper-1934], at a count of 0; about 3 / unit_count for 0.95.
    """
    finite_number("level", level, above=0.0, below=1.0)
    # Without any unit the event may have every probability.
    if whole_number("unit_count", unit_count, 0, MOST_UNITS) == 0:
        return 1.0
    return float(1.0 - (1.0 - level) ** (1.0 / unit_count))


def unseen_limit(
    bed: ArrayLike, *, weights: ArrayLike | None = None, correlation: float = LARGEST_CORRELATION
) -> float:  # fmt: skip
    """Largest probability, at `LEVEL`, of an event that none of the runs on these beds [run_count] has met.

    bed          labels of the beds of the runs of which it is known that they have not met it
    weights      density of the input distribution over that the runs were drawn from [run_count]; None: 1. They count
                 as so many runs of equal weight as have their error
    correlation  of two runs on one bed, from 0 (each run tells) to 1 (each bed tells): the limit holds for it and for
                 every smaller one

    The probability differs between beds by a beta law. Raises ValueError for what is no label for each run, weights
    that are not above 0, and a correlation outside 0 to 1.
    Source: [Skellam-1948] (beta-binomial law, at a count of 0); [Berger-1994] (largest limit over what is not known);
    [Kish-1965], section 11.7 (unequal weights).
    """
    beds = labels("bed", bed, np.size(np.asanyarray(bed)), "each run")
    if weights is None:
        return limit_of_counts(np.unique(beds, return_counts=True)[1], correlation=correlation)
    w = numbers("weights", weights)
    if w.shape != beds.shape or not np.all((w > 0.0) & np.isfinite(w)):
        raise ValueError(f"weights have shape {w.shape}; give one finite number above 0 for each of {len(beds)} runs")
    return limit_of_counts(np.unique(beds, return_counts=True)[1], part_that_counts(w), correlation)


def part_that_counts(weights: Array) -> float:
    """Runs of equal weight that have the error of these [run_count], over their number. Source: [Kish-1965]."""
    return float(np.sum(weights) ** 2 / (len(weights) * np.sum(weights**2))) if len(weights) else 1.0


def even_limit(run_count: int, bed_count: int, level: float = LEVEL) -> float:
    """The limit of so many runs that are spread evenly over beds, as `unseen_limit`."""
    beds = min(whole_number("bed_count", bed_count, 0, MOST_UNITS), whole_number("run_count", run_count, 0, MOST_UNITS))
    # Beds with as many runs count alike, so one of them stands for all.
    return limit_of_counts(np.array([run_count / beds]), float(beds), level=level) if beds else 1.0


def runs_by_bed(bed: ArrayLike) -> tuple[int, tuple[int, ...]]:
    """How many beds there are, and how many runs on each, by the bed of each run [run_count]."""
    counts = np.unique(np.asarray(bed), return_counts=True)[1].tolist()
    return len(counts), tuple(counts)


def limit_of_runs(runs: RunCounts, bed_count: int, level: float = LEVEL) -> float:
    """The limit of so many runs as if evenly over beds, or of those of each bed [bed_count] where these are known."""
    if isinstance(runs, Sequence):
        return limit_of_counts([count for count in runs if count], level=level)
    return even_limit(runs, bed_count, level)


def limit_of_counts(
    counts: ArrayLike, part: float = 1.0, correlation: float = LARGEST_CORRELATION, level: float = LEVEL
) -> float:
    """The limit of beds with these counts of runs [bed_count], at least 1 each; part: of all this that counts."""
    finite_number("correlation", correlation, at_least=0.0, at_most=1.0)
    runs, beds = np.unique(np.asarray(counts, dtype=float), return_counts=True)
    if not len(runs):
        return 1.0
    units = part * float(beds @ runs), part * float(beds.sum())
    least, most = (-math.expm1(math.log(1.0 - level) / one) for one in units)
    # A smaller correlation is none, to more digits than the logarithms of the beta law have.
    if correlation < 1e-7 or correlation == 1.0 or most - least <= 0.0:
        return most if correlation == 1.0 else least
    # Of the beta law: both parameters together.
    size = (1.0 - correlation) / correlation
    target = math.log(1.0 - level) / part + float(beds @ (special.gammaln(size + runs) - special.gammaln(size)))

    def excess(limit: float) -> float:
        other = (1.0 - limit) * size
        return float(beds @ (special.gammaln(other + runs) - special.gammaln(other))) - target

    # Where the two ends hardly differ, rounding hides on which side of them the limit lies.
    if excess(least) <= 0.0 or excess(most) >= 0.0:
        return least if excess(least) <= 0.0 else most
    return float(optimize.brentq(excess, least, most, xtol=1e-12, rtol=1e-12))
