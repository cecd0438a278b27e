"""Numbers, shares, durations and lists in words, the same in every message, sentence, table and figure."""

import math
from collections.abc import Iterable, Sequence

from lithobrake.vocabulary.constants import DAY, HOUR, MINUTE
from lithobrake.vocabulary.estimate import LEVEL as LEVEL
from lithobrake.vocabulary.estimate import Estimate

# Of the largest number beside it: what the rounding of doubles may add up to over some million steps of time.
ROUNDING = 1e-9
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
# Below the first a time is given in seconds, below the second in minutes, and so on.
UNITS = ((2.0 * MINUTE, 1.0, "s"), (2.0 * HOUR, MINUTE, "min"), (2.0 * DAY, HOUR, "h"))
# Of the intervals and limits of an expansion and its runs.
EXPANSION_LEVEL = 0.95
# Probabilities of the quantiles that tables show, and their words.
QUANTILES = LOW, MEDIAN, HIGH = 0.05, 0.5, 0.95
QUANTILE_WORDS = {"0.05": "5 %", "0.5": "median", "0.95": "95 %"}
# Of an interval narrower than this tenths of a per cent say something.
NARROW = 0.02
# More digits than these say nothing of a share next to 0 or 1.
MOST_DIGITS = 2


def number(value: float, digits: int = 3, *, zeros: bool = False, scale: float = 0.0) -> str:
    """A number to some digits, very large and very small ones with a power of ten; zeros: keep those at the end.

    scale: the largest magnitude of what it stands beside; what is rounding next to that is shown as 0.
    """
    if abs(value) <= ROUNDING * scale:
        return "0"
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        text = f"{value:#.{digits}g}" if zeros else f"{value:.{digits}g}"
        return f"{value:.0f}" if "e" in text else text.removesuffix(".")
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    if not zeros and "." in mantissa:
        mantissa = mantissa.rstrip("0").removesuffix(".")
    return f"{mantissa} × 10{str(int(exponent)).translate(RAISED)}"


def fixed(value: float, digits: int = 2) -> str:
    """A number to some digits behind the point, without a sign when they are all zeros."""
    text = f"{value:.{digits}f}"
    return text if float(text) else text.removeprefix("-")


def thousands(count: int) -> str:
    """A count with a blank between its thousands."""
    return f"{count:,}".replace(",", " ")


def counted(count: int, thing: str) -> str:
    """A count of things whose plural takes an s: "1 bed", "12 beds"."""
    return f"{count} {thing}{'' if count == 1 else 's'}"


def out_of(count: int, total: int, things: str = "") -> str:
    """A count among all: "3 of 12 landings"."""
    return f"{count} of {total}{' ' * bool(things)}{things}"


def listing(words: Sequence[str]) -> str:
    """Words joined as a person would: a, b and c."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def unit_of_time(seconds: float) -> tuple[float, str]:
    """The unit that suits a time [s]: its length [s] and its sign."""
    return next(((size, unit) for limit, size, unit in UNITS if seconds < limit), (DAY, "days"))


def duration(seconds: float, digits: int = 3) -> str:
    """A time [s] in the unit that suits it; digits: 0 for whole units."""
    size, unit = unit_of_time(seconds)
    return f"{seconds / size:.{digits}g} {unit}" if digits else f"{seconds / size:.0f} {unit}"


def time_limit(seconds: float) -> str:
    """A time [s] that a study file sets, in hours from one on, however many they are."""
    return f"{seconds / HOUR:.3g} h" if seconds >= HOUR else duration(seconds)


def span_of(values: Iterable[float], digits: int = 3) -> str:
    """The ends of a range of numbers, "0.5 to 3"."""
    return " to ".join(number(value, digits) for value in values)


def as_sentence(words: str) -> str:
    """Words with a capital, which a dotted key at their beginning does not take, and a full stop."""
    first = words[:1] if "." in words.split(" ", 1)[0] else words[:1].upper()
    return f"{first}{words[1:].rstrip('.')}."


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


def at_level(level: float = LEVEL) -> str:
    """What the bounds beside a number are: "90 % interval"."""
    return f"{percent(level)} interval"


def intervals(level: float = LEVEL) -> str:
    """What the bounds beside several numbers are: "90 % intervals"."""
    return f"{at_level(level)}s"


def with_interval(entry: Estimate, alone: int = 0, level: float | None = None) -> str:
    """A share with its interval, "71 % (68-73 %)", or "71 % (90 % interval 68-73 %)" where a level is to be named.

    alone: digits of a share without an interval.
    """
    if entry.bounds is None:
        return percent(entry.value, alone)
    digits = interval_digits(*entry.bounds)
    named = "" if level is None else f"{at_level(level)} "
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
