"""What chance alone does to the counts, shares and ellipses of a page."""

import math
from collections.abc import Sequence

from lithobrake.results.dispersion import LandingEllipses

# Half of the middle nine tenths of a normal distribution, in standard deviations.
NINE_TENTHS = 1.645
# What the bands of the emulator should hold of the runs (band_90 of its scores).
BAND = 0.9
# Of half and 95 % of a Gaussian law in the plane: logarithm of the ratio of the squared sizes of their ellipses.
GAUSSIAN_RATIO = math.log(math.log(0.05) / math.log(0.5))
# Variance of that logarithm from a sample, times the number of places (delta method on two exponential quantiles).
RATIO_VARIANCE = 0.95 / 0.05 / math.log(0.05) ** 2 + 1.0 / math.log(0.5) ** 2 - 2.0 / (math.log(0.5) * math.log(0.05))
# Departures of the ratio of both sizes by less than this are no matter [-].
TOLERANCE = 0.1


def luck(counts: Sequence[int]) -> tuple[float, float]:
    """Between which counts nine of ten bins lie where all is right, if runs are independent."""
    total, bins = sum(counts), len(counts)
    half = NINE_TENTHS * math.sqrt(total / bins * (1.0 - 1.0 / bins))
    return total / bins - half, total / bins + half


def unlucky(counts: Sequence[int]) -> list[bool]:
    """Which bins lie outside of that."""
    low, high = luck(counts)
    return [not low <= count <= high for count in counts]


def band_luck(run_count: int) -> tuple[float, float]:
    """Between which shares nine of ten right bands hold as many independent runs."""
    half = NINE_TENTHS * math.sqrt(BAND * (1.0 - BAND) / run_count)
    return BAND - half, BAND + half


def follows_gaussian(ellipses: LandingEllipses | None, count: int) -> bool:
    """Whether the ellipses of half and of 95 % of so many places have sizes as under a Gaussian law.

    Each holds its share by construction; a Gaussian law has one ratio of their sizes, 2.08, and where that of the
    places differs by more than 10 % and than chance (90 %), the larger holds another share than a Gaussian law says.
    Source: [Cramer-1946], chapter 28 (variances of sample quantiles).
    """
    sizes = {one.share: one.semi_axes_deg[0] for one in ellipses.shares} if ellipses else {}
    if not {0.5, 0.95} <= sizes.keys():
        return True
    departure = abs(2.0 * math.log(sizes[0.95] / sizes[0.5]) - GAUSSIAN_RATIO)
    return departure < max(2.0 * math.log1p(TOLERANCE), NINE_TENTHS * math.sqrt(RATIO_VARIANCE / count))
