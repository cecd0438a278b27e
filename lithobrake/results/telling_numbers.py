"""The most informative numbers of a paper study apart from its answer, picked once for its sentences and its page."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.results.model_results import ExpansionResults, OutputErrors
from lithobrake.results.summary import PaperResults
from lithobrake.vocabulary.outcomes import TouchdownOutcome

SPEED = "speed_out"


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
    def of(cls, results: PaperResults) -> "TellingNumbers":
        """Those of the results of a study."""
        ended: Counter[str] = Counter()
        for design in results.designs.values():
            ended.update(design.outcomes)
        failed, speed = ended.pop("failed", 0), results.monte_carlo.outputs.get(SPEED)
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
