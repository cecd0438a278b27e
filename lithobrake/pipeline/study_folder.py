"""The folder of a study, which of its files are still good, and keys.json, its notes about itself."""

import hashlib
import os
import shlex
from collections.abc import Callable, Iterable, Mapping
from contextlib import AbstractContextManager
from dataclasses import asdict, dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lithobrake.files.atomic import locked, make_folder, write_json, write_whole
from lithobrake.files.reading import NUMBER, DamagedFileError, check, content_hash, read_json, reading
from lithobrake.results.study_files import KEYS, LOCK, folder_of_paths, intact_file
from lithobrake.vocabulary.file_names import STUDY_FILE

if TYPE_CHECKING:
    from lithobrake.study import StudySource

NAME = KEYS
_ANOTHER = "choose another folder with --out"
FORMAT_VERSION = 2
REMEDY = "make the files of this folder again with: lithobrake run STUDY.toml --out DIR"
_FORM = {
    "study": {"file": str, "sha256": str},
    "stages": {str: {"title": str, "key": str, "files": [str]}},
    "files": {str: {"key": str, "sha256": str}},
    "designs": {str: [str]},
    "rare": {str: [str]},
    "wall_s": {str: NUMBER},
}
# Format 1 had files and wall_s alone.
_ABSENT: dict[str, Any] = {name: {} for name in _FORM} | {"study": {"file": "", "sha256": ""}}
# The stage whose key says whether a design is still what the study asks for.
_STAGE_OF_DESIGN = {
    "screening": "screening_runs", "refined": "refined_runs", "test_kept": "test_runs", "test_all": "test_runs",
    "drawn": "runs", "soil_pairs": "side_runs", "twins": "side_runs",
}  # fmt: skip
# Files are looked at before they are read, so this is said where one changed within the moment between.
AGAIN = "give the same command again to remake it"


@dataclass(frozen=True)
class Notes:
    """The tables of keys.json, empty where it has none."""

    study: dict[str, str] = field(default_factory=lambda: dict(_ABSENT["study"]))
    stages: dict[str, dict[str, Any]] = field(default_factory=dict)
    files: dict[str, dict[str, str]] = field(default_factory=dict)
    designs: dict[str, list[str]] = field(default_factory=dict)
    rare: dict[str, list[str]] = field(default_factory=dict)
    wall_s: dict[str, float] = field(default_factory=dict)

    @classmethod
    def read(cls, folder: Path, remedy: str = REMEDY) -> "Notes":
        """Read those of a folder, or none where there is no file.

        Raises DamagedFileError, with the remedy, for a damaged file, ValueError for one of another format.
        """
        path = folder / NAME
        if not path.exists():
            return cls()
        content = read_json(path, {"format_version": int}, remedy)
        version = content["format_version"]
        if not 1 <= version <= FORMAT_VERSION:
            raise ValueError(
                f"{path} has format {version}; this version reads 1 to {FORMAT_VERSION}: use the version of lithobrake "
                "that made this folder, or another folder"
            )
        with reading(path, remedy):
            tables = {name: content.get(name, absent) for name, absent in _ABSENT.items()}
            check(tables, _FORM)
            if tables["stages"]:
                check(tables["stages"], {"bed": dict}, "stages")
        return cls(**tables)

    def write(self, folder: Path) -> None:
        """Write them to a folder, whole or not at all."""
        write_json(folder / NAME, {"format_version": FORMAT_VERSION, **asdict(self)})

    def of_setting(self, study: dict[str, str], stages: dict[str, dict[str, Any]]) -> "Notes":
        """The same for a study that is to run now: designs that it no longer asks for like that are left out."""
        # Runs of a stage that has changed are others; their keys would count as asked for until the stage is made.
        same = {name for name, stage in stages.items() if self.stages.get(name) == stage}
        kept = [design for design, stage in _STAGE_OF_DESIGN.items() if stage in same]
        designs = {design: self.designs[design] for design in kept if design in self.designs}
        return replace(self, study=study, stages=stages, designs=designs)

    def study_path(self, folder: Path) -> Path | None:
        """Where the study file of a folder was when it last ran; None where that is not noted."""
        # A folder and its study file that move together, or to another machine, stay together.
        return Path(os.path.normpath(folder.resolve() / self.study["file"])) if self.study["file"] else None


class FileState(StrEnum):
    CURRENT = "current"
    MISSING = "not there"
    EARLIER = "of an earlier setting or version"
    CHANGED = "changed after it was made"
    FOREIGN = "not noted as made by this study, as after a stage that did not end"
    # Of the stage at work, whose files are noted when all are there.
    NEW = "made by the stage at work"


def file_state(folder: Path, notes: Notes, name: str, key: str) -> FileState:
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
        make_folder(path, remedy)

    @classmethod
    def only_read(cls, path: Path) -> "StudyFolder":
        """A folder in which nothing is made or written; it need not be there."""
        folder = cls.__new__(cls)
        folder.path = path
        return folder

    def source(self) -> "StudySource":
        """The study of the folder, as its copy has it; paths count from where the study file was.

        Raises ValueError for a copy that was edited since, and StudyError for one that is refused.
        """
        from lithobrake.study import StudySource

        copy = intact_file(self.path, STUDY_FILE, REMEDY)
        return StudySource.read(copy, folder=folder_of_paths(self.path, REMEDY))

    def alone(self) -> AbstractContextManager[Callable[..., None]]:
        """Work in the folder while nobody else does, and note at what. Raises ValueError when another process does."""
        refusal = (
            f"another lithobrake is at work in {self.path}{{who}}; wait for it, or choose another folder with --out"
        )
        return locked(self / LOCK, refusal)

    def __truediv__(self, name: str) -> Path:
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
        write_whole(self / STUDY_FILE, content)

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
        write_json(self / name, content)

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


def refuse_others_folder(source: "StudySource", out: Path) -> None:
    """Raise ValueError, with what to do, unless a study file may have its files written into a folder.

    The folder is the study's own when it notes this study file, or has a copy of it with the same bytes. So a study is
    edited and run again where it was, and one that was moved or renamed takes its folder over once it is copied there.
    """
    study = source.path
    # A link is overwritten where it lies, and what it leads to where that lies.
    if study is not None and any(
        out.resolve() in path.parents for path in (study.resolve(), study.parent.resolve() / study.name)
    ):
        raise ValueError(
            f"{study} lies in {out}, where results would overwrite it and its neighbours; {_ANOTHER}, "
            f"such as --out {shlex.quote(str(Path('runs') / study.stem))}"
        )
    strangers = _visible(out)
    if not strangers:
        return
    if not any((out / name).is_file() for name in (NAME, LOCK)):
        more = f" and {len(strangers) - 3} more" if len(strangers) > 3 else ""
        raise ValueError(
            f"{out} holds {', '.join(strangers[:3])}{more}, and no study made it; {_ANOTHER}, one that is empty or "
            "does not exist"
        )
    owner, copy = _noted_study(out), out / STUDY_FILE
    if owner == (study and study.resolve()) or (copy.is_file() and copy.read_bytes() == source.content):
        return
    unknown = f"does not record which study it belongs to, and its study.toml is not that of {source.name}"
    whose = f"has the files of another study, {owner}" if owner else unknown
    if study is None:
        raise ValueError(f"{out} {whose}; {_ANOTHER}")
    raise ValueError(
        f"{out} {whose}; {_ANOTHER}, or, if they are one study that was moved, renamed or edited, copy {study} over "
        f"{copy} and give the same command again"
    )


class FinishedFolder(StudyFolder):
    """A folder whose files are read as results: one that changed after it was made is refused."""

    def __init__(self, path: Path) -> None:
        """Name the folder, in which nothing is made or written."""
        self.path = path

    def __truediv__(self, name: str) -> Path:
        return intact_file(self.path, name, REMEDY)


def _visible(folder: Path) -> list[str]:
    """What a folder holds, without the hidden files that systems and a study that had no time leave behind."""
    if not folder.is_dir():
        return []
    return sorted(path.name for path in folder.iterdir() if not path.name.startswith("."))


def _noted_study(folder: Path) -> Path | None:
    """The study file that a folder notes; None where it notes none that can be read, or has a study of tables."""
    try:
        noted = Notes.read(folder).study_path(folder)
    except DamagedFileError:
        # The user is told when the study begins; here only its own copy can still say whose the folder is.
        return None
    return noted.resolve() if noted else None
