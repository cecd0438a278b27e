"""The difference between two studies paired by run: of a fraction, of a quantile, and the typical ratio."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import Bounds, answers, numbered_beds
from lithobrake.analysis.output_estimates import mean_estimate, quantile_estimate
from lithobrake.analysis.share_estimate import share_estimate
from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.constants import FEWEST_BEDS_OF_CORRELATION
from lithobrake.vocabulary.estimate import Estimate

UNKNOWN = Estimate(math.nan, None, None)


@dataclass(frozen=True)
class PairedDifference:
    """Second study minus first study, in the unit of the result.

    first, second   the answer of each, from the pairs alone
    difference      NaN where one of them has no answer; without an interval where one of the studies cannot bound it
    correlation     of the two runs of a pair, about the answer of each study; None where one of them does not vary
    unpaired        lower and upper bound that two studies of the same sizes would give without pairs; None likewise
    pairs           with an answer in both studies
    is_ratio        whether difference and unpaired are of second over first less 1
    """

    first: Estimate
    second: Estimate
    difference: Estimate
    correlation: float | None
    unpaired: Bounds | None
    pairs: int
    is_ratio: bool = False

    @property
    def landings_saved(self) -> float | None:
        """How many times the runs an unpaired comparison takes for an interval as narrow; None where there is none.

        Of a ratio by the widths of its logarithm.
        """
        bounds = self.difference.bounds
        if self.unpaired is None or bounds is None or bounds[1] <= bounds[0]:
            return None
        wide, narrow = (np.log1p(ends) if self.is_ratio else np.array(ends) for ends in (self.unpaired, bounds))
        return float((np.ptp(wide) / np.ptp(narrow)) ** 2)


def share_difference(
    first: ArrayLike, second: ArrayLike, bed: ArrayLike, *, why: str | None = None
) -> PairedDifference:
    """Difference of the means of shares [pair_count], each 0 to 1, NaN without an outcome, on these beds [pair_count].

    why: a reason why the pairs give no interval, as one impact point. Intervals of both as `share_estimate` has them,
    so landings without an outcome widen them. Raises ValueError where no pair has an outcome in both.
    """

    def estimated(shares: Array) -> tuple[Estimate, Array]:
        return share_estimate(shares, bed, why=why).share, shares

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

    def estimated(values: Array) -> tuple[Estimate, Array]:
        found = quantile_estimate(values, bed, probability, counts=counts, why=why)
        if not found.is_known:
            return found, values
        below = np.where(np.isfinite(values), (values <= found.value).astype(float), np.nan)
        # The quantile is the higher the fewer values lie below it.
        return found, -below

    return _difference(estimated, first, second, bed)


def ratio_difference(
    first: ArrayLike, second: ArrayLike, bed: ArrayLike, *, why: str | None = None
) -> PairedDifference:
    """Typical ratio of a positive output [pair_count], second over first less 1, of the pairs that have both.

    It is exp of the mean of log(second / first) over beds, which uses how far each pair differs; first and second are
    the geometric means of these runs. NaN where a run has none or it is not above 0; UNKNOWN for fewer than two such
    pairs. why: a reason why the pairs give no interval. Source: [Cameron-2008] (errors from few clusters).
    """
    values = np.array([answers("first", first), answers("second", second)])
    beds = numbered_beds(bed, values.shape[1])
    values[:, ~(values > 0.0).all(axis=0)] = np.nan
    both = np.isfinite(values).all(axis=0)
    pairs = int(both.sum())
    if pairs < 2:
        return PairedDifference(UNKNOWN, UNKNOWN, UNKNOWN, None, None, pairs, is_ratio=True)
    (one, two), beds = np.log(values[:, both]), beds[both]
    if why or len(np.unique(beds)) < 2:
        found = [Estimate(float(part.mean()), None, None) for part in (one, two, two - one)]
    else:
        found = [mean_estimate(part, beds) for part in (one, two, two - one)]
    apart = difference_bounds(found[0], found[1])
    return PairedDifference(
        first=found[0].on_scale(math.exp),
        second=found[1].on_scale(math.exp),
        difference=found[2].on_scale(math.expm1),
        correlation=_correlation(one - one.mean(), two - two.mean()),
        unpaired=None if apart is None else (math.expm1(apart[0]), math.expm1(apart[1])),
        pairs=pairs,
        is_ratio=True,
    )


def _difference(
    estimated: Callable[[Array], tuple[Estimate, Array]], first: ArrayLike, second: ArrayLike, bed: ArrayLike
) -> PairedDifference:
    """From the estimate of each study and what each run contributes to it."""
    of_first, of_second = answers("first", first), answers("second", second)
    beds = numbered_beds(bed, len(of_first))
    if len(of_first) != len(of_second):
        raise ValueError(f"first has {len(of_first)} runs and second {len(of_second)}; give the same pairs of both")
    (one, given), (two, taken) = estimated(of_first), estimated(of_second)
    pairs = int((np.isfinite(given) & np.isfinite(taken)).sum())
    correlation = pair_correlation(given, taken, beds)
    bounds, unpaired = (difference_bounds(one, two, r) for r in (correlation or 0.0, 0.0))
    lower, upper = bounds if bounds is not None else (None, None)
    difference = Estimate(two.value - one.value, lower, upper) if one.is_known and two.is_known else UNKNOWN
    return PairedDifference(one, two, difference, correlation, unpaired, pairs)


def difference_bounds(first: Estimate, second: Estimate, correlation: float = 0.0) -> Bounds | None:
    """Bounds of second less first; None where one of both lacks an end.

    Source: [Zou-2008] (the variances are recovered at the bounds that decide).
    """
    if first.bounds is None or second.bounds is None:
        return None
    (one, (one_low, one_high)), (two, (two_low, two_high)) = (first.value, first.bounds), (second.value, second.bounds)

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
    if number.max() + 1 >= FEWEST_BEDS_OF_CORRELATION:
        sums = [np.bincount(number, values).astype(np.float64) for values in (one, two)]
        found.append(_correlation(sums[0], sums[1]))
    known = [r for r in found if r is not None]
    return min(known) if known else None


def _correlation(one: Array, two: Array) -> float | None:
    norm = math.sqrt(float(one @ one) * float(two @ two))
    return float(one @ two) / norm if norm > 0.0 else None
