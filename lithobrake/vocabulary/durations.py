"""Lengths of time in the unit that suits them."""

from lithobrake.vocabulary.constants import DAY, HOUR, MINUTE


def in_suitable_unit(seconds: float, most: float = 120.0) -> tuple[float, str]:
    """A time [s] in seconds below `most` of them, in minutes below as many, in hours below two days, else in days."""
    for limit, unit, size in ((most, "s", 1.0), (60.0 * most, "min", MINUTE), (2.0 * DAY, "h", HOUR)):
        if seconds < limit:
            return seconds / size, unit
    return seconds / DAY, "days"


def duration_words(seconds: float, digits: str = ".3g") -> str:
    """A time [s] as "5.25 min"; digits: how its number is written."""
    number, unit = in_suitable_unit(seconds)
    return f"{number:{digits}} {unit}"


def hours(seconds: float) -> str:
    """A time [s] in hours."""
    return f"{seconds / HOUR:.3g} h"
