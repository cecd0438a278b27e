"""What chance alone does to the counts and shares of a page."""

import math
from collections.abc import Sequence

# Half of the middle nine tenths of a normal distribution, in standard deviations.
NINE_TENTHS = 1.645
# What the bands of the emulator should hold of the runs (band_90 of its scores).
BAND = 0.9


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
