"""Numbers of the page and of a comparison in words and cells."""

import re
from collections.abc import Iterable, Mapping, Sequence
from html import escape

from lithobrake.results.model_results import OutputErrors
from lithobrake.results.questions import ComparedAnswer, StudyComparison
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.percentages import percent

# Of the largest number beside it: what the rounding of doubles may add up to over some million steps of time.
ROUNDING = 1e-9
RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
# Powers of units, "m2" and "m/s2", behind a number, a bracket or a unit.
POWER = re.compile(
    r"(?:(?<=\b(?:m|J|N)/)|(?<=\bkg/)|(?<=\brad/)|(?<=\bm2/)|(?<=\[)|(?<=[\d⁰¹²³⁴⁵⁶⁷⁸⁹][ \N{NO-BREAK SPACE}]))"
    r"([ms])([23])\b"
)


def flat(tree: Mapping[str, object], prefix: str = "", alike: Sequence[Sequence[str]] = ()) -> list[tuple[str, str]]:
    """A nested mapping as rows (dotted name, value in words), in its own order; alike: names that share one scale."""
    scales = {name: largest([tree.get(one) for one in names]) for names in alike for name in names}
    rows: list[tuple[str, str]] = []
    for name, value in tree.items():
        key = f"{prefix}.{name}" if prefix else str(name)
        if isinstance(value, Mapping):
            rows += flat(value, key)
        else:
            rows.append((key, show(value, scales.get(name, 0.0))))
    return rows


def show(value: object, scale: float = 0.0) -> str:
    """A value of a results file in words: numbers to four digits, lists in one line and of one scale."""
    if isinstance(value, bool) or value is None:
        return {True: "yes", False: "no", None: "none"}[value]
    if isinstance(value, float):
        return number(value, 4, scale=scale)
    if isinstance(value, list | tuple):
        scale = max(scale, largest(value))
        return ", ".join(show(entry, scale) for entry in value)
    return str(value)


def largest(value: object) -> float:
    """The largest magnitude among the numbers of a value of a results file; 0 where it has none."""
    if isinstance(value, list | tuple):
        return max(map(largest, value), default=0.0)
    return abs(value) if isinstance(value, int | float) else 0.0


def unit_scales(numbers: Iterable[tuple[str, float]]) -> dict[str, float]:
    """The largest magnitude of each unit among the numbers (unit, value) of a table."""
    scales: dict[str, float] = {}
    for unit, value in numbers:
        scales[unit] = max(scales.get(unit, 0.0), abs(value))
    return scales


def fixed(value: float, digits: int = 2) -> str:
    """A number to some digits behind the point, without a sign when they are all zeros."""
    text = f"{value:.{digits}f}"
    return text if float(text) else text.removeprefix("-")


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


def raised_units(words: str) -> str:
    """Words in which powers of units are raised: m² and m/s² for m2 and m/s2."""
    return POWER.sub(lambda found: found[1] + found[2].translate(RAISED), words)


def in_html(words: str) -> str:
    """Words as text of a page: powers of units raised, and no sign that HTML would read."""
    return escape(raised_units(words))


def area(square_metres: float) -> str:
    """An area to two digits, "32 000 m²", with spaces at which no line breaks."""
    rounded = float(f"{square_metres:.2g}")
    return (f"{rounded:,.0f},m²" if rounded >= 10.0 else f"{rounded:g},m²").replace(",", "\N{NO-BREAK SPACE}")


def table_cell(value: float, scale: float = 0.0) -> str:
    """A number in a column: three digits, zeros at the end kept; scale: the largest of its unit in the table."""
    return number(value, zeros=True, scale=scale)


def q2_words(errors: OutputErrors) -> str:
    """Q2 with its interval: "0.93 (0.80 to 0.97)"."""
    low, high = errors.q2_interval
    if errors.q2 is None:
        return "undefined"
    if low is None and high is None:
        return fixed(errors.q2)
    return f"{fixed(errors.q2)} ({'no bound' if low is None else fixed(low)} to {fixed(1.0 if high is None else high)})"


PERCENT = 100.0


def factor(answer: ComparedAnswer) -> float:
    """What numbers of an answer are multiplied by where they are shown."""
    return PERCENT if answer.is_fraction else 1.0


def unit(answer: ComparedAnswer, *, of_difference: bool = False) -> str:
    """The unit of what is shown: fractions in per cent, their differences in percentage points."""
    if answer.is_fraction:
        return "points" if of_difference else "%"
    return answer.unit


def bounded(one: Estimate, times: float, *, signed: bool = False) -> str:
    """A number with its interval, "12.3 (10.1 to 14.2)"; "none" where there is none."""
    if not one.is_known:
        return "none"
    ends = [shown(end, times, signed=signed) if end is not None else "no bound" for end in (one.lower, one.upper)]
    has_interval = one.lower is not None or one.upper is not None
    return shown(one.value, times, signed=signed) + (f" ({ends[0]} to {ends[1]})" if has_interval else "")


def shown(value: float, times: float, *, signed: bool = False) -> str:
    """A number as it is shown; signed: with a plus where it is above 0."""
    text = fixed(times * value, 1) if times == PERCENT else number(value, 3)
    return f"+{text}" if signed and value > 0.0 and text != "0" else text


def verdict(answer: ComparedAnswer) -> str:
    """Whether the difference can be told from none."""
    bounds = answer.difference.bounds
    if bounds is None:
        return "no interval"
    if bounds[0] > 0.0:
        return "larger in B"
    return "smaller in B" if bounds[1] < 0.0 else "no difference detected"


def sentence(comparison: StudyComparison, name: str) -> str:
    """An answer and its difference in a sentence."""
    answer = comparison.answers[name]
    times, of = factor(answer), unit(answer)
    first, second = (f"{bounded(one, times)} {of}".strip() for one in (answer.first, answer.second))
    shown = f"{bounded(answer.difference, times, signed=True)} {unit(answer, of_difference=True)}".strip()
    return (
        f"{answer.words[:1].upper()}{answer.words[1:]}: A {first}, B {second}; B minus A {shown}: {verdict(answer)} "
        f"({percent(comparison.level)} intervals, {comparison.of})."
    )


def lines(comparison: StudyComparison) -> list[str]:
    """The comparison for a terminal: which studies, and a line for each answer."""
    said = [f"{letter}: {name}" for letter, name in zip("AB", comparison.names, strict=True)]
    said += [sentence(comparison, name) for name in comparison.answers]
    return said + [words for words in (comparison.note, comparison.why) if words]
