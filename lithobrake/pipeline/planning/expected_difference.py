"""How well two planned studies will tell their difference, in pairs and without, and what a half-width asks for."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lithobrake.analysis.paired_widths import beds_for_half_width, difference_half_width, half_width_on
from lithobrake.pipeline.answer.run_answers import answer_words, answers_rest
from lithobrake.pipeline.commands.comparison import compare_studies
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.shared_numbers import FIRST, SECOND, SharedNumbers, pair_count
from lithobrake.vocabulary.number_words import as_sentence, at_level, counted, number, percent, thousands

if TYPE_CHECKING:
    from lithobrake.pipeline.planning.plan import Plan

# Correlation of the pairs before any have been made: expected, and over options from large to small
# (docs/howto/compare.md; validation/pairing.json).
EXPECTED_CORRELATION = {
    "at_rest": (0.3, 0.1, 0.6),
    "returns": (0.5, 0.2, 0.9),
    "time_s_median": (0.2, 0.0, 0.5),
    "distance_median": (0.5, 0.1, 0.8),
}
WORDS = {"time_s_median": "time to rest, median", "distance_median": "distance from the aim point, median"}
# Half-widths of a fraction that may be asked for end here: an interval from 0 to 1.
WIDEST = 0.5


@dataclass(frozen=True)
class PairGain:
    """What pairing gains for one result.

    words         what it is
    correlation   of the pairs, with the range over options of other sizes; both ends are it where it was measured
    ratio         half-width of the difference in pairs over that without, where both studies have equal ones
    saved         how many times as many journeys an unpaired comparison takes; None where pairs do not differ
    """

    words: str
    correlation: float
    least: float
    most: float
    ratio: float
    saved: float | None

    def line(self) -> str:
        spread = "" if self.least == self.most else f" ({number(self.least, 2)} to {number(self.most, 2)})"
        saved = f"; as narrow without pairs: {number(self.saved, 2)} times as many" if self.saved else ""
        return as_sentence(
            f"{self.words}: correlation {number(self.correlation, 2)}{spread}, half-width in pairs "
            f"{percent(self.ratio)} of that without{saved}"
        )


@dataclass(frozen=True)
class AskedRuns:
    """Runs and beds of each study that a half-width of the difference asks for, in pairs and without."""

    half_width: float
    in_pairs: int
    beds_in_pairs: int
    unpaired: int
    beds_unpaired: int

    def line(self, runs: str) -> str:
        return (
            f"For a half-width of {_points(self.half_width)} points: {thousands(self.in_pairs)} {runs} on "
            f"{counted(self.beds_in_pairs, 'bed')} in each study in pairs, {thousands(self.unpaired)} on "
            f"{counted(self.beds_unpaired, 'bed')} without."
        )


@dataclass(frozen=True)
class ExpectedDifference:
    """Of a study to another one; half-widths of the fraction that both ask for, shares of 1.

    against                   the other study
    pairs, beds               that both have
    runs                      what they are, in the plural
    answer                    of which fraction the half-widths are, in words
    in_pairs, narrow, wide    half-width in pairs at the correlation expected, and at both ends of its range
    unpaired                  half-width without pairs
    gains                     by result, those of medians without a half-width of their own
    basis                     where the correlations come from, in a sentence
    asked                     None unless a half-width is asked for
    level                     probability that the interval stands for
    """

    against: str
    pairs: int
    beds: int
    runs: str
    answer: str
    in_pairs: float
    narrow: float
    wide: float
    unpaired: float
    gains: Mapping[str, PairGain]
    basis: str
    asked: AskedRuns | None
    level: float

    def lines(self) -> list[str]:
        spread = f" ({_points(self.narrow)} to {_points(self.wide)})" if self.narrow < self.wide else ""
        lines = [
            f"Difference to {self.against} ({counted(self.pairs, 'pair')} on {counted(self.beds, 'bed')}): expected "
            f"half-width of the {at_level(self.level)} of {self.answer} {_points(self.in_pairs)}{spread} points in "
            f"pairs, {_points(self.unpaired)} without.",
        ]
        lines += [f"  {self.asked.line(self.runs)}"] if self.asked else []
        lines += [f"  {gain.line()}" for gain in self.gains.values()]
        return [*lines, f"  {self.basis}"]


@dataclass(frozen=True)
class PlannedStudy:
    """A study of a comparison: the name of its file, its folder, its tables, what it draws, and its plan."""

    name: str
    folder: Path
    tables: Mapping[str, Any]
    design: DrawnDesign
    plan: "Plan"


def check_half_width(half_width: float | None) -> None:
    """Raise ValueError for a half-width of a difference that cannot be."""
    if half_width is not None and not 0.0 < half_width <= WIDEST:
        raise ValueError(
            f"--half-width is {half_width:g}; allowed: above 0 to {WIDEST:g}, a fraction of the landers (0.05 for 5 "
            "points)"
        )


def expected_difference(one: PlannedStudy, two: PlannedStudy, half_width: float | None) -> ExpectedDifference:
    """What to expect of `lithobrake compare` of the two. Raises ValueError for studies that cannot be compared."""
    if one.tables == two.tables:
        raise ValueError(f"{one.name} and {two.name} are the same study; compare studies that differ")
    shared = []
    for each in (one, two):
        if not each.design.study.design.run_count:
            raise ValueError(f"{each.name} draws no lander (design.run_count is 0); compare studies that draw some")
        shared.append(SharedNumbers.of_design(each.design, each.name))
    pairs = pair_count(shared[0], shared[1])
    beds = len({int(bed) for bed in one.design.beds[:pairs]})
    answer = _same_answer(one, two)
    widths = [_width(each, pairs, beds) for each in (one, two)]
    gains, basis = _gains(one, two)
    main = next(iter(gains.values()))
    in_pairs, narrow, wide, unpaired = (
        difference_half_width(*widths, r) for r in (main.correlation, main.most, main.least, 0.0)
    )
    asked = None
    if half_width is not None:
        few, many = (beds_for_half_width(width, beds, half_width) for width in (in_pairs, unpaired))
        asked = AskedRuns(half_width, _runs(pairs, beds, few), few, _runs(pairs, beds, many), many)
    return ExpectedDifference(
        against=two.name,
        pairs=pairs,
        beds=beds,
        runs="landings" if one.design.study.journey.touchdowns == 1 else "journeys",
        answer=answer,
        in_pairs=in_pairs,
        narrow=narrow,
        wide=wide,
        unpaired=unpaired,
        gains=gains,
        basis=basis,
        asked=asked,
        level=one.plan.half_width.level if one.plan.half_width else 0.0,
    )


def _same_answer(one: PlannedStudy, two: PlannedStudy) -> str:
    answers = [answer_words(each.design.study) for each in (one, two)]
    if answers[0] != answers[1]:
        raise ValueError(
            f"{one.name} ({FIRST}) asks for {answers[0]} and {two.name} ({SECOND}) for {answers[1]}; give both the "
            "same design.half_width_of"
        )
    return answers[0]


def _width(study: PlannedStudy, pairs: int, beds: int) -> float:
    """Half-width of a study of which so many runs have a partner."""
    found = study.plan.half_width
    if found is None or beds < 2:
        raise ValueError(f"{study.name} has one bed, which gives no interval; give both studies two beds or more")
    return found.median * (found.run_count / pairs) ** 0.5 if found.run_count > pairs else found.median


def _runs(pairs: int, beds: int, asked: int) -> int:
    return -(-pairs * asked // beds)


def _gains(one: PlannedStudy, two: PlannedStudy) -> tuple[dict[str, PairGain], str]:
    """By result, the fraction first; and where the correlations come from."""
    study = one.design.study
    like = "returns" if study.journey.touchdowns == 1 else "at_rest"
    main = study.design.half_width_of or ("at_rest" if answers_rest(study) else "returns")
    names = [main, *(WORDS if like == "at_rest" else ())]
    measured: dict[str, float] = {}
    basis = "Correlations: expected from simulated pairs (docs/howto/compare.md); a larger change has a lower one."
    if not one.plan.stages and not two.plan.stages:
        found = compare_studies(one.folder, two.folder)
        known = {name: found.answers[name].correlation for name in names if name in found.answers}
        measured = {name: value for name, value in known.items() if value is not None}
        if measured:
            basis = f"Correlations: of the {found.of} that were made"
            basis += "." if len(measured) == len(names) else "; expected ones of what does not vary in them."
    gains = {}
    for name in names:
        ends = (measured[name],) * 3 if name in measured else EXPECTED_CORRELATION.get(name, EXPECTED_CORRELATION[like])
        words = WORDS.get(name, answer_words(study).removeprefix("the "))
        left = max(1.0 - ends[0], 0.0)
        gains[name] = PairGain(words, *ends, left**0.5, 1.0 / left if left else None)
    return gains, basis


def _points(share: float) -> str:
    return f"{100 * share:.2g}"
