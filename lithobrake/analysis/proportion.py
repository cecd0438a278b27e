"""A share counted in a sample, and how far it may be from the truth by the luck of the draw."""

import math

from lithobrake.vocabulary.given_numbers import finite_number, whole_number

NORMAL_QUANTILE_95 = 1.959963984540054
# Probabilities beyond this quantile are below the smallest float.
MOST_QUANTILE = 40.0


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
