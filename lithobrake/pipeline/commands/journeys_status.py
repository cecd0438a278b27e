"""How far the journeys of a study are, from its ledger while they are followed, or from journeys.csv after."""

import tomllib
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lithobrake.campaign import Record, RunStatus
from lithobrake.files.reading import read_rows
from lithobrake.pipeline.folder.study_folder import AGAIN
from lithobrake.results.intact import STUDY_FILE
from lithobrake.results.journey_tables import JOURNEYS, TOUCHDOWNS
from lithobrake.vocabulary.outcomes import JourneyEnd, TouchdownOutcome

NUMBER, TOUCHDOWN = "journey", "touchdown"
# How a journey ended whose last touchdown did so; after any other it flies on.
ENDS: dict[str, JourneyEnd] = {
    TouchdownOutcome.CAPTURED: JourneyEnd.AT_REST,
    TouchdownOutcome.TIME_LIMIT: JourneyEnd.UNDER_WAY,
}
# What stays the same over the touchdowns of a journey: its lander, its bed, and its soil where regions have none of
# their own.
SOIL, KEPT = "grain.", ("lander.", "solver.")
# Stands for the moment at which a touchdown will have ended: after all others, as text.
_LATER = "~"


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
        ended = sum(self.ends.values())
        found = [f"{self.ends[end]} {end.label}" for end in JourneyEnd if self.ends[end]]
        more = "" if self.is_final else " so far"
        return [
            f"journeys: {ended} of {self.total} ended{more}{': ' if found else ''}{', '.join(found)}; "
            f"{self.touchdowns} touchdowns"
        ]

    def to_json(self) -> dict[str, Any]:
        """All of it as JSON values."""
        return {
            "total": self.total,
            "ends": {end.value: self.ends[end] for end in JourneyEnd},
            "touchdowns": self.touchdowns,
            "is_final": self.is_final,
        }


def touchdown_keys(path: Path, every: Sequence[Record], asked: Collection[str], *, is_current: bool) -> set[str]:
    """Keys of the touchdowns of a study's journeys, which begin with those that are asked for; empty without any.

    is_current: whether touchdowns.csv is of the study as it is; until it is, a touchdown goes on from the one with the
    number before it of the same journey and soil, and ended after that: those of an earlier delivery ended before.
    """
    if is_current:
        return {row["key"] for row in read_rows(path / TOUCHDOWNS, ("key",), AGAIN)}
    last: dict[frozenset[tuple[str, float]], Record] = {}
    found: set[str] = set()
    same = KEPT if _has_soils(path) else (SOIL, *KEPT)
    of_journeys = [record for record in every if NUMBER in record.inputs]
    for record in sorted(of_journeys, key=lambda one: (one.inputs[TOUCHDOWN], one.ended or _LATER)):
        kept = _kept(record, same)
        before = last.get(kept)
        if record.key in asked or (before is not None and _goes_on(before, record)):
            last[kept] = record
            found.add(record.key)
    return found


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


def _goes_on(before: Record, record: Record) -> bool:
    """Whether a touchdown may be the one after another of its journey."""
    follows = record.inputs[TOUCHDOWN] == before.inputs[TOUCHDOWN] + 1.0
    return follows and before.ended is not None and before.ended <= (record.ended or _LATER)


def _has_soils(path: Path) -> bool:
    """Whether the study of a folder gives regions a soil of their own; not where its copy of the study is no study."""
    try:
        return "soil" in tomllib.loads((path / STUDY_FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        # What is wrong with the copy stands in the state of the folder.
        return False


def _kept(record: Record, kept: tuple[str, ...]) -> frozenset[tuple[str, float]]:
    """What the touchdowns of one journey share: the bed, and numbers whose keys begin so."""
    inputs: Mapping[str, float] = record.inputs
    same = (NUMBER, "bed", *(name for name in inputs if name.startswith(kept)))
    return frozenset((name, inputs[name]) for name in same if name in inputs)
