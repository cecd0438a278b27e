"""Variance between beds and within them, beside what the inputs explain: analysis of variance with random beds."""

from dataclasses import dataclass, replace

import numpy as np

from lithobrake.analysis.confidence import LEVEL, IntervalEstimate
from lithobrake.vocabulary.arrays import Array, Labels

# Directions along which beds are told apart by less than this part of the best are told by the inputs already.
SMALLEST_COUNT = 1e-9
# A variance of beds that is not cut at 0 stays this part of its way off the pole of the F statistic.
LEAST_SPREAD = 1e-6


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
        from scipy import optimize, special

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
    def correlation(self) -> IntervalEstimate:
        """Correlation of two runs on one bed (intraclass): the value not cut at 0, its bounds within [0, 1]."""
        if self.within <= 0.0:
            return IntervalEstimate(1.0, 0.0, 1.0)
        variances = [self.bed_variance, *(self.variance_at(0.5 + side * LEVEL) for side in (-0.5, 0.5))]
        value, lower, upper = (self.correlation_at(one) for one in variances)
        return IntervalEstimate(value, lower, upper)


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
