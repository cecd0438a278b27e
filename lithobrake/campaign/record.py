"""One run as the ledger keeps it, and where a campaign stands."""

import hashlib
import json
import logging
import math
import sqlite3
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, closing
from dataclasses import dataclass, field
from datetime import UTC, datetime
from enum import StrEnum
from os import PathLike
from pathlib import Path
from typing import Any

from lithobrake.files.atomic import lock_holder
from lithobrake.files.reading import NUMBER, DamagedFileError, check, parsed, reading
from lithobrake.vocabulary.number_words import duration as duration_words
from lithobrake.vocabulary.quantities import Row

log = logging.getLogger(__name__)
# What the hash of a row, in the column CHECKSUM, is of; how often a failed run was tried may be reset.
CHECKSUM = "sha256"
FORMAT_VERSION = 3
# Characters of a key that are shown; two runs of a campaign that share them are not met.
KEY_LENGTH = 12
# Runs may have taken days: no damage is a reason to write over them.
LEFT = "it is left as it is: put a copy of it back, or move it away to have all its runs made again"
OBJECTS = ("inputs", "outputs", "draws")
_FORM = {
    "key": str, "status": str, "outcome": str | None, "inputs": {str: NUMBER}, "outputs": {str: NUMBER}, "draws": dict,
    "seed": int, "replicate": int, "attempts": int, "reason": str | None, "wall_s": NUMBER | None,
    "cpu_s": NUMBER | None, "host": str | None, "version": str, "started": str | None, "ended": str | None,
}  # fmt: skip


class RunStatus(StrEnum):
    """State of a run in its ledger; running: handed to a worker. How a run that is done ended is its outcome."""

    QUEUED = "queued"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"


UNENDED = (RunStatus.QUEUED, RunStatus.RUNNING)
ENDED = (RunStatus.DONE, RunStatus.FAILED)


@dataclass(frozen=True)
class Record:
    """One run: its state, what determined it, what came out, and where and how long it was made."""

    key: str
    status: RunStatus
    outcome: str | None
    inputs: Row
    outputs: dict[str, float]
    draws: dict[str, Any]
    seed: int
    replicate: int
    attempts: int
    reason: str | None
    wall_s: float | None
    cpu_s: float | None
    host: str | None
    version: str
    started: str | None
    ended: str | None


COLUMNS = tuple(Record.__dataclass_fields__)
HASHED = tuple(name for name in COLUMNS if name != "attempts")


def reading_ledger(path: Path) -> AbstractContextManager[None]:
    """Turn whatever a damaged ledger makes its reader raise into DamagedFileError."""
    return reading(path, LEFT, sqlite3.Error)


def refuse_other_formats(path: Path, version: int) -> None:
    """Raise DamagedFileError for a ledger of another format; that of an empty file is 0."""
    if version not in (0, FORMAT_VERSION):
        raise DamagedFileError(
            f"{path} has ledger format {version}; this version reads {FORMAT_VERSION}: "
            "move the file away, or use the version of lithobrake that wrote it"
        )


def row_hash(*values: Any) -> str:
    """Hash of the values of a row as SQLite gives them, in the order of HASHED."""
    return hashlib.sha256(json.dumps(values, default=repr).encode()).hexdigest()


def intact_records(path: Path, rows: Iterable[tuple[Any, ...]]) -> Iterator[Record]:
    """The rows of a ledger, in the order of COLUMNS and then CHECKSUM, as records.

    Ended runs that were changed since are left out, and a warning says so. Raises ValueError for what no campaign
    wrote.
    """
    columns, changed = [COLUMNS.index(name) for name in HASHED], []
    for row in rows:
        if row[COLUMNS.index("status")] not in UNENDED and row[-1] != row_hash(*(row[column] for column in columns)):
            changed.append(str(row[0])[:KEY_LENGTH])
        else:
            yield record_from_row(row[:-1])
    if changed:
        log.warning(
            "%s has %d %s edited after the run was made (key %s), left out here and made again by the next command "
            "that needs them.",
            *(path, len(changed), "rows" if len(changed) > 1 else "row"),
            ", ".join(changed[:3]) + (", ..." if len(changed) > 3 else ""),
        )


def record_from_row(row: tuple[Any, ...]) -> Record:
    """A row of the ledger, its columns in the order of COLUMNS. Raises ValueError for one that no campaign wrote."""
    values = dict(zip(COLUMNS, row, strict=True))
    values |= {name: parsed(values[name] or "{}", dict) for name in OBJECTS}
    check(values, _FORM, f"run {values['key']}")
    if values["status"] not in list(RunStatus):
        raise ValueError(f"run {values['key']}: status is {values['status']!r}; allowed: {', '.join(RunStatus)}")
    return Record(**{**values, "status": RunStatus(values["status"])})


def utc_now() -> str:
    """The present moment (ISO, UTC)."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def read_records(path: str | PathLike[str]) -> list[Record]:
    """Read all runs of a ledger in the order in which they ended, unended ones last; a campaign may be writing to it.

    Ended runs whose row was changed since are left out, and a warning says so. Raises ValueError when the path holds no
    ledger, a damaged one, or one of another format.
    """
    path = Path(path)
    if not path.is_file():
        raise ValueError(f"{path} is not there; name the folder of a study that ran")
    # Without a log beside it the file is complete; so it can be read where nothing may be written, too.
    whole = "" if path.with_name(f"{path.name}-wal").exists() else "&immutable=1"
    order = "ended IS NULL OR status IN (?, ?), ended, key"
    with (
        reading_ledger(path),
        closing(sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro{whole}", uri=True)) as database,
    ):
        refuse_other_formats(path, database.execute("PRAGMA user_version").fetchone()[0])
        columns = ", ".join((*COLUMNS, CHECKSUM))
        rows = database.execute(f"SELECT {columns} FROM runs ORDER BY {order}", UNENDED)
        return list(intact_records(path, rows))


def lock_path(path: Path) -> Path:
    """The file that the process at work on a ledger holds."""
    return path.with_name(f".{path.name}.lock")


def campaign_began(path: str | PathLike[str]) -> str | None:
    """Start time (ISO, UTC) of the campaign that is running on a ledger; None if there is none."""
    holder = lock_holder(lock_path(Path(path)))
    return holder.get("began") if holder else None


@dataclass
class Spread:
    """Count, mean and standard deviation of numbers that come one by one.

    Source: [Welford-1962].
    """

    count: int = 0
    mean: float = 0.0
    _squares: float = 0.0

    def add(self, value: float) -> None:
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
    """A duration [s] as text in whole units, such as "3 min"."""
    return duration_words(seconds, 0)


def ledger_tally(records: Iterable[Record], began: str | None = None) -> Tally:
    """Counts of a ledger, with the rate of the campaign that began at a time (ISO, UTC) and is still running.

    began: None when not running; what is marked as running was then stopped, and counts among what is to be made.
    """
    result = Tally(0)
    for entry in records:
        result.total += 1
        result.running += began is not None and entry.status == RunStatus.RUNNING
        if entry.status in ENDED:
            result.add(entry.status, entry.outputs)
            # Both are UTC in ISO format, so their order as texts is their order in time.
            result.reused += began is not None and (entry.ended or "") < began
    if began is not None:
        result.seconds = (datetime.now(UTC) - datetime.fromisoformat(began)).total_seconds()
    return result
