"""The numbers that tell most of a study beside its answer, picked once for its sentences and for its page."""

from collections import Counter
from dataclasses import dataclass
from typing import Any

from lithobrake.outcomes import TouchdownOutcome

SPEED = "speed_out"


@dataclass(frozen=True)
class MainInput:
    """The input that the outgoing speed varies with most.

    total, interval: its total Sobol index and the 95 % bounds of it; noise_share: share of the variance of the runs
    that is scatter, None where that is not known.
    """

    name: str
    total: float
    interval: tuple[float, float]
    noise_share: float | None


@dataclass(frozen=True)
class TellingNumbers:
    """How touchdowns ended, how fast those that left are, what decides that, and how well fresh runs are met.

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
        return cls(ended, failed, speed, _main_input(results["screening"]), results["scores"]["test_all"][SPEED])

    @property
    def left_count(self) -> int:
        """Touchdowns after which the lander left the surface."""
        return self.ended[TouchdownOutcome.CLEAR]


def _main_input(screening: dict[str, Any]) -> MainInput:
    total = screening["sobol_total"][SPEED]
    name = max(total, key=lambda one: total[one])
    low, high = screening["sobol_total_interval"][SPEED][name]
    return MainInput(name, total[name], (low, high), screening["fits"][SPEED]["noise_share"])
