"""The ledger of runs: one SQLite file, one row a run, one transaction a run.

Only the coordinating process writes. Readers, the sqlite3 shell among them, may look at any time:
`sqlite3 runs.sqlite "SELECT outcome, json_extract(outputs, '$.speed_out') FROM runs"`.
"""

import json
import sqlite3
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import UTC, datetime
from os import PathLike
from types import TracebackType
from typing import Any, Self

FORMAT_VERSION = 1

# status   queued, done, or failed (then `reason` says why); a run without a result has no outcome
# outcome  how the run ended, in the model's own words; outputs, inputs and draws are JSON objects (draws = what the
#          run drew by chance); an output that has no value is absent
_SCHEMA = """
CREATE TABLE IF NOT EXISTS runs (
    key TEXT PRIMARY KEY, status TEXT NOT NULL, outcome TEXT, inputs TEXT NOT NULL, draws TEXT, outputs TEXT,
    seed INTEGER NOT NULL, replicate INTEGER NOT NULL, reason TEXT, wall_s REAL, cpu_s REAL, host TEXT,
    version TEXT NOT NULL, ended TEXT
) WITHOUT ROWID
"""


@dataclass(frozen=True)
class Record:
    """One run as the ledger keeps it."""

    key: str
    status: str
    outcome: str | None
    inputs: dict[str, float]
    outputs: dict[str, float]
    draws: dict[str, Any]
    reason: str | None
    wall_s: float | None
    cpu_s: float | None


class Ledger:
    """Runs in a SQLite file. Use as a context manager, from one process and one thread."""

    def __init__(self, path: str | PathLike[str]) -> None:
        """Open or create the ledger. Raises ValueError when the file is no ledger or cannot be written."""
        self.path = path
        try:
            self._database = sqlite3.connect(path, isolation_level=None)
            # A finished run must survive a power cut: the log is synced at each commit.
            self._database.execute("PRAGMA journal_mode = WAL")
            self._database.execute("PRAGMA synchronous = FULL")
            version = self._database.execute("PRAGMA user_version").fetchone()[0]
            if version not in (0, FORMAT_VERSION):
                raise ValueError(
                    f"{path} has ledger format {version}; this version reads {FORMAT_VERSION}: "
                    "move the file away, or use the version of lithobrake that wrote it"
                )
            self._database.execute(_SCHEMA)
            self._database.execute(f"PRAGMA user_version = {FORMAT_VERSION}")
        except sqlite3.Error as error:
            raise ValueError(f"{path} cannot be used as a ledger ({error}); check the disk and the folder") from error

    def queue(self, runs: Iterable[tuple[str, Mapping[str, float], int, int]], version: str) -> None:
        """Enter runs that are to be made (key, inputs, seed, replicate) in one transaction; known keys stay."""
        rows = [(key, json.dumps(dict(inputs)), seed, replicate, version) for key, inputs, seed, replicate in runs]
        with self._database:
            self._database.execute("BEGIN")
            self._database.executemany(
                "INSERT OR IGNORE INTO runs (key, status, inputs, seed, replicate, version) "
                "VALUES (?, 'queued', ?, ?, ?, ?)",
                rows,
            )

    def finish(self, key: str, result: Mapping[str, Any]) -> None:
        """Enter the result of a queued run: status, outcome, outputs, draws, reason, wall_s, cpu_s, host."""
        with self._database:
            self._database.execute("BEGIN")
            self._database.execute(
                "UPDATE runs SET status = ?, outcome = ?, outputs = ?, draws = ?, reason = ?, wall_s = ?, cpu_s = ?, "
                "host = ?, ended = ? WHERE key = ?",
                (
                    result["status"],
                    result.get("outcome"),
                    json.dumps(result.get("outputs", {}), allow_nan=False),
                    json.dumps(result.get("draws", {}), allow_nan=False),
                    result.get("reason"),
                    result.get("wall_s"),
                    result.get("cpu_s"),
                    result.get("host"),
                    datetime.now(UTC).isoformat(timespec="milliseconds"),
                    key,
                ),
            )

    def find(self, keys: Iterable[str]) -> dict[str, Record]:
        """The runs with these keys that have ended, by key."""
        wanted = set(keys)
        columns = "key, status, outcome, inputs, outputs, draws, reason, wall_s, cpu_s"
        rows = self._database.execute(f"SELECT {columns} FROM runs WHERE status IN ('done', 'failed')")
        return {row[0]: _record(row) for row in rows if row[0] in wanted}

    def close(self) -> None:
        """Close the file."""
        self._database.close()

    def __enter__(self) -> Self:
        """Give the ledger itself."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the file."""
        self.close()


def _record(row: tuple[Any, ...]) -> Record:
    key, status, outcome, inputs, outputs, draws, reason, wall_s, cpu_s = row
    inputs, outputs, draws = (json.loads(text or "{}") for text in (inputs, outputs, draws))
    return Record(key, status, outcome, inputs, outputs, draws, reason, wall_s, cpu_s)
