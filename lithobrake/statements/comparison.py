"""Two studies compared, in sentences: a result of each, and the difference with its interval."""

from collections.abc import Sequence

from lithobrake.results.questions import ComparedAnswer, StudyComparison
from lithobrake.statements.labels import bracket, two_digits
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import as_sentence, counted, fixed, intervals, number, out_of, percent

PERCENT = 100.0


def factor(answer: ComparedAnswer, *, of_difference: bool = False) -> float:
    """What numbers of an answer are multiplied by where they are shown."""
    return PERCENT if answer.is_fraction or (answer.is_ratio and of_difference) else 1.0


def unit(answer: ComparedAnswer, *, of_difference: bool = False) -> str:
    """The unit of what is shown: fractions and ratios in per cent, differences of fractions in percentage points."""
    if answer.is_fraction:
        return "points" if of_difference else "%"
    return "%" if answer.is_ratio and of_difference else answer.unit


def bounded(one: Estimate, times: float, *, signed: bool = False) -> str:
    """A number with its interval, "12.3 (10.1 to 14.2)"; "none" where there is none."""
    if not one.is_known:
        return "none"
    interval = bracket(one.lower, one.upper, lambda end: shown(end, times, signed=signed))
    return f"{shown(one.value, times, signed=signed)}{interval}"


def difference(answer: ComparedAnswer) -> str:
    """The difference with its interval and unit."""
    words = bounded(answer.difference, factor(answer, of_difference=True), signed=True)
    return f"{words} {unit(answer, of_difference=True)}".strip()


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
    first, second = (f"{bounded(one, factor(answer))} {unit(answer)}".strip() for one in (answer.first, answer.second))
    less = "B over A" if answer.is_ratio else "B minus A"
    return as_sentence(
        f"{answer.words}: A {first}, B {second}; {less} {difference(answer)}: {verdict(answer)} "
        f"({intervals(comparison.level)}, {comparison.of}{unknown(answer)})"
    )


def unknown(answer: ComparedAnswer) -> str:
    """How many runs have an unknown outcome, behind the number of pairs; nothing where none has."""
    shares = [f"{percent(share, 1)} of {name}" for share, name in zip(answer.missing, "AB", strict=True) if share > 0.0]
    if not shares:
        return ""
    told = "and nothing limits their ratio" if answer.is_ratio else "and bounds hold whatever became of them"
    return f"; {' and '.join(shares)} have an unknown outcome, {told}"


def lines(comparison: StudyComparison) -> list[str]:
    """The comparison for a terminal: which studies, and a line for each answer."""
    said = [f"{letter}: {name}" for letter, name in zip("AB", comparison.names, strict=True)]
    said += [sentence(comparison, name) for name in comparison.answers]
    return said + warnings(comparison)


def warnings(comparison: StudyComparison) -> list[str]:
    """What makes the comparison weaker than it looks."""
    return [words for words in (comparison.note, comparison.why) if words]


def pairs(count: int, bed_count: int) -> str:
    """How many pairs of runs there are, on how many beds."""
    return f"{counted(count, 'pair')} on {counted(bed_count, 'bed')}"


def other_beds(count: int, total: int) -> str:
    """That beds of one number are not the same bed in both studies."""
    return (
        f"{out_of(count, total, 'beds')} differ between the studies (other grains, or settled under another gravity), "
        "so paired runs are less correlated. If the grains are the same, give both studies the same bed.settle_gravity."
    )


def caption(comparison: StudyComparison) -> str:
    """The figure of the differences."""
    saved = [one.landings_saved for one in comparison.answers.values() if one.landings_saved is not None]
    gain = (
        f" Two studies with different beds and impact points would need {two_digits(min(saved))} to "
        f"{two_digits(max(saved))} times as many landings for equally narrow intervals."
        if saved
        else ""
    )
    return (
        f"Differences of the results with their {intervals(comparison.level)} over beds and impact points, "
        f"from {comparison.of}: runs with the same number share bed, impact point, attitude and heading.{gain}"
    )


def table_note(comparison: StudyComparison) -> str:
    return (
        f"With {intervals(comparison.level)}. Correlation: of the two runs of a pair. Landings saved: factor "
        "by which an unpaired comparison needs more landings for the same interval. Typical ratio: geometric mean of B "
        "over A, less 1, over the pairs of which both landers come to rest."
    )


def tiles(comparison: StudyComparison, most: int) -> Sequence[tuple[str, str, str]]:
    """The differences of the first answers but for that of the sentence: value, unit and words of each."""
    told = [one for one in list(comparison.answers.values())[1:most] if one.difference.is_known]
    return [
        (
            shown(one.difference.value, factor(one, of_difference=True), signed=True),
            unit(one, of_difference=True),
            f"{one.words}: {verdict(one)}",
        )
        for one in told
    ]
