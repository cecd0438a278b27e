"""A share counted in a sample, and how far it may be from the truth by the luck of the draw."""

import math

NORMAL_QUANTILE_95 = 1.959963984540054


def wilson_interval(count: int, total: int, quantile: float = NORMAL_QUANTILE_95) -> tuple[float, float]:
    """Interval of the true share when `count` of `total` independent draws have a property.

    quantile: of the standard normal distribution (1.96: 95 %). The interval stays within [0, 1] and holds near 0 and
    1, where the usual plus-minus does not. Raises ValueError for counts that cannot be.
    Source: [Wilson-1927].
    """
    if total < 1 or not 0 <= count <= total:
        raise ValueError(f"{count} of {total} is no share; the count must lie between 0 and a total of at least 1")
    share = count / total
    spread = quantile**2 / total
    middle = (share + spread / 2) / (1 + spread)
    half = quantile / (1 + spread) * math.sqrt(share * (1 - share) / total + spread / (4 * total))
    # The ends at nobody and at everybody are exact; rounding would leave them a hair away.
    return (0.0 if count == 0 else max(middle - half, 0.0)), (1.0 if count == total else min(middle + half, 1.0))
