"""One run as the ledger keeps it, and the ledger as another process reads it."""

import json
import sqlite3
from dataclasses import dataclass
from datetime import UTC, datetime
from os import PathLike
from pathlib import Path
from typing import Any

from lithobrake.atomic import lock_holder


@dataclass(frozen=True)
class Record:
    """One run: its state, what determined it, what came out, and where and how long it was made."""

    key: str
    status: str
    outcome: str | None
    inputs: dict[str, float]
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
OBJECTS = ("inputs", "outputs", "draws")


def record(row: tuple[Any, ...]) -> Record:
    """A row of the ledger, its columns in the order of COLUMNS."""
    values = dict(zip(COLUMNS, row, strict=True))
    return Record(**(values | {name: json.loads(values[name] or "{}") for name in OBJECTS}))


def utc_now() -> str:
    """The present moment (ISO, UTC)."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def read_records(path: str | PathLike[str]) -> list[Record]:
    """All runs of a ledger in the order of their ends, the unended last; a campaign may be at work on it meanwhile.

    Raises ValueError when there is no ledger at the path.
    """
    path = Path(path)
    # Without a log beside it the file is complete; so it can be read where nothing may be written, too.
    whole = "" if path.with_name(f"{path.name}-wal").exists() else "&immutable=1"
    try:
        database = sqlite3.connect(f"{path.absolute().as_uri()}?mode=ro{whole}", uri=True)
        try:
            order = "ended IS NULL OR status IN ('queued', 'running'), ended, key"
            rows = database.execute(f"SELECT {', '.join(COLUMNS)} FROM runs ORDER BY {order}").fetchall()
        finally:
            database.close()
    except sqlite3.Error as error:
        raise ValueError(f"{path} cannot be read as a ledger ({error}); name the folder of a study that ran") from error
    return [record(row) for row in rows]


def lock_path(path: Path) -> Path:
    """The file that the process at work on a ledger holds."""
    return path.with_name(f".{path.name}.lock")


def campaign_began(path: str | PathLike[str]) -> str | None:
    """When the campaign that is at work on a ledger began (ISO, UTC); None when none is."""
    holder = lock_holder(lock_path(Path(path)))
    return holder.get("began") if holder else None
