"""How far a study is while it runs, and what its runs say so far."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lithobrake.campaign import Record, RunStatus
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.planning.known_journeys import NUMBER, TOUCHDOWN
from lithobrake.pipeline.study_folder import AGAIN
from lithobrake.results.study_files import JOURNEYS
from lithobrake.statements.journeys import journey_ends_so_far
from lithobrake.statements.touchdowns import NO_FLIGHTS, so_far
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.outcomes import JourneyEnd, TouchdownOutcome
from lithobrake.vocabulary.quantities import OVER_RIM

if TYPE_CHECKING:
    from lithobrake.vocabulary.landing_fraction import LandingFraction

# The share of a lander that is captured, by how its touchdown ended; no other end has one.
CAPTURED = {TouchdownOutcome.CAPTURED.value: 1.0, TouchdownOutcome.CLEAR.value: 0.0}
# Of fewer runs no interval says anything.
FEWEST_RUNS = 2
# How a journey ended whose last touchdown did so; after any other it flies on.
ENDS: dict[str, JourneyEnd] = {
    TouchdownOutcome.CAPTURED: JourneyEnd.AT_REST,
    TouchdownOutcome.TIME_LIMIT: JourneyEnd.UNDER_WAY,
}


@dataclass(frozen=True)
class RunningEstimates:
    """Estimates from the runs that have ended, beds as the units of all intervals.

    captured   share of the landers that are captured, of those that are captured or clear; None where none is either
    speed_out  mean speed [m/s] of those that are clear; None where they came down on less than two beds
    returns    the return fraction; None before the runs have flown
    """

    captured: "LandingFraction | None"
    speed_out: Estimate | None
    returns: "LandingFraction | None" = None

    def lines(self) -> list[str]:
        """The estimates in words."""
        return [] if self.captured is None else so_far(self.captured, self.speed_out, self.returns)

    def to_json(self) -> dict[str, Any]:
        """All of it as JSON values."""
        # Who only looks at lines does not wait for these.
        from lithobrake.results.run_results import ReturnFraction
        from lithobrake.results.study_files import json_values

        captured, returns = (
            None if one is None else json_values(ReturnFraction.of(one)) for one in (self.captured, self.returns)
        )
        speed = self.speed_out
        return {
            TouchdownOutcome.CAPTURED.value: captured,
            "speed_out": None if speed is None else {**json_values(speed), "level": speed.level},
            "returns": returns,
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


@dataclass(frozen=True)
class JourneysStatus:
    """How many journeys have ended, and how.

    is_final: every one of them, and their flights are known. said: how far they are, by the process that follows them,
    which knows their flights; None where there is none.
    """

    total: int
    ends: "Counter[str]"
    touchdowns: int
    is_final: bool
    said: str | None = None

    def lines(self) -> list[str]:
        """All of it in words."""
        if self.said is not None:
            return [self.said]
        return [journey_ends_so_far(self.ends, self.total, self.touchdowns, is_final=self.is_final)]

    def to_json(self) -> dict[str, Any]:
        """All of it as JSON values."""
        return {
            "total": self.total,
            "ends": {end.value: self.ends[end] for end in JourneyEnd},
            "touchdowns": self.touchdowns,
            "is_final": self.is_final,
        }


def journeys_status(path: Path, records: Sequence[Record], total: int, *, is_current: bool) -> JourneysStatus | None:
    """Where the journeys of these touchdowns stand; None where they are of none. total: how many journeys are asked."""
    if not any(NUMBER in record.inputs for record in records):
        return None
    touchdowns = sum(record.status in (RunStatus.DONE, RunStatus.FAILED) for record in records)
    if is_current:
        ends = Counter(row["end"] for row in read_rows(path / JOURNEYS, ("end",), AGAIN))
        # With those that never touched down, of which the ledger knows nothing.
        return JourneysStatus(ends.total(), ends, touchdowns, is_final=True)
    last: dict[float, Record] = {}
    for record in sorted(records, key=lambda one: one.inputs[TOUCHDOWN]):
        last[record.inputs[NUMBER]] = record
    found = Counter(str(end) for end in map(_end, last.values()) if end is not None)
    return JourneysStatus(total, found, touchdowns, is_final=False)


def _end(record: Record) -> JourneyEnd | None:
    """How a journey ended with its last touchdown; None where it goes on, or ended in flight."""
    if record.status == RunStatus.FAILED:
        return JourneyEnd.FAILED
    return ENDS.get(record.outcome or "") if record.status == RunStatus.DONE else None
