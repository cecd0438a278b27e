"""The ledger of runs: one SQLite file, one row a run, one transaction a run.

Only the coordinating process writes, and there is only one. Readers, the sqlite3 shell among them, may look at any
time: `sqlite3 runs.sqlite "SELECT outcome, json_extract(outputs, '$.speed_out') FROM runs"`.
"""

import json
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from os import PathLike
from pathlib import Path
from typing import Any, Self

from lithobrake.campaign.record import (
    CHECKSUM,
    COLUMNS,
    ENDED,
    FORMAT_VERSION,
    HASHED,
    LEFT,
    UNENDED,
    Record,
    RunStatus,
    intact_records,
    lock_path,
    reading_ledger,
    refuse_other_formats,
    row_hash,
    utc_now,
)
from lithobrake.campaign.worker import refuse_while_importing
from lithobrake.files.atomic import locked
from lithobrake.vocabulary.plain_text import one_line

# Characters of a reason, of a word for an outcome: more would be the whole log of a program.
_REASON_LENGTH, _OUTCOME_LENGTH = 1000, 100

# status    queued, running (handed to a worker), done, or failed (then `reason` says why, `attempts` how often tried)
# outcome   how the run ended, in the model's own words; inputs, outputs and draws are JSON objects (draws = what the
#           run drew by chance); an output that has no value is absent
# version   of the code that made the run; started, ended: UTC
# sha256    of the rest of the row of an ended run, attempts left out: a row that was edited is known by it
# WITHOUT ROWID stores the key, which is a long text, once, and not in the table and in an index.
_SCHEMA = """
CREATE TABLE IF NOT EXISTS runs (
    key TEXT PRIMARY KEY, status TEXT NOT NULL, outcome TEXT, inputs TEXT NOT NULL, draws TEXT, outputs TEXT,
    seed INTEGER NOT NULL, replicate INTEGER NOT NULL, reason TEXT, wall_s REAL, cpu_s REAL, host TEXT,
    version TEXT NOT NULL, ended TEXT, attempts INTEGER NOT NULL DEFAULT 0, started TEXT,
    sha256 TEXT
) WITHOUT ROWID
"""
_SIGN = f"UPDATE runs SET {CHECKSUM} = row_hash({', '.join(HASHED)})"


class Ledger:
    """Runs in a SQLite file. Use as a context manager, from one process and one thread."""

    def __init__(self, path: str | PathLike[str]) -> None:
        """Open or create the ledger.

        Raises ValueError when another process has it open, when the file is no ledger, or when it cannot be written.
        """
        refuse_while_importing()
        self.path = Path(path)
        self._open = ExitStack()
        refusal = f"another campaign is at work on {self.path}{{who}}; wait for it, or choose another ledger"
        try:
            self._note = self._open.enter_context(locked(lock_path(self.path), refusal))
            # Transactions are begun by statements: those of the module would take the write lock only at the first
            # change.
            self._database = sqlite3.connect(self.path, isolation_level=None)
            self._open.callback(self._database.close)
            self._database.create_function("row_hash", len(HASHED), row_hash, deterministic=True)
            # Nothing is written before the file has been found to be a ledger.
            self._prepare(is_new=self._is_new())
        except (sqlite3.Error, OSError) as error:
            self._open.close()
            busy = isinstance(error, sqlite3.OperationalError | OSError)
            remedy = "choose a folder that can be written and has room" if busy else LEFT
            raise ValueError(f"{self.path} cannot be used as a ledger ({error}); {remedy}") from error
        except BaseException:
            self._open.close()
            raise

    def _is_new(self) -> bool:
        """Whether the file has nothing in it yet. Raises ValueError for a file that is no ledger."""
        version = self._database.execute("PRAGMA user_version").fetchone()[0]
        refuse_other_formats(self.path, version)
        tables = self._database.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall()
        columns = {row[1] for row in self._database.execute("PRAGMA table_info(runs)")}
        lacking = sorted({*COLUMNS, CHECKSUM} - columns)
        if lacking and (version or tables):
            raise ValueError(f"{self.path} cannot be used as a ledger (it lacks {', '.join(lacking)}); {LEFT}")
        return not tables

    def _prepare(self, is_new: bool) -> None:
        # A finished run must survive a power cut: the log is synced at each commit.
        self._database.execute("PRAGMA journal_mode = WAL")
        self._database.execute("PRAGMA synchronous = FULL")
        if is_new:
            with self._database:
                self._database.execute("BEGIN IMMEDIATE")
                self._database.execute(_SCHEMA)
                self._database.execute(f"PRAGMA user_version = {FORMAT_VERSION}")

    def queue(
        self, runs: Iterable[tuple[str, Mapping[str, float], int, int]], version: str, *, adds: bool = False
    ) -> None:
        """Enter the runs that are to be made now (key, inputs, seed, replicate); ended runs among them start again.

        Runs that were queued before and never ended are forgotten: whoever still wants them queues them again. adds:
        they are kept, as these runs are added to them.
        """
        rows = [
            (key, RunStatus.QUEUED, json.dumps(dict(inputs)), seed, replicate, version)
            for key, inputs, seed, replicate in runs
        ]
        if not adds:
            self._note(began=utc_now())
        with self._transaction():
            if not adds:
                self._database.execute("DELETE FROM runs WHERE status IN (?, ?)", UNENDED)
            self._database.executemany(
                "INSERT INTO runs (key, status, inputs, seed, replicate, version) VALUES (?, ?, ?, ?, ?, ?) "
                "ON CONFLICT (key) DO UPDATE SET status = excluded.status, inputs = excluded.inputs, "
                "seed = excluded.seed, replicate = excluded.replicate, version = excluded.version",
                rows,
            )

    def start(self, keys: Iterable[str]) -> None:
        """Mark queued runs as running."""
        # Nothing is lost with this mark, so it need not wait for the disk.
        self._database.execute("PRAGMA synchronous = NORMAL")
        try:
            with self._transaction():
                self._database.executemany(
                    "UPDATE runs SET status = ?, started = ? WHERE key = ? AND status = ?",
                    [(RunStatus.RUNNING, utc_now(), key, RunStatus.QUEUED) for key in keys],
                )
        finally:
            self._database.execute("PRAGMA synchronous = FULL")

    def finish(self, key: str, result: Mapping[str, Any]) -> None:
        """Enter the result of a queued run: what `run_model` gives, and attempts."""
        texts = {name: json.dumps(result.get(name, {}), allow_nan=False) for name in ("outputs", "draws")}
        # Both are in the words of a model, or of a program that it started.
        lengths = {"outcome": _OUTCOME_LENGTH, "reason": _REASON_LENGTH}
        words = [result.get(name) and one_line(str(result[name]), length) for name, length in lengths.items()]
        plain = [*words, *(result.get(name) for name in ("wall_s", "cpu_s", "host", "started"))]
        with self._transaction():
            self._database.execute(
                "UPDATE runs SET status = ?, outputs = ?, draws = ?, outcome = ?, reason = ?, wall_s = ?, cpu_s = ?, "
                "host = ?, started = coalesce(?, started), attempts = ?, ended = ? WHERE key = ?",
                (result["status"], texts["outputs"], texts["draws"], *plain, result.get("attempts", 1), utc_now(), key),
            )
            self._database.execute(f"{_SIGN} WHERE key = ?", (key,))

    def forget_tries(self, keys: Iterable[str]) -> None:
        """Count failed runs as never tried, so that the next campaign tries them whatever its retry_count."""
        with self._transaction():
            self._database.executemany("UPDATE runs SET attempts = 0 WHERE key = ?", [(key,) for key in keys])

    def find(self, keys: Iterable[str]) -> dict[str, Record]:
        """The runs with these keys that have ended, by key; a warning names those whose row was changed since."""
        query = f"SELECT {', '.join((*COLUMNS, CHECKSUM))} FROM runs WHERE key = ? AND status IN (?, ?)"
        with reading_ledger(self.path):
            # SQLite bounds the number of values of a query, and a design may have a million keys.
            rows = (row for key in sorted(set(keys)) for row in self._database.execute(query, (key, *ENDED)))
            return {record.key: record for record in intact_records(self.path, rows)}

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        """Change the file, or leave it as it was.

        Raises OSError when the disk is full or does not answer, ValueError when the file is damaged.
        """
        try:
            with self._database:
                self._database.execute("BEGIN IMMEDIATE")
                yield
        except sqlite3.OperationalError as error:
            raise OSError(
                f"{self.path} cannot be written ({error}); every run that had ended before is kept: make room on the "
                "disk, or end what holds the file, and give the same command again"
            ) from error
        except sqlite3.DatabaseError as error:
            raise ValueError(f"{self.path} cannot be used as a ledger ({error}); {LEFT}") from error

    def close(self) -> None:
        """Close the file."""
        self._open.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()
