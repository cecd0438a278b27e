"""Numbers of a comparison in words: an answer of each study, and the difference with its interval."""

from lithobrake.report.words.numbers import fixed, number
from lithobrake.results.comparison import ComparedAnswer, ComparedNumber, StudyComparison
from lithobrake.vocabulary.percentages import percent

PERCENT = 100.0


def factor(answer: ComparedAnswer) -> float:
    """What numbers of an answer are multiplied by where they are shown."""
    return PERCENT if answer.is_fraction else 1.0


def unit(answer: ComparedAnswer, *, of_difference: bool = False) -> str:
    """The unit of what is shown: fractions in per cent, their differences in percentage points."""
    if answer.is_fraction:
        return "points" if of_difference else "%"
    return answer.unit


def bounded(one: ComparedNumber, times: float, *, signed: bool = False) -> str:
    """A number with its interval, "12.3 (10.1 to 14.2)"; "none" where there is none."""
    if one.value is None:
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
    found = answer.difference
    if found.value is None or found.lower is None or found.upper is None:
        return "no interval"
    if found.lower > 0.0:
        return "larger in B"
    return "smaller in B" if found.upper < 0.0 else "no difference detected"


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
