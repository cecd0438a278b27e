"""Numbers, counts, durations and lists in words, the same in every message, sentence, table and figure."""

from collections.abc import Iterable, Sequence

from lithobrake.vocabulary.constants import DAY, HOUR, MINUTE

# Of the largest number beside it: what the rounding of doubles may add up to over some million steps of time.
ROUNDING = 1e-9
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
# Below the first a time is given in seconds, below the second in minutes, and so on.
UNITS = ((2.0 * MINUTE, 1.0, "s"), (2.0 * HOUR, MINUTE, "min"), (2.0 * DAY, HOUR, "h"))


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
