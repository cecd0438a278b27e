"""The folder of a study, and which of its files are still good.

A file is current while the key of all that it was made from is the one that the study has now, and its content is what
was made (keys.json). So a deleted, damaged or edited file is made again, and a changed study makes again what depends
on the change, and nothing else.
"""

import hashlib
import json
import os
from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

from lithobrake.files.atomic import atomic_path, locked
from lithobrake.files.hashing import content_hash
from lithobrake.files.reading import DamagedFileError, read_json
from lithobrake.pipeline.folder.notes import Notes
from lithobrake.results.intact import LOCK

# Files are looked at before they are read, so this is said where one changed within the moment between.
AGAIN = "give the same command again to remake it"


class FileState(StrEnum):
    """How a file stands to what a study says now."""

    CURRENT = "current"
    MISSING = "not there"
    EARLIER = "of an earlier setting or version"
    CHANGED = "changed after it was made"
    FOREIGN = "not made by this study"
    # Of the stage at work, whose files are noted when all are there.
    NEW = "made by the stage at work"


def file_state(folder: Path, notes: Notes, name: str, key: str) -> FileState:
    """Say how a file stands to the key of all that it should have been made from."""
    if not (folder / name).is_file():
        return FileState.MISSING
    if name not in notes.files:
        return FileState.FOREIGN
    if notes.files[name]["key"] != key:
        return FileState.EARLIER
    return FileState.CURRENT if notes.files[name]["sha256"] == content_hash(folder / name) else FileState.CHANGED


class StudyFolder:
    """Files of one study by name, as `folder / "beds/bed_0.h5"`."""

    def __init__(self, path: Path, remedy: str = "choose another folder with --out") -> None:
        """Open or create the folder. Raises ValueError, with the remedy, when it cannot be written."""
        self.path = path
        try:
            path.mkdir(parents=True, exist_ok=True)
            # Of a name that nothing else has, if it gets one at all.
            with TemporaryFile(dir=path):
                pass
        except OSError as error:
            raise ValueError(f"{path} cannot be written ({error}); {remedy}") from error

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

    def begin(
        self, study: Path | None, content: bytes, stages: dict[str, dict[str, Any]], say: Callable[[str], None]
    ) -> None:
        """Note which study runs now, with its stages as `pipeline.stages.setting` gives them, and keep its content.

        study: its file, None where it has none.
        """
        try:
            notes = Notes.read(self.path, "so its files are made again")
        except DamagedFileError as error:
            say(f"{error}.")
            notes = Notes()
        place = _path_from(self.path, study) if study else ""
        notes.of_setting({"file": place, "sha256": hashlib.sha256(content).hexdigest()}, stages).write(self.path)
        with atomic_path(self / "study.toml") as draft:
            draft.write_bytes(content)

    def is_current(self, files: Iterable[str], key: str) -> bool:
        """Whether all these files exist, are whole, and were made from what the key names."""
        notes = Notes.read(self.path)
        return all(file_state(self.path, notes, name, key) is FileState.CURRENT for name in files)

    def key_of(self, name: str) -> str | None:
        """The key of what a file was made from; None where it is not there, not whole, or nobody made it."""
        notes = Notes.read(self.path)
        key: str | None = notes.files[name]["key"] if name in notes.files else None
        whole = key is not None and file_state(self.path, notes, name, key) is FileState.CURRENT
        return key if whole else None

    def note(self, stage: str, files: Iterable[str], key: str, wall_s: float) -> None:
        """Remember that a stage has made these files from what the key names, and how long it took [s]."""
        notes = Notes.read(self.path)
        made = {name: {"key": key, "sha256": content_hash(self / name)} for name in files}
        times = notes.wall_s | {stage: round(wall_s, 3)}
        replace(notes, files=notes.files | made, wall_s=times).write(self.path)

    def note_runs(self, design: str, keys: list[str]) -> None:
        """Remember which runs a design asks for, so that they can be told from those of earlier settings."""
        notes = Notes.read(self.path)
        if notes.designs.get(design) != keys:
            replace(notes, designs=notes.designs | {design: keys}).write(self.path)

    def note_rare(self, name: str, keys: list[str]) -> None:
        """Remember which landings a rare limit state asks for, which no design of the study does."""
        notes = Notes.read(self.path)
        if notes.rare.get(name) != keys:
            replace(notes, rare=notes.rare | {name: keys}).write(self.path)

    def wall_times(self) -> dict[str, float]:
        """Wall time of each stage when its files were made [s]."""
        return dict(Notes.read(self.path).wall_s)

    def write_json(self, name: str, content: Mapping[str, Any]) -> None:
        """Write a JSON file, whole or not at all. Raises ValueError for NaN and infinity, which JSON does not have."""
        with atomic_path(self / name) as draft:
            draft.write_text(json.dumps(content, indent=2, allow_nan=False) + "\n", encoding="utf-8")

    def read_json(self, name: str) -> dict[str, Any]:
        """Read a JSON file of the folder. Raises ValueError for one that holds no JSON object."""
        content: dict[str, Any] = read_json(self / name, dict, AGAIN)
        return content


def _path_from(folder: Path, file: Path) -> str:
    """The path of a file counted from a folder, links followed."""
    target = file.resolve()
    try:
        return os.path.relpath(target, folder.resolve())
    except ValueError:
        # On Windows nothing leads from one drive to another.
        return str(target)
