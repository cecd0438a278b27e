"""How wide the interval of a difference of two studies will be, in pairs and without, and what a width asks for."""

import math
from bisect import bisect_left

from lithobrake.analysis.confidence import t_quantile
from lithobrake.analysis.half_width import MOST_BEDS
from lithobrake.vocabulary.given_numbers import finite_number, whole_number


def difference_half_width(first: float, second: float, correlation: float) -> float:
    """Half-width of the interval of a difference, in the unit of those of both studies; correlation of the pairs.

    Raises ValueError for a half-width below 0 and a correlation outside -1 to 1.
    Source: [Zou-2008], Eq 2 with a correlation, for bounds at equal distances.
    """
    for name, value in (("first", first), ("second", second)):
        finite_number(name, value, at_least=0.0)
    finite_number("correlation", correlation, at_least=-1.0, at_most=1.0)
    return math.sqrt(max(first**2 + second**2 - 2.0 * correlation * first * second, 0.0))


def half_width_on(half_width: float, bed_count: int, beds: int) -> float:
    """Half-width that a study would have on so many beds with as many runs on each, where it has this on bed_count.

    Raises ValueError for fewer than two beds, and a half-width below 0. Source: [Cochran-1977], section 10.3.
    """
    finite_number("half_width", half_width, at_least=0.0)
    for name, count in (("bed_count", bed_count), ("beds", beds)):
        whole_number(name, count, 2)
    return half_width * math.sqrt(bed_count / beds) * t_quantile(beds - 1) / t_quantile(bed_count - 1)


def beds_for_half_width(half_width: float, bed_count: int, asked: float) -> int:
    """Fewest beds, with as many runs on each, on which a half-width of bed_count beds is at most as wide as asked.

    Raises ValueError for fewer than two beds, a half-width below 0, and one asked that is not above 0.
    """
    finite_number("asked", asked, above=0.0)
    half_width_on(half_width, bed_count, bed_count)
    return bisect_left(
        range(MOST_BEDS), True, lo=2, key=lambda beds: half_width_on(half_width, bed_count, beds) <= asked
    )
