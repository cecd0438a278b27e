"""Rows of a ledger, edited with a hash that fits: what a campaign of another version or machine may have written."""

import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

from lithobrake.campaign.record import CHECKSUM, HASHED, row_hash


def edit_rows(path: Path, change: str, values: tuple[Any, ...] = ()) -> None:
    """Make `UPDATE runs SET <change>`, and then the hash of each row again."""
    with closing(sqlite3.connect(path)) as database, database:
        database.create_function("row_hash", len(HASHED), row_hash)
        database.execute(f"UPDATE runs SET {change}", values)
        database.execute(f"UPDATE runs SET {CHECKSUM} = row_hash({', '.join(HASHED)})")
