"""How well two planned studies will tell their difference, in pairs and without, and what a half-width asks for."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.analysis.paired_widths import beds_for_half_width, difference_half_width
from lithobrake.pipeline.answer.run_answers import answer_words, answers_rest
from lithobrake.pipeline.planning.expected_width import ExpectedHalfWidth
from lithobrake.study import Study
from lithobrake.vocabulary.number_words import as_sentence, at_level, counted, number, percent, thousands

# Correlation of the pairs before any have been made: mean, smallest and largest over a heavier lander, a faster
# delivery and another soil (docs/howto/compare.md; validation/pairing.json).
EXPECTED_CORRELATION = {
    "at_rest": (0.5, 0.3, 0.7),
    "returns": (0.6, 0.3, 0.8),
    "time_s_median": (0.2, -0.2, 0.4),
    "time_s_ratio": (0.9, 0.8, 0.9),
    "distance_median": (0.6, 0.4, 0.8),
    "distance_ratio": (0.7, 0.5, 0.9),
}
WORDS = {
    "time_s_median": "time to rest, median",
    "time_s_ratio": "time to rest, typical ratio",
    "distance_median": "distance from the aim point, median",
    "distance_ratio": "distance from the aim point, typical ratio",
}


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

    @classmethod
    def of(cls, words: str, correlation: float, least: float, most: float) -> "PairGain":
        left = max(1.0 - correlation, 0.0)
        return cls(words, correlation, least, most, math.sqrt(left), 1.0 / left if left else None)

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

    @classmethod
    def of(cls, half_width: float, pairs: int, beds: int, in_pairs: float, unpaired: float) -> "AskedRuns":
        """By the half-widths of so many pairs on so many beds; runs and beds grow together."""
        few, many = (beds_for_half_width(width, beds, half_width) for width in (in_pairs, unpaired))
        return cls(half_width, -(-pairs * few // beds), few, -(-pairs * many // beds), many)

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

    @classmethod
    def of(
        cls, against: str, pairs: int, beds: int, study: Study, widths: tuple[ExpectedHalfWidth, ExpectedHalfWidth],
        gains: Mapping[str, PairGain], basis: str, half_width: float | None,
    ) -> "ExpectedDifference":  # fmt: skip
        """From what is expected of each study, the fraction first among the gains."""
        one, two = (_of_pairs(width, pairs) for width in widths)
        main = next(iter(gains.values()))
        in_pairs, narrow, wide, unpaired = (
            difference_half_width(one, two, r) for r in (main.correlation, main.most, main.least, 0.0)
        )
        asked = None if half_width is None else AskedRuns.of(half_width, pairs, beds, in_pairs, unpaired)
        runs = "landings" if study.journey.touchdowns == 1 else "journeys"
        answer, level = answer_words(study), widths[0].level
        return cls(
            against, pairs, beds, runs, answer, in_pairs, narrow, wide, unpaired, gains, basis, asked, level
        )  # fmt: skip

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


def main_name(study: Study) -> str:
    """The answer of a study by its name in a comparison."""
    return study.design.half_width_of or ("at_rest" if answers_rest(study) else "returns")


def pair_gains(study: Study, measured: Mapping[str, float]) -> dict[str, PairGain]:
    """By result, the fraction first; measured: correlations of pairs that were made."""
    like = "returns" if study.journey.touchdowns == 1 else "at_rest"
    gains = {}
    for name in (main_name(study), *(WORDS if like == "at_rest" else ())):
        expected = EXPECTED_CORRELATION.get(name, EXPECTED_CORRELATION[like])
        ends = (measured[name],) * 3 if name in measured else expected
        gains[name] = PairGain.of(WORDS.get(name, answer_words(study).removeprefix("the ")), *ends)
    return gains


def _of_pairs(width: ExpectedHalfWidth, pairs: int) -> float:
    """Half-width of a study of which so many runs have a partner."""
    return width.median * math.sqrt(max(width.run_count / pairs, 1.0))


def _points(share: float) -> str:
    return f"{100 * share:.2g}"
