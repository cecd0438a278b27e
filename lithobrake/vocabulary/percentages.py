"""Shares in per cent, the same in every sentence and table: as many digits as the interval deserves."""

from collections.abc import Mapping
from typing import Any

# Probability with which every interval of an estimate holds the truth; results carry it, so that no reader has to ask.
LEVEL = 0.9
# Of an interval narrower than this tenths of a per cent say something.
NARROW = 0.02
# More digits than these say nothing of a share next to 0 or 1.
MOST_DIGITS = 2


def percent(share: float, digits: int = 0) -> str:
    """A share of one in per cent, with more digits where it is next to 0 or 1."""
    return f"{_number(share, digits)} %"


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


def with_interval(entry: Mapping[str, Any], alone: int = 0) -> str:
    """A share of the summary with its interval, "71 % (68-73 %)"; alone: digits of one without an interval."""
    lower, upper = entry.get("lower"), entry.get("upper")
    if lower is None or upper is None:
        return percent(entry["share"], alone)
    digits = interval_digits(lower, upper)
    return f"{percent(entry['share'], digits)} ({span(lower, upper, digits)})"


def part(entry: Mapping[str, float], more: str = "") -> str:
    """A part of a variance, which cannot be told from nothing where it is 0 or less: "not detected (0-2 %)".

    more: words that stand behind the interval.
    """
    digits = interval_digits(entry["lower"], entry["upper"])
    shown = percent(min(entry["share"], 1.0), digits) if entry["share"] > 0.0 else "not detected"
    return f"{shown} ({span(entry['lower'], entry['upper'], digits)}{more})"


def _number(share: float, digits: int) -> str:
    """A share in per cent, with more digits where it would else read as nothing, or as the whole, and is neither."""
    if share in (0.0, 1.0):
        return f"{100.0 * share:.0f}"
    while digits < MOST_DIGITS and round(100.0 * share, digits) in (0.0, 100.0):
        digits += 1
    return f"{100.0 * share:.{digits}f}"
