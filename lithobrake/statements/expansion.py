"""Sentences and the most informative numbers of an expansion and its samples."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from lithobrake.results.model_results import ExpansionAnalysis, ExpansionResults, OutputErrors, SampleResults
from lithobrake.statements import touchdowns
from lithobrake.statements.labels import PAPER_OUTPUTS, bracket, input_words, output
from lithobrake.vocabulary.constants import CENTIMETRES
from lithobrake.vocabulary.number_words import (
    as_sentence,
    at_level,
    fixed,
    intervals,
    listing,
    number,
    percent,
    thousands,
)
from lithobrake.vocabulary.outcomes import TouchdownOutcome

if TYPE_CHECKING:
    from lithobrake.results.model_results import DesignCounts
    from lithobrake.results.page_data import PageExpansion
    from lithobrake.results.summary import Results

SPEED = "speed_out"
# What SampleResults.model says of samples of the refined expansion.
MODEL = "expansion"
# Of the intervals of indices and scores, which are those of [Landings-PCE].
LEVEL = 0.95
QUANTILES = ("quantile_0.05", "quantile_0.5", "quantile_0.95")
POINT_WORDS = {
    "smolyak": "on the Smolyak grid",
    "sobol_sequence": "of a Sobol sequence",
    "latin_hypercube": "of a Latin hypercube",
    "fekete": "at approximate Fekete points",
}


@dataclass(frozen=True)
class MainInput:
    """The input with the largest total Sobol index of the rebound speed, by the refined expansion.

    total, interval: the index and its 95 % bounds, which hold sampling errors and no truncation error; degree: of the
    expansion; equals: inputs whose intervals overlap its own; noise_share: share of the variance of the runs that is
    scatter, None where that is not known.
    """

    name: str
    total: float
    interval: tuple[float, float]
    degree: int
    equals: tuple[str, ...]
    noise_share: float | None


@dataclass(frozen=True)
class TellingNumbers:
    """How touchdowns ended, the rebound speed, its dominant input, and how well fresh runs are predicted.

    ended: touchdowns by their outcome, over all designs; failed: runs without one; speed: quantiles of the samples
    that leave [m/s], None without any; score: of the outgoing speed on fresh runs with all inputs varying.
    """

    ended: Counter[str]
    failed: int
    speed: Mapping[str, float] | None
    main_input: MainInput
    score: OutputErrors

    @classmethod
    def of(cls, results: ExpansionAnalysis, samples: SampleResults | None) -> "TellingNumbers":
        """Those of the expansions of a study, and of the samples of the refined one, if any."""
        ended: Counter[str] = Counter()
        for design in results.designs.values():
            ended.update(design.outcomes)
        failed = ended.pop("failed", 0)
        speed = samples.outputs.get(SPEED) if samples and samples.model == MODEL else None
        quantiles = None if speed is None else speed.quantiles
        return cls(ended, failed, quantiles, _main_input(results.refined), results.scores["test_all"][SPEED])

    @property
    def left_count(self) -> int:
        """Touchdowns after which the lander left the surface."""
        return self.ended[TouchdownOutcome.CLEAR]


def _main_input(refined: ExpansionResults) -> MainInput:
    total, intervals = refined.sobol_total[SPEED], refined.sobol_total_interval[SPEED]
    name = max(total, key=lambda one: total[one])
    low, high = intervals[name]
    equals = sorted((one for one in total if one != name and intervals[one][1] >= low), key=lambda one: -total[one])
    return MainInput(name, total[name], (low, high), refined.degree, tuple(equals), refined.fits[SPEED].noise_share)


def telling_sentences(results: "Results", *, has_scatter: bool) -> list[str]:
    """The most informative numbers of an expansion; has_scatter: whether samples have the scatter of the runs."""
    if results.expansion is None:
        return []
    telling = TellingNumbers.of(results.expansion, results.samples)
    ended = dict(telling.ended) | ({"failed": telling.failed} if telling.failed else {})
    said = [touchdowns.touchdown_outcomes(ended, telling.ended.total(), "touchdowns of the designs")]
    if telling.speed:
        of = "with run-to-run scatter" if has_scatter else "by the expansion alone, without scatter"
        shown = {level: telling.speed[level] for level in QUANTILES}
        said.append(touchdowns.rebound_speed(f"the samples that leave the surface, {of}", shown))
    return [*said, _largest_index(telling.main_input), _accuracy(telling.score)]


def _largest_index(main: "MainInput") -> str:
    """The dominant input of the rebound speed, with its interval, of what it is a share, and what rivals it."""
    if main.total <= 0.0:
        return "No input explains the rebound speed significantly."
    low, high = main.interval
    rivals = f", not distinguishable from {', '.join(main.equals)}" if main.equals else ""
    return (
        f"Largest total Sobol index of the rebound speed: {main.name}, {fixed(main.total)} ({at_level(LEVEL)} "
        f"{fixed(low)} to {fixed(high)}, without truncation error){rivals}, as a share of the variance that the "
        f"refined expansion of degree {main.degree} explains{noise(main.noise_share)}."
    )


def noise(share: float | None) -> str:
    """Which part of the variance of the runs nothing explains; empty where that is not known."""
    return "" if share is None else f"; {percent(share)} of the variance of the runs is scatter that no input explains"


def _accuracy(score: "OutputErrors") -> str:
    """How well the expansion predicts fresh runs."""
    error, begin = f"{error_words(score)}, {_mape(score.mape)}", "On fresh runs with all inputs varying the"
    if score.q2 is None:
        return f"{begin} rebound speed does not vary: {error}."
    words = (
        f"explains {percent(score.q2)} of the variance of the rebound speed"
        if score.q2 > 0.0
        else "predicts the rebound speed no better than the mean of the runs"
    )
    return f"{begin} expansion {words}: Q2 = {q2(score, level=LEVEL)}, {error}."


def error_words(score: "OutputErrors") -> str:
    """The error of the rebound speed on new runs."""
    error, spread = (number(CENTIMETRES * one, 2) for one in (score.rmse, score.std))
    return f"error {error} cm/s at a spread of {spread} cm/s"


def q2(errors: "OutputErrors", level: float | None = None) -> str:
    """Q2 with its interval: "0.93 (0.80 to 0.97)"; level: where it is to be named."""
    if errors.q2 is None:
        return "undefined"
    low, high = errors.q2_interval
    has_interval = low is not None or high is not None
    return f"{fixed(errors.q2)}{bracket(low, 1.0 if has_interval and high is None else high, fixed, level=level)}"


def _mape(mape: float | None) -> str:
    return f"MAPE {'undefined' if mape is None else f'{mape:.2g} %'}"


def counts(data: "PageExpansion", study: Mapping[str, Any]) -> str:
    """The figure of what the designs cost; study: the tables of its file."""
    table, design, designs = data.results.node_counts, study["expansion"], data.results.designs
    level, inputs = design["screening_level"], len(data.results.screening.inputs)
    grid = design["points"] == "smolyak"
    place = f"at level {level}" if grid else f"of degree {design['screening_degree']}"
    words = (
        f"The screening of {inputs} inputs {place} takes {_runs(designs['screening'])} {POINT_WORDS[design['points']]}"
    )
    if grid and inputs in table.input_counts and level in table.levels:
        full = table.tensor[table.input_counts.index(inputs)][table.levels.index(level)]
        words += f", against {thousands(full)} on the full tensor grid"
    place = f"at level {design['refined_level']}" if grid else f"of degree {design['refined_degree']}"
    kept = len(data.results.kept_inputs)
    refined = "the kept input" if kept == 1 else f"the {kept} kept inputs"
    return f"{words}; the refined design in {refined} {place} takes {_runs(designs['refined'])}."


def _runs(design: "DesignCounts") -> str:
    """How many runs a design takes, and how they come about."""
    count, points = design.replicate_count, design.point_count
    return f"{design.run_count} runs" + (f" ({points} points, {count} times each)" if count > 1 else "")


def sobol(data: "PageExpansion", study: Mapping[str, Any]) -> str:
    """The figure of the inputs that matter; study: the tables of its file."""
    screening = data.results.screening
    leaders = [_leader(name, screening) for name in PAPER_OUTPUTS]
    shares = {name: screening.fits[name].noise_share for name in PAPER_OUTPUTS}
    scatter = [f"{percent(share)} for the {output(name).words}" for name, share in shares.items() if share is not None]
    rest = f"; scatter that no input explains is {listing(scatter)} of the variance of the runs" if scatter else ""
    kept = listing([input_words(name) for name in data.results.kept_inputs])
    share = min(data.results.kept_share[name] for name in study["expansion"]["kept_outputs"])
    return as_sentence(
        f"{listing(leaders)}{rest}; the second step keeps {kept}, which together account for at least "
        f"{percent(share)} of the explained variance of each output that the selection uses"
    )


def _leader(name: str, screening: "ExpansionResults") -> str:
    """The input that an output varies with most, if any was found, with its interval."""
    first = screening.sobol_first[name]
    main = max(first, key=lambda key: first[key])
    if first[main] <= 0.0:
        return f"no input explains the {output(name).words} significantly"
    low, high = (percent(end) for end in screening.sobol_first_interval[name][main])
    return (
        f"the {output(name).words} depends most on the {input_words(main)} ({percent(first[main])}, {low} to {high}, "
        "of its explained variance)"
    )


def errors(data: "PageExpansion") -> str:
    """The figure of how good the expansion is."""
    kept, every = (_explained(data.scores[stage]) for stage in ("test_kept", "test_all"))
    return (
        f"On new runs in which the kept inputs vary the expansion reaches {kept}; when all inputs vary, {every} "
        f"(in brackets {intervals(LEVEL)}; at a Q2 of 0 or less it explains nothing). Dashed lines: mean errors. A "
        "small error with a small Q2 only means that the output hardly varies."
    )


def _explained(table: "Mapping[str, OutputErrors]") -> str:
    """Explained share of the variance and mean error of the outputs of [Landings-PCE] on one set of runs."""
    parts = []
    for name in PAPER_OUTPUTS:
        words = "an undefined Q2" if table[name].q2 is None else f"Q2 = {q2(table[name])}"
        parts.append(f"{words} for the {output(name).words} ({_mape(table[name].mape)})")
    return listing(parts)
