"""The difference between two studies paired by run, whatever became of missing runs, and their typical ratio."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.analysis.confidence import Bounds, answers, numbered_beds
from lithobrake.analysis.missing_runs import lost_runs
from lithobrake.analysis.output_estimates import mean_estimate, quantile_ends, quantile_estimate
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
    missing         share of the runs of each study of which it is not known what became of them
    if_missing      smallest and largest difference that these leave, without sampling error; None where nothing
                    limits one
    is_ratio        whether difference and unpaired are of second over first less 1
    """

    first: Estimate
    second: Estimate
    difference: Estimate
    correlation: float | None
    unpaired: Bounds | None
    pairs: int
    missing: tuple[float, float]
    if_missing: Bounds | None
    is_ratio: bool = False

    @property
    def landings_saved(self) -> float | None:
        """How many times the runs an unpaired comparison takes for an interval as narrow; None where there is none.

        More runs narrow the sampling error alone, and not what missing runs leave open. Of a ratio by the widths of its
        logarithm.
        """
        bounds = self.difference.bounds
        if self.unpaired is None or bounds is None or self.if_missing is None:
            return None
        scale = np.log1p if self.is_ratio else np.asarray
        open_, paired, unpaired = (float(np.ptp(scale(one))) for one in (self.if_missing, bounds, self.unpaired))
        paired, unpaired = paired - open_, unpaired - open_
        return (unpaired / paired) ** 2 if paired > 0.0 else None


@dataclass(frozen=True)
class _Answer:
    """The answer of one study: its estimate, what it is with missing runs at either end, and what each run contributes.

    ends: the answer whatever became of the missing runs, without sampling error; None where nothing limits it.
    runs [run_count]: contributions, NaN where a run has none; lost [run_count]; lost_ends: what a missing run
    contributes to either end.
    """

    estimate: Estimate
    ends: tuple[float | None, float | None]
    runs: Array
    lost: NDArray[np.bool_]
    lost_ends: tuple[float, float]

    def contributions(self, end: int) -> Array:
        """Those of all runs with the missing ones at an end, 0 or 1."""
        return np.where(self.lost, self.lost_ends[end], self.runs)


def share_difference(
    first: ArrayLike, second: ArrayLike, bed: ArrayLike, *, why: str | None = None
) -> PairedDifference:
    """Difference of the means of shares [pair_count], each 0 to 1, NaN without an outcome, on these beds [pair_count].

    why: a reason why the pairs give no interval, as one impact point. Intervals of both as `share_estimate` has them,
    and that of the difference holds whatever became of the landings without an outcome. Raises ValueError where no
    landing of a study has one.
    """

    def estimated(shares: Array, _: NDArray[np.bool_]) -> _Answer:
        found = share_estimate(shares, bed, why=why)
        return _Answer(found.share, found.if_missing, shares, np.isnan(shares), (0.0, 1.0))

    return _difference(estimated, first, second, bed, None)


def quantile_difference(
    first: ArrayLike,
    second: ArrayLike,
    bed: ArrayLike,
    probability: float,
    *,
    counts: bool = False,
    why: str | None = None,
    missing: tuple[ArrayLike, ArrayLike] | None = None,
) -> PairedDifference:
    """Difference of a quantile of an output [pair_count], NaN where a run has none, on these beds [pair_count].

    Each quantile is over the runs that have the output in its own study. missing: of each study [pair_count] whether it
    is not known what became of a run; counts, why: as for `quantile_estimate`.
    """

    def estimated(values: Array, lost: NDArray[np.bool_]) -> _Answer:
        found = quantile_estimate(values, bed, probability, counts=counts, why=why, missing=lost)
        if not found.is_known:
            return _Answer(found, (None, None), values, lost, (0.0, 0.0))
        # The quantile is the higher the fewer values lie below it.
        below = np.where(np.isfinite(values), -(values <= found.value).astype(float), np.nan)
        return _Answer(found, quantile_ends(values, probability, lost, counts=counts), below, lost, (-1.0, 0.0))

    return _difference(estimated, first, second, bed, missing)


def ratio_difference(
    first: ArrayLike,
    second: ArrayLike,
    bed: ArrayLike,
    *,
    why: str | None = None,
    missing: tuple[ArrayLike, ArrayLike] | None = None,
) -> PairedDifference:
    """Typical ratio of a positive output [pair_count], second over first less 1, of the pairs that have both.

    It is exp of the mean of log(second / first) over beds, which uses how far each pair differs; first and second are
    the geometric means of these runs. NaN where a run has none or it is not above 0; UNKNOWN for fewer than two such
    pairs. missing: as for `quantile_difference`; nothing limits the ratio of such a run, so with one there are no
    bounds. why: a reason why the pairs give no interval. Source: [Cameron-2008] (errors from few clusters).
    """
    values = np.array([answers("first", first), answers("second", second)])
    lost = [lost_runs(out, one) for out, one in zip(missing or (None, None), values, strict=True)]
    shares = float(lost[0].mean()), float(lost[1].mean())
    beds = numbered_beds(bed, values.shape[1])
    values[:, ~(values > 0.0).all(axis=0)] = np.nan
    both = np.isfinite(values).all(axis=0)
    pairs = int(both.sum())
    if pairs < 2:
        return PairedDifference(UNKNOWN, UNKNOWN, UNKNOWN, None, None, pairs, shares, None, is_ratio=True)
    (one, two), beds = np.log(values[:, both]), beds[both]
    if why or len(np.unique(beds)) < 2 or max(shares) > 0.0:
        found = [Estimate(float(part.mean()), None, None) for part in (one, two, two - one)]
    else:
        found = [mean_estimate(part, beds) for part in (one, two, two - one)]
    apart, ratio = difference_bounds(found[0], found[1]), found[2].on_scale(math.expm1)
    return PairedDifference(
        first=found[0].on_scale(math.exp),
        second=found[1].on_scale(math.exp),
        difference=ratio,
        correlation=_correlation(one - one.mean(), two - two.mean()),
        unpaired=None if apart is None else (math.expm1(apart[0]), math.expm1(apart[1])),
        pairs=pairs,
        missing=shares,
        if_missing=None if max(shares) > 0.0 else (ratio.value, ratio.value),
        is_ratio=True,
    )


def _difference(
    estimated: Callable[[Array, NDArray[np.bool_]], _Answer],
    first: ArrayLike,
    second: ArrayLike,
    bed: ArrayLike,
    missing: tuple[ArrayLike, ArrayLike] | None,
) -> PairedDifference:
    """From the estimate of each study and what each run contributes to it."""
    of_first, of_second = answers("first", first), answers("second", second)
    beds = numbered_beds(bed, len(of_first))
    if len(of_first) != len(of_second):
        raise ValueError(f"first has {len(of_first)} runs and second {len(of_second)}; give the same pairs of both")
    lost = missing or (None, None)
    one, two = (
        estimated(values, lost_runs(out, values)) for values, out in zip((of_first, of_second), lost, strict=True)
    )
    paired, unpaired = (_bounds_between(one, two, beds, is_paired=is_paired) for is_paired in (True, False))
    lower, upper = paired if paired is not None else (None, None)
    known = one.estimate.is_known and two.estimate.is_known
    value = two.estimate.value - one.estimate.value
    return PairedDifference(
        first=one.estimate,
        second=two.estimate,
        difference=Estimate(value, lower, upper) if known else UNKNOWN,
        correlation=pair_correlation(one.runs, two.runs, beds),
        unpaired=unpaired,
        pairs=int((np.isfinite(one.runs) & np.isfinite(two.runs)).sum()),
        missing=(float(one.lost.mean()), float(two.lost.mean())),
        if_missing=_open_between(one, two),
    )


def _open_between(one: _Answer, two: _Answer) -> Bounds | None:
    """Smallest and largest difference whatever became of the missing runs of both."""
    if None in (*one.ends, *two.ends):
        return None
    (one_least, one_most), (two_least, two_most) = one.ends, two.ends
    return two_least - one_most, two_most - one_least  # type: ignore[operator]


def _bounds_between(one: _Answer, two: _Answer, beds: Labels, *, is_paired: bool) -> Bounds | None:
    """Bounds of the second less the first, as `difference_bounds`, about the ends that missing runs leave open.

    What the two runs of a pair have in common is told with missing runs at the end of each bound.
    """
    between = _open_between(one, two)
    if between is None or one.estimate.bounds is None or two.estimate.bounds is None:
        return None
    (one_low, one_high), (two_low, two_high) = one.estimate.bounds, two.estimate.bounds
    (one_least, one_most), (two_least, two_most) = one.ends, two.ends
    reaches = (one_high - one_most, two_least - two_low), (one_least - one_low, two_high - two_most)  # type: ignore[operator]
    found = []
    for end, (a, b) in enumerate(reaches):
        both = one.contributions(1 - end), two.contributions(end)
        common = pair_correlation(*both, beds) if is_paired else None
        found.append(_reach(a, b, common or 0.0))
    return between[0] - found[0], between[1] + found[1]


def _reach(a: float, b: float, correlation: float) -> float:
    """How far an end of a difference reaches, by the reaches of both numbers on the sides that decide."""
    return math.sqrt(max(a * a + b * b - 2.0 * correlation * a * b, 0.0))


def difference_bounds(first: Estimate, second: Estimate, correlation: float = 0.0) -> Bounds | None:
    """Bounds of second less first; None where one of both lacks an end.

    Source: [Zou-2008] (the variances are recovered at the bounds that decide).
    """
    if first.bounds is None or second.bounds is None:
        return None
    (one, (one_low, one_high)), (two, (two_low, two_high)) = (first.value, first.bounds), (second.value, second.bounds)
    lower, upper = (
        _reach(one_high - one, two - two_low, correlation),
        _reach(one - one_low, two_high - two, correlation),
    )
    return two - one - lower, two - one + upper


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
