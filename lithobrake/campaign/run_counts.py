"""Where a campaign stands: counts, rate, time left, and the spread of each output so far."""

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from datetime import UTC, datetime

from lithobrake.campaign.record import ENDED, Record, RunStatus


@dataclass
class Spread:
    """Count, mean and standard deviation of numbers that come one by one.

    Source: [Welford-1962].
    """

    count: int = 0
    mean: float = 0.0
    _squares: float = 0.0

    def add(self, value: float) -> None:
        """Take one more number in."""
        self.count += 1
        step = value - self.mean
        self.mean += step / self.count
        self._squares += step * (value - self.mean)

    @property
    def std(self) -> float:
        """Standard deviation; NaN for less than two numbers."""
        return math.sqrt(self._squares / (self.count - 1)) if self.count > 1 else math.nan


@dataclass
class Tally:
    """Counts of the distinct runs of a campaign, and what follows from them.

    done, failed: ended, reused ones included; reused: known before the campaign began; running: handed to a worker.
    seconds: since the campaign began.
    """

    total: int
    done: int = 0
    failed: int = 0
    running: int = 0
    reused: int = 0
    seconds: float = 0.0
    spreads: dict[str, Spread] = field(default_factory=dict)

    @property
    def ended(self) -> int:
        """Runs that ended, done or failed."""
        return self.done + self.failed

    @property
    def rate(self) -> float:
        """Runs that ended in a second; NaN before the first."""
        fresh = self.ended - self.reused
        return fresh / self.seconds if fresh and self.seconds > 0 else math.nan

    @property
    def time_left(self) -> float:
        """Time until all have ended, at the rate so far [s]; NaN before the first has."""
        return (self.total - self.ended) / self.rate

    def add(self, status: RunStatus, outputs: dict[str, float]) -> None:
        """Count a run that has ended."""
        if status == RunStatus.FAILED:
            self.failed += 1
        else:
            self.done += 1
        for name, value in outputs.items():
            self.spreads.setdefault(name, Spread()).add(value)

    def sentence(self) -> str:
        """All counts in one line."""
        parts = [f"{self.done} done", f"{self.running} running", f"{self.failed} failed"]
        if self.reused:
            parts[0] += f" ({self.reused} known before)"
        if math.isfinite(self.rate):
            parts += [per_time(self.rate, " runs"), f"{duration(self.time_left)} left"]
        return f"{self.total} runs: {', '.join(parts)}"

    def spread_lines(self, names: Iterable[str]) -> list[str]:
        """Mean and standard deviation so far of each of these outputs [SI], in lines; two runs are needed for them."""
        width = max(map(len, names), default=0)
        return [
            f"{name:<{width}}  {spread.mean:>10.4g} +- {spread.std:<9.3g} ({spread.count} runs)"
            for name, spread in ((name, self.spreads.get(name, Spread())) for name in names)
            if spread.count > 1
        ]


def common_reasons(reasons: Iterable[str | None]) -> str:
    """The commonest reasons of failed runs with their counts; None, where a run has not failed, counts for nothing."""
    common = Counter(reason for reason in reasons if reason is not None).most_common(3)
    return "; ".join(f"{number} x {reason}" for reason, number in common)


def per_time(rate: float, things: str = "") -> str:
    """Return a rate [1/s] as text in a suitable unit."""
    return f"{rate:.3g}{things}/s" if rate >= 1 else f"{60 * rate:.3g}{things}/min"


def duration(seconds: float) -> str:
    """Return a time [s] as text in a suitable unit."""
    for limit, unit, size in ((120.0, "s", 1.0), (7200.0, "min", 60.0), (172_800.0, "h", 3600.0)):
        if seconds < limit:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds / 86_400:.0f} days"


def ledger_tally(records: Iterable[Record], began: str | None = None) -> Tally:
    """Where a ledger stands, with the rate of the campaign that began at a moment (ISO, UTC) and is still at work.

    began: None when not running; what is marked as running was then stopped, and counts among what is to be made.
    """
    result = Tally(0)
    for entry in records:
        result.total += 1
        result.running += began is not None and entry.status == RunStatus.RUNNING
        if entry.status in ENDED:
            result.add(entry.status, entry.outputs)
            result.reused += began is not None and (entry.ended or "") < began
    if began is not None:
        result.seconds = (datetime.now(UTC) - datetime.fromisoformat(began)).total_seconds()
    return result
