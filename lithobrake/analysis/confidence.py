"""A number with its interval at the one level of confidence, and how variance divides over beds."""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy import optimize, special

from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.estimate import LEVEL as LEVEL
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.given_numbers import (
    LARGEST,
    finite_number,
    labels,
    numbers_or_nan,
    whole_number,
    without_rounding,
)

Bounds = tuple[float, float]

# Shares nearer than this to 0 or 1 have skewed errors: their intervals are made on the logit scale.
NEAR_CERTAIN = 0.1
NORMAL_QUANTILE_95 = 1.959963984540054
# Probabilities beyond this quantile are below the smallest float.
MOST_QUANTILE = 40.0
# Directions along which beds are told apart by less than this part of the best are told by the inputs already.
SMALLEST_COUNT = 1e-9
# A variance of beds that is not cut at 0 stays this part of its way off the pole of the F statistic.
LEAST_SPREAD = 1e-6


def t_quantile(freedom: float, level: float = LEVEL) -> float:
    """Quantile of Student's t that a two-sided interval of the level reaches to."""
    return float(special.stdtrit(freedom, 0.5 + 0.5 * level))


def partial_quantile(width: float, error: float, freedom: float, level: float = LEVEL) -> float:
    """Errors to add outside of both ends of an identified range, so that each number within it is held at the level.

    width: of the range, at least 0; error: standard error of its ends, the larger one, above 0, in the same unit. From
    the two-sided quantile of Student's t where the range has no width down to the one-sided one where it is wide, since
    the number then can be missed at one end only.
    Source: [Imbens-2004], Eq 6 and 7, valid for ends that cannot cross by [Stoye-2009], Lemma 3; Student's t for beds.
    """

    def excess(quantile: float) -> float:
        return float(special.stdtr(freedom, quantile + width / error) - special.stdtr(freedom, -quantile)) - level

    two_sided = t_quantile(freedom, level)
    # Without a width rounding alone decides the sign.
    if excess(two_sided) <= 0.0:
        return two_sided
    return float(optimize.brentq(excess, 0.99 * float(special.stdtrit(freedom, level)), two_sided))


def normal_quantile(level: float = LEVEL) -> float:
    """Quantile of the standard normal distribution that a two-sided interval of the level reaches to."""
    return float(special.ndtri(0.5 + 0.5 * level))


def share_interval(share: float, half_width: float) -> tuple[float, float]:
    """Bounds of a share, within [0, 1]; the half width is laid on the logit scale where the share is near 0 or 1.

    Source: [Agresti-2013] (delta method: the logit's error is that of the share over p (1 - p)).
    """
    if NEAR_CERTAIN <= share <= 1.0 - NEAR_CERTAIN or share in (0.0, 1.0):
        return max(share - half_width, 0.0), min(share + half_width, 1.0)
    odds, half = share / (1.0 - share), half_width / (share * (1.0 - share))
    # Odds of exp(600) are a share of 1 to the last bit, and much larger ones overflow.
    lower, upper = odds * math.exp(-min(half, 600.0)), odds * math.exp(min(half, 600.0))
    return lower / (1.0 + lower), upper / (1.0 + upper)


def share_spread(share: float, deviation: float, level: float = LEVEL) -> tuple[float, float]:
    """Bounds that hold a share that varies about its mean by a standard deviation, within [0, 1].

    Near 0 or 1 the far one is a quantile of the beta law with both, as the logit of a share that reaches its end has
    none; the near one is that end, which few landings cannot tell from a share just short of it.
    """
    if NEAR_CERTAIN <= share <= 1.0 - NEAR_CERTAIN or share in (0.0, 1.0) or deviation == 0.0:
        return share_interval(share, normal_quantile(level) * deviation)
    # No share has a larger variance than one that is 0 or 1.
    size = share * (1.0 - share) / deviation**2 - 1.0
    if size <= 0.0:
        return 0.0, 1.0
    tail = 0.5 + 0.5 * level if share < 0.5 else 0.5 - 0.5 * level
    far = float(special.betaincinv(share * size, (1.0 - share) * size, tail))
    return (0.0, max(far, share)) if share < 0.5 else (min(far, share), 1.0)


def wilson_interval(count: int, total: int, quantile: float = NORMAL_QUANTILE_95) -> tuple[float, float]:
    """Interval of the true share when `count` of `total` independent draws have a property.

    quantile: of the standard normal distribution (1.96: 95 %). The interval stays within [0, 1] and holds near 0 and
    1, where the usual plus-minus does not. Raises ValueError for counts that cannot be, and for
    a quantile below 0.
    Source: [Wilson-1927].
    """
    count = whole_number("count", count, 0, whole_number("total", total, 1))
    finite_number("quantile", quantile, at_least=0.0, at_most=MOST_QUANTILE)
    share = count / total
    spread = quantile**2 / total
    middle = (share + spread / 2) / (1 + spread)
    half = quantile / (1 + spread) * math.sqrt(share * (1 - share) / total + spread / (4 * total))
    # The ends at nobody and at everybody are exact; rounding would leave them a hair away.
    return (0.0 if count == 0 else max(middle - half, 0.0)), (1.0 if count == total else min(middle + half, 1.0))


def numbered_beds(bed: ArrayLike, run_count: int) -> Labels:
    """Beds of the runs, [run_count], of any labels, renumbered from 0; raises ValueError for another shape."""
    beds = labels("bed", bed, run_count, "each run")
    return np.unique(beds, return_inverse=True)[1].astype(np.int64)


def answers(name: str, values: ArrayLike) -> Array:
    """Values of runs [run_count], NaN where a run has none or it is masked, constant where they differ by rounding.

    Raises ValueError for infinite ones.
    """
    known = numbers_or_nan(name, values)
    beyond = int((np.abs(known) > LARGEST).sum())
    if known.ndim != 1 or beyond:
        raise ValueError(
            f"{name} has shape {known.shape} and {beyond} infinite values or beyond {LARGEST:g}, but must be a number "
            "for each run: NaN where a run has none"
        )
    return without_rounding(known)


def answered_runs(values: ArrayLike, bed: ArrayLike) -> tuple[Array, Labels]:
    """Values of the runs that have one, of values [run_count] with NaN, and their beds numbered from 0, [count]."""
    of_all = answers("values", values)
    known = np.isfinite(of_all)
    beds = numbered_beds(bed, len(of_all))[known]
    return of_all[known], numbered_beds(beds, len(beds))


@dataclass(frozen=True)
class BedComponents:
    """What is left of runs when inputs are taken off, in directions along which only beds differ, and within beds.

    squares          of the runs along each direction between beds, [direction_count] [unit of the runs, squared]
    counts           each is expected to be within + count * (variance of beds), [direction_count]; runs of a bed where
                     counts are equal and nothing was taken off
    within           mean square within beds [unit of the runs, squared]
    within_freedom   its degrees of freedom
    """

    squares: Array
    counts: Array
    within: float
    within_freedom: int

    @property
    def bed_variance(self) -> float:
        """Variance of the beds' own means: free of bias, and below 0 where beds differ less than chance has it.

        Source: [Searle-1992], section 5.5 (Henderson's method III).
        """
        return float((self.squares.sum() - len(self.squares) * self.within) / self.counts.sum())

    def variance_at(self, probability: float, *, cut: bool = True) -> float:
        """Variance of beds with which they would differ more than here with this probability.

        At least 0, or, where it is not cut, above that with which beds would all have one sum. Exact for normal
        scatter, whatever the counts. Source: [Wald-1947]; [Thomas-1978] (a close approximation to it).
        """
        count = len(self.squares)
        quantile = float(special.fdtri(count, self.within_freedom, 1.0 - probability))
        if self.within <= 0.0:
            # The limit of the equation below for runs that are alike on each bed.
            return float(np.sum(self.squares / self.counts)) / (count * quantile)
        expected = count * self.within * quantile

        def excess(ratio: float) -> float:
            return float(np.sum(self.squares / (1.0 + ratio * self.counts))) - expected

        lowest = 0.0 if cut else -(1.0 - LEAST_SPREAD) / float(self.counts.max())
        if excess(lowest) <= 0.0:
            return self.within * lowest
        highest = 1.0 / self.counts.min()
        while excess(highest) > 0.0:
            highest *= 4.0
        return self.within * float(optimize.brentq(excess, lowest, highest, xtol=1e-12, rtol=1e-10))

    @property
    def positive(self) -> "BedComponents":
        """These, or where beds differ less than chance has it those of beds that differ as chance has it."""
        least = len(self.squares) * self.within
        if self.squares.sum() >= least:
            return self
        # Squares that are all 0 have no spread to scale.
        squares = self.squares * least / self.squares.sum() if self.squares.any() else self.squares + self.within
        return replace(self, squares=squares)

    def correlation_at(self, variance: float) -> float:
        """Correlation of two runs on one bed (intraclass) with this variance of beds [unit of the runs, squared]."""
        return variance / (variance + self.within) if self.within > 0.0 else 1.0

    @property
    def correlation(self) -> Estimate:
        """Correlation of two runs on one bed (intraclass): the value not cut at 0, its bounds within [0, 1]."""
        if self.within <= 0.0:
            return Estimate(1.0, 0.0, 1.0)
        variances = [self.bed_variance, *(self.variance_at(0.5 + side * LEVEL) for side in (-0.5, 0.5))]
        value, lower, upper = (self.correlation_at(one) for one in variances)
        return Estimate(value, lower, upper)


def bed_components(values: Array, bed: Labels, terms: Array | None = None) -> BedComponents:
    """Components of values [run_count] on beds [run_count], numbered from 0, beside terms [run_count, term_count].

    Terms and beds are fitted together: what a bed owes to the inputs of its runs is not told as the bed's own. Raises
    ValueError for one bed, or no run to spare within beds.
    Source: [Searle-1992], sections 3.6 and 5.5.
    """
    bed_count = int(bed.max()) + 1
    taken = np.ones((len(values), 1)) if terms is None else np.column_stack([np.ones(len(values)), terms])
    freedom = len(values) - bed_count - taken.shape[1] + 1
    if bed_count < 2 or freedom < 1:
        raise ValueError(
            f"{len(values)} runs on {bed_count} beds with {taken.shape[1] - 1} terms cannot tell beds from scatter "
            "within them; give at least two beds, and more runs than beds and terms together"
        )
    orthogonal = np.linalg.qr(taken)[0]
    indicators = np.zeros((len(values), bed_count))
    indicators[np.arange(len(values)), bed] = 1.0
    left, beds_left = (one - orthogonal @ (orthogonal.T @ one) for one in (values, indicators))
    counts, directions = np.linalg.eigh(beds_left.T @ beds_left)
    used = counts > SMALLEST_COUNT * counts[-1]
    squares = (directions[:, used].T @ (beds_left.T @ left)) ** 2 / counts[used]
    within = max(float(left @ left - squares.sum()), 0.0) / freedom
    return BedComponents(squares, counts[used], within, freedom)
