"""What the drawn runs say while more of them come in: the estimates as they are now, with their intervals.

Runs that take long come in last, so what is said early leans to those that end soon.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from lithobrake.campaign import Record, RunStatus
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.percentages import percent, with_interval
from lithobrake.vocabulary.quantities import OVER_RIM

if TYPE_CHECKING:
    from lithobrake.analysis import IntervalEstimate, ShareEstimate

# The share of a lander that is captured, by how its touchdown ended; no other end has one.
CAPTURED = {TouchdownOutcome.CAPTURED.value: 1.0, TouchdownOutcome.CLEAR.value: 0.0}
# Of fewer runs no interval says anything.
FEWEST_RUNS = 2
NO_FLIGHTS = "The return fraction is not known yet: it takes flights."


@dataclass(frozen=True)
class RunningEstimates:
    """Estimates from the runs that have ended, beds as the units of all intervals.

    captured   share of the landers that are captured, of those that are captured or clear; None where none is either
    speed_out  mean speed [m/s] of those that are clear; None where they came down on less than two beds
    returns    the return fraction; None before the runs have flown
    """

    captured: "ShareEstimate | None"
    speed_out: "IntervalEstimate | None"
    returns: "ShareEstimate | None" = None

    def lines(self) -> list[str]:
        """The estimates in words."""
        if self.captured is None:
            return []
        lines = [f"so far, from {self.captured.source}:", f"  captured: {_share(self.captured)}"]
        if self.speed_out is not None:
            value, lower, upper = self.speed_out.value, self.speed_out.lower, self.speed_out.upper
            level = percent(self.speed_out.level)
            lines.append(f"  mean speed_out: {value:.4g} m/s ({level}: {lower:.4g} to {upper:.4g})")
        return [*lines, f"  {NO_FLIGHTS}" if self.returns is None else f"  return fraction: {_share(self.returns)}"]

    def to_json(self) -> dict[str, Any]:
        """All of it as JSON values."""
        # Who only looks at lines does not wait for these.
        from lithobrake.pipeline.answer.typed_estimates import fraction
        from lithobrake.results.json_values import to_json

        return {
            TouchdownOutcome.CAPTURED.value: None if self.captured is None else to_json(fraction(self.captured)),
            "speed_out": None if self.speed_out is None else asdict(self.speed_out),
            "returns": None if self.returns is None else to_json(fraction(self.returns)),
            "why_no_returns": NO_FLIGHTS if self.returns is None else None,
        }


def running_estimates(records: Sequence[Record], flown: Mapping[str, float]) -> RunningEstimates | None:
    """The estimates from drawn runs, of which those count that are done; None for too few.

    flown: share of its flights in which a run returns, by key, of those that have flown.
    """
    # By key: sums then have the same last digit in whatever order the runs ended.
    done = sorted((record for record in records if record.status == RunStatus.DONE), key=lambda record: record.key)
    if len(done) < FEWEST_RUNS:
        return None
    # Whoever looks at a study without such runs does not wait for these.
    import numpy as np

    from lithobrake.analysis import mean_estimate, share_estimate

    bed = np.array([record.inputs["bed"] for record in done])
    captured = np.array([CAPTURED.get(record.outcome or "", np.nan) for record in done])
    speed = np.array([record.outputs.get("speed_out", np.nan) for record in done])
    returns = np.array([flown.get(record.key, np.nan) for record in done])
    # As the result takes landings without an outcome.
    over = np.array(
        [record.outputs.get(OVER_RIM) == 1.0 and record.outcome == TouchdownOutcome.CLEAR for record in done]
    )
    return RunningEstimates(
        captured=share_estimate(captured, bed, like_missing=over) if np.isfinite(captured).any() else None,
        speed_out=mean_estimate(speed, bed) if len(np.unique(bed[np.isfinite(speed)])) > 1 else None,
        returns=share_estimate(returns, bed, like_missing=over) if np.isfinite(returns).any() else None,
    )


def _share(found: "ShareEstimate") -> str:
    """A share with its interval, which holds whatever became of landings without an outcome, or why it has none."""
    why = "" if found.why is None else f", without an interval: {found.why}"
    return f"{with_interval(found, level=found.level)}{why}"
