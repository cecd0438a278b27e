"""Shares in per cent, the same in every sentence and table: as many digits as the interval deserves."""

import math

from lithobrake.vocabulary.estimate import LEVEL as LEVEL
from lithobrake.vocabulary.estimate import Estimate

# Of the intervals and limits of an expansion and its runs.
EXPANSION_LEVEL = 0.95
# Probabilities of the quantiles that tables show, and their words.
QUANTILES = LOW, MEDIAN, HIGH = 0.05, 0.5, 0.95
QUANTILE_WORDS = {"0.05": "5 %", "0.5": "median", "0.95": "95 %"}
# Of an interval narrower than this tenths of a per cent say something.
NARROW = 0.02
# More digits than these say nothing of a share next to 0 or 1.
MOST_DIGITS = 2


def percent(share: float, digits: int = 0) -> str:
    """A share of one in per cent, with more digits where it is next to 0 or 1."""
    return f"{_number(share, digits)} %"


def rare_percent(share: float) -> str:
    """A share of one in per cent, to two digits of its distance from 0 or 1 where that is small."""
    away = min(share, 1.0 - share)
    if away >= 0.1 or away == 0.0:
        return percent(share)
    return f"{100.0 * share:.{max(0, 1 - math.floor(math.log10(100.0 * away)))}f} %"


def span(lower: float, upper: float, digits: int | None = None) -> str:
    """Two shares in per cent, "68-73 %"; digits: None for those that so wide an interval deserves.

    A bound of a share lies between 0 and 1.
    """
    low, high = (min(max(end, 0.0), 1.0) for end in (lower, upper))
    shown = interval_digits(lower, upper) if digits is None else digits
    return f"{_number(low, shown)}-{percent(high, shown)}"


def interval_digits(lower: float | None, upper: float | None) -> int:
    """Digits behind the point that a share with this interval deserves: none unless it is narrow."""
    return int(lower is not None and upper is not None and upper - lower < NARROW)


def with_interval(entry: Estimate, alone: int = 0, level: float | None = None) -> str:
    """A share with its interval, "71 % (68-73 %)", or "71 % (90 % interval 68-73 %)" where a level is to be named.

    alone: digits of a share without an interval.
    """
    if entry.bounds is None:
        return percent(entry.value, alone)
    digits = interval_digits(*entry.bounds)
    named = "" if level is None else f"{percent(level)} interval "
    return f"{percent(entry.value, digits)} ({named}{span(*entry.bounds, digits)})"


def part(share: Estimate, more: str = "") -> str:
    """A part of a variance, which cannot be told from nothing where it is 0 or less: "not detected (0-2 %)".

    more: words that stand behind the interval.
    """
    digits = interval_digits(share.lower, share.upper)
    shown = percent(min(share.value, 1.0), digits) if share.value > 0.0 else "not detected"
    return shown if share.bounds is None else f"{shown} ({span(*share.bounds, digits)}{more})"


def _number(share: float, digits: int) -> str:
    """A share in per cent, with more digits where it would else read as nothing, or as the whole, and is neither."""
    if share in (0.0, 1.0):
        return f"{100.0 * share:.0f}"
    while digits < MOST_DIGITS and round(100.0 * share, digits) in (0.0, 100.0):
        digits += 1
    return f"{100.0 * share:.{digits}f}"
