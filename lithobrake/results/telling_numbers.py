"""The most informative numbers of a paper study apart from its answer, picked once for its sentences and its page."""

from collections import Counter
from dataclasses import dataclass
from typing import Any

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
    speed: dict[str, float] | None
    main_input: MainInput
    score: dict[str, Any]

    @classmethod
    def of(cls, results: dict[str, Any]) -> "TellingNumbers":
        """Those of the table `results` of a summary."""
        ended: Counter[str] = Counter()
        for design in results["designs"].values():
            ended.update(design["outcomes"])
        failed = ended.pop("failed", 0)
        speed = results["monte_carlo"]["outputs"].get(SPEED)
        return cls(ended, failed, speed, _main_input(results["refined"]), results["scores"]["test_all"][SPEED])

    @property
    def left_count(self) -> int:
        """Touchdowns after which the lander left the surface."""
        return self.ended[TouchdownOutcome.CLEAR]


def _main_input(refined: dict[str, Any]) -> MainInput:
    total, intervals = refined["sobol_total"][SPEED], refined["sobol_total_interval"][SPEED]
    name = max(total, key=lambda one: total[one])
    low, high = intervals[name]
    equals = sorted((one for one in total if one != name and intervals[one][1] >= low), key=lambda one: -total[one])
    noise_share = refined["fits"][SPEED]["noise_share"]
    return MainInput(name, total[name], (low, high), refined["degree"], tuple(equals), noise_share)
