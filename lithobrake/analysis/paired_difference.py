"""The difference between two studies whose runs are paired by number: same beds, places, attitudes and headings.

What both runs of a pair meet alike cancels in the difference. Its interval follows from those of the two studies and
from how far the runs of a pair go together.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import LEVEL, Bounds, answers, numbered_beds
from lithobrake.analysis.output_estimates import quantile_estimate
from lithobrake.analysis.share_estimate import share_estimate
from lithobrake.vocabulary.arrays import Array, Labels

# With so few beds their sums say less of a correlation than the pairs do.
FEWEST_BEDS = 8


@dataclass(frozen=True)
class Estimated:
    """A number of one study, in its unit; a bound that the runs cannot give is None."""

    value: float | None
    lower: float | None
    upper: float | None


@dataclass(frozen=True)
class PairedDifference:
    """The second study less the first, in the unit of the answer.

    first, second   the answer of each, from the pairs alone
    value           the difference; None where one of them has no answer
    lower, upper    its interval; None where one of the studies cannot bound it
    level           confidence of the interval
    correlation     of the two runs of a pair, about the answer of each study; None where one of them does not vary
    unpaired        lower and upper bound that two studies of the same sizes would give without pairs; None likewise
    pairs           with an answer in both studies
    """

    first: Estimated
    second: Estimated
    value: float | None
    lower: float | None
    upper: float | None
    level: float
    correlation: float | None
    unpaired: Bounds | None
    pairs: int

    @property
    def landings_saved(self) -> float | None:
        """How many times the runs an unpaired comparison takes for an interval as narrow; None where there is none."""
        if self.unpaired is None or self.lower is None or self.upper is None or self.upper <= self.lower:
            return None
        return ((self.unpaired[1] - self.unpaired[0]) / (self.upper - self.lower)) ** 2


def share_difference(
    first: ArrayLike, second: ArrayLike, bed: ArrayLike, *, why: str | None = None
) -> PairedDifference:
    """Difference of the means of shares [pair_count], each 0 to 1, NaN without an outcome, on these beds [pair_count].

    why: a reason why the pairs give no interval, as one impact point. Intervals of both as `share_estimate` has them,
    so landings without an outcome widen them. Raises ValueError where no pair has an outcome in both.
    """

    def estimated(shares: Array) -> tuple[Estimated, Array]:
        found = share_estimate(shares, bed, why=why)
        return Estimated(found.share, found.lower, found.upper), shares

    return _difference(estimated, first, second, bed)


def quantile_difference(
    first: ArrayLike,
    second: ArrayLike,
    bed: ArrayLike,
    probability: float,
    *,
    counts: bool = False,
    why: str | None = None,
) -> PairedDifference:
    """Difference of a quantile of an output [pair_count], NaN where a run has none, on these beds [pair_count].

    Each quantile is over the runs that have the output in its own study. counts, why: as for `quantile_estimate`.
    """

    def estimated(values: Array) -> tuple[Estimated, Array]:
        found = quantile_estimate(values, bed, probability, counts=counts, why=why)
        if found.value is None:
            return Estimated(None, None, None), values
        below = np.where(np.isfinite(values), (values <= found.value).astype(float), np.nan)
        # The quantile is the higher the fewer values lie below it.
        return Estimated(found.value, found.lower, found.upper), -below

    return _difference(estimated, first, second, bed)


def _difference(
    estimated: Callable[[Array], tuple[Estimated, Array]], first: ArrayLike, second: ArrayLike, bed: ArrayLike
) -> PairedDifference:
    """From the estimate of each study and what each run contributes to it."""
    of_first, of_second = answers("first", first), answers("second", second)
    beds = numbered_beds(bed, len(of_first))
    if len(of_first) != len(of_second):
        raise ValueError(f"first has {len(of_first)} runs and second {len(of_second)}; give the same pairs of both")
    (one, given), (two, taken) = estimated(of_first), estimated(of_second)
    pairs = int((np.isfinite(given) & np.isfinite(taken)).sum())
    value = None if one.value is None or two.value is None else two.value - one.value
    correlation = pair_correlation(given, taken, beds)
    bounds, unpaired = (_bounds(one, two, r) for r in (correlation or 0.0, 0.0))
    lower, upper = bounds if bounds is not None else (None, None)
    return PairedDifference(one, two, value, lower, upper, LEVEL, correlation, unpaired, pairs)


def _bounds(first: Estimated, second: Estimated, correlation: float) -> Bounds | None:
    """Bounds of second less first; None where one of both lacks an end."""
    ends = (first.value, first.lower, first.upper, second.value, second.lower, second.upper)
    if None in ends:
        return None
    one, one_low, one_high, two, two_low, two_high = (float(end) for end in ends if end is not None)
    return difference_bounds((one, one_low, one_high), (two, two_low, two_high), correlation)


def difference_bounds(
    first: tuple[float, float, float], second: tuple[float, float, float], correlation: float = 0.0
) -> Bounds:
    """Bounds of second less first, each given as value, lower and upper bound.

    Source: [Zou-2008] (the variances are recovered at the bounds that decide).
    """
    (one, one_low, one_high), (two, two_low, two_high) = first, second

    def reach(a: float, b: float) -> float:
        return math.sqrt(max(a * a + b * b - 2.0 * correlation * a * b, 0.0))

    return two - one - reach(one_high - one, two - two_low), two - one + reach(one - one_low, two_high - two)


def pair_correlation(first: Array, second: Array, beds: Labels) -> float | None:
    """Correlation of what the two runs of a pair contribute, each [pair_count] with NaN; None where one does not vary.

    That of the pairs or that of the sums over beds, whichever is lower: an interval is then never too narrow for a
    correlation that one of them has by chance.
    """
    both = np.isfinite(first) & np.isfinite(second)
    if both.sum() < 3:
        return None
    one, two = (values[both] - values[both].mean() for values in (first, second))
    found = [_correlation(one, two)]
    number = np.unique(beds[both], return_inverse=True)[1]
    if number.max() + 1 >= FEWEST_BEDS:
        sums = [np.bincount(number, values).astype(np.float64) for values in (one, two)]
        found.append(_correlation(sums[0], sums[1]))
    known = [r for r in found if r is not None]
    return min(known) if known else None


def _correlation(one: Array, two: Array) -> float | None:
    norm = math.sqrt(float(one @ one) * float(two @ two))
    return float(one @ two) / norm if norm > 0.0 else None
