"""The folder of a study, and which of its files are still good.

Beside the files stands `keys.json`. For each file it has the key of all that the file was made from, and the hash of
its content; a file is current while both still hold. So a deleted, damaged or edited file is made again, and a changed
study makes again what depends on the change, and nothing else.
"""

import hashlib
import json
from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from lithobrake.atomic import atomic_path, locked

FORMAT_VERSION = 1
LOCK = ".lock"


class StudyFolder:
    """Files of one study by name, as `folder / "beds/bed_0.h5"`."""

    def __init__(self, path: Path) -> None:
        """Open or create the folder. Raises ValueError when it cannot be written."""
        self.path = path
        try:
            (path / "beds").mkdir(parents=True, exist_ok=True)
            probe = path / ".writable"
            probe.touch()
            probe.unlink()
        except OSError as error:
            raise ValueError(f"{path} cannot be written ({error}); choose another folder with --out") from error

    @classmethod
    def only_read(cls, path: Path) -> "StudyFolder":
        """A folder in which nothing is made or written; it need not be there."""
        folder = cls.__new__(cls)
        folder.path = path
        return folder

    def alone(self) -> AbstractContextManager[Callable[..., None]]:
        """Work in the folder while nobody else does, and note at what. Raises ValueError when another process does."""
        refusal = (
            f"another lithobrake is at work in {self.path}{{who}}; wait for it, or choose another folder with --out"
        )
        return locked(self / LOCK, refusal)

    def __truediv__(self, name: str) -> Path:
        """Path of a file in the folder."""
        return self.path / name

    def is_current(self, files: Iterable[str], key: str) -> bool:
        """Tell whether all these files stand, are whole, and were made from what the key names."""
        notes = self._notes()["files"]
        return all(
            notes.get(name, {}).get("key") == key
            and (self / name).is_file()
            and notes[name]["sha256"] == content_hash(self / name)
            for name in files
        )

    def note(self, stage: str, files: Iterable[str], key: str, wall_s: float) -> None:
        """Remember that a stage has made these files from what the key names, and how long it took [s]."""
        notes = self._notes()
        notes["files"] |= {name: {"key": key, "sha256": content_hash(self / name)} for name in files}
        notes["wall_s"][stage] = round(wall_s, 3)
        self.write_json("keys.json", notes)

    def wall_times(self) -> dict[str, float]:
        """Wall time of each stage when its files were made [s]."""
        return dict(self._notes()["wall_s"])

    def write_json(self, name: str, content: Mapping[str, Any]) -> None:
        """Write a JSON file, whole or not at all. Raises ValueError for NaN and infinity, which JSON does not have."""
        with atomic_path(self / name) as draft:
            draft.write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8")

    def read_json(self, name: str) -> dict[str, Any]:
        """Read a JSON file of the folder."""
        content: dict[str, Any] = json.loads((self / name).read_text(encoding="utf-8"))
        return content

    def _notes(self) -> dict[str, Any]:
        fresh = {"format_version": FORMAT_VERSION, "files": {}, "wall_s": {}}
        if not (self / "keys.json").is_file():
            return fresh
        notes = self.read_json("keys.json")
        return notes if notes.get("format_version") == FORMAT_VERSION else fresh


def content_hash(path: Path) -> str:
    """Hash of a file's bytes."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def json_hash(value: Any) -> str:
    """Hash of a JSON value; the order of keys does not matter."""
    return hashlib.sha256(json.dumps(value, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def source_hash(*parts: str) -> str:
    """Hash of the sources of parts or files of the package: results of other code are other results."""
    package = Path(__file__).parents[1]
    roots = [package / part for part in parts]
    digest = hashlib.sha256()
    for source in sorted(path for root in roots for path in ([root] if root.is_file() else root.rglob("*.py"))):
        digest.update(str(source.relative_to(package)).encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()[:16]
