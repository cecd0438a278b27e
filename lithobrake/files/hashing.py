"""Hashes of files, JSON values and source code, by which a study knows its files and runs again."""

import hashlib
import json
from pathlib import Path
from typing import Any


def content_hash(path: Path) -> str:
    """Hash of a file's bytes."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def json_hash(value: Any) -> str:
    """Hash of a JSON value; the order of keys does not matter."""
    return hashlib.sha256(json.dumps(value, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def hashed_seed(*values: Any) -> int:
    """Seed of random numbers from JSON values: another one for any other values."""
    return int(json_hash(list(values))[:12], 16)


def source_hash(*parts: str) -> str:
    """Hash of the sources of parts or files of the package: results of other code are other results.

    Raises ValueError for a part that there is not: its code would be left out of the hash unseen.
    """
    package = Path(__file__).parents[1]
    roots = [package / part for part in dict.fromkeys(parts)]
    if lacking := [str(root) for root in roots if not root.exists()]:
        raise ValueError(f"{', '.join(lacking)} cannot be hashed; allowed: folders and files of the package")
    digest = hashlib.sha256()
    for source in sorted(path for root in roots for path in ([root] if root.is_file() else root.rglob("*.py"))):
        digest.update(str(source.relative_to(package)).encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()[:16]
