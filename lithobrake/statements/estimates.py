"""Estimates with their intervals, and the regions that hold landers, in words."""

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING

from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import number
from lithobrake.vocabulary.percentages import at_level, interval_digits, percent, span

if TYPE_CHECKING:
    from lithobrake.results.dispersion import RestRegion


def bracket(
    lower: float | None,
    upper: float | None,
    shown: Callable[[float], str] = number,
    joint: str = " to ",
    level: float | None = None,
) -> str:
    """The ends of an interval in brackets behind a blank, " (10 to 14)", or the one that is known; empty without any.

    shown: an end in words; level: the probability that the interval stands for, where it is to be named.
    """
    if lower is None and upper is None:
        return ""
    ends = [f"{words}{shown(end)}" for words, end in (("at least ", lower), ("at most ", upper)) if end is not None]
    if lower is not None and upper is not None:
        ends = [f"{shown(lower)}{joint}{shown(upper)}"]
    return f" ({'' if level is None else f'{at_level(level)} '}{ends[0]})"


def quantile(one: Estimate, size: float = 1.0) -> str:
    """A quantile with its interval in units of a size, "27 (23-32)", or with the known bound; "none" for none."""
    if not one.is_known:
        return "none"
    shown = one.on_scale(lambda value: value / size)
    return f"{two_digits(shown.value)}{bracket(shown.lower, shown.upper, two_digits, '-')}"


def two_digits(value: float) -> str:
    """A number to two digits."""
    return number(value, 2)


def signed_points(one: Estimate) -> str:
    """A difference of shares in percentage points with its interval, "+3 (-1 to +7)"."""
    return f"{_point(one.value)}{bracket(one.lower, one.upper, _point)}"


def _point(share: float) -> str:
    return f"{100.0 * share:+.0f}"


def half_width(share: float) -> str:
    """Half the width of the interval of a share, "+- 3 %"."""
    return f"+- {percent(share)}"


def share_interval(one: Estimate) -> str:
    """The interval of a share with its level, "90 % interval 68-73 %"; empty where it has none."""
    return "" if one.bounds is None else f"{at_level(one.level)} {span(*one.bounds)}"


def bare_share(one: Estimate, alone: int = 0) -> str:
    """A share in per cent with the digits that its interval deserves, without the sign; alone: of one without any."""
    digits = alone if one.lower is None else interval_digits(one.lower, one.upper)
    return percent(one.value, digits).removesuffix(" %")


def spread(words: str, values: Iterable[float], unit: str, interval: str = "", digits: int = 3) -> str:
    """Median and middle nine tenths of a quantity; values: 5 %, median, 95 %; interval: of the median, in brackets."""
    low, middle, high = (number(value, digits) for value in values)
    return f"{words}: median {middle} {unit}{interval}; 5th to 95th percentile {low} to {high} {unit}."


def area(square_metres: float) -> str:
    """An area to two digits, "32 000 m2"."""
    rounded = float(f"{square_metres:.2g}")
    return f"{rounded:,.0f} m2".replace(",", " ") if rounded >= 10.0 else f"{rounded:g} m2"


def smallest_region(one: "RestRegion", of: str) -> str:
    """The area of the smallest region that holds a share of what it is of."""
    return f"the smallest region that holds {percent(one.share)} of {of} covers {area(one.area_m2)}"


def extent(one: "RestRegion") -> str:
    """How far apart the ends of a region are."""
    return f"{two_digits(one.largest_extent_m)} m across"


def region(one: "RestRegion", of: str) -> str:
    """How large the smallest region is that holds a share of what it is of."""
    return f"{smallest_region(one, of)} and is {extent(one)}"
