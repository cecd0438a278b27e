"""Whose the folder of a study is, and how its files stand to each other; nothing is written here."""

import os
import shlex
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from lithobrake.files.reading import DamagedFileError, content_hash
from lithobrake.pipeline.study_folder import LOCK, NAME, FileState, Notes, file_state
from lithobrake.study import StudySource
from lithobrake.vocabulary.study_files import STUDY_FILE


@dataclass(frozen=True)
class StageState:
    """A stage and the state of its files by name; number: its place, from 1 (0: the copy of the study file)."""

    number: int
    name: str
    title: str
    files: dict[str, FileState]

    @property
    def is_current(self) -> bool:
        """Tell whether all its files are there, whole, and of the present setting."""
        return set(self.files.values()) <= {FileState.CURRENT}


@dataclass(frozen=True)
class FolderState:
    """The files of a folder by stage, in order, the copy of the study file first; stages without files are left out.

    unknown: why nothing can be told of them, else empty. command: what brings the folder up to date. edited: the study
    file, where it is another than when it last ran.
    """

    notes: Notes
    stages: list[StageState]
    unknown: str
    command: str
    edited: Path | None


def read_state(path: Path) -> FolderState:
    """Look at every file of a study's folder. Raises ValueError for a damaged keys.json, or one of a later format."""
    notes = Notes.read(path)
    study = notes.study_path(path)
    command = _command(path, study)
    if not notes.stages:
        reason = "is of an earlier format" if notes.files else "is not there"
        unknown = f"{path / NAME} {reason}, so it is unknown which files belong together; restore it with: {command}"
        return FolderState(notes, [], unknown, command, None)
    stages = [StageState(0, "", "study file", {STUDY_FILE: _state_of_copy(path, notes.study["sha256"])})]
    writing = {name: stage for name, stage in notes.stages.items() if stage["files"]}
    for number, (name, stage) in enumerate(writing.items(), start=1):
        files = {file: file_state(path, notes, file, stage["key"]) for file in stage["files"]}
        stages.append(StageState(number, name, stage["title"], files))
    edited = study if study and _differs(study, notes.study["sha256"]) else None
    return FolderState(notes, stages, "", command, edited)


def report_page(path: Path) -> tuple[Path, str]:
    """Return the page of a study's report, and a sentence if it may not match the files beside it, else "".

    Raises ValueError when there is no report.
    """
    page, state = (path / "report" / "index.html").resolve(), read_state(path)
    if not page.is_file():
        raise ValueError(f"{path} has no report; make it with: {state.command}")
    wrong = grouped(state.stages)
    if wrong:
        words = f"The report does not match the files of the study ({wrong}); make it again with:"
        return page, f"{words} {state.command}"
    if state.edited:
        return page, f"{state.edited} was edited after this report was made; bring it up to date with: {state.command}"
    return page, state.unknown


def grouped(stages: list[StageState]) -> str:
    """What is the matter with the files of these stages, in words; files that are current are left out."""
    found: dict[FileState, list[str]] = {}
    for stage in stages:
        for file, state in stage.files.items():
            if state is not FileState.CURRENT:
                found.setdefault(state, []).append(file)
    return "; ".join(f"{state}: {', '.join(files)}" for state, files in found.items())


def _state_of_copy(path: Path, sha256: str) -> FileState:
    copy = path / STUDY_FILE
    if not copy.is_file():
        return FileState.MISSING
    return FileState.CHANGED if _differs(copy, sha256) else FileState.CURRENT


def _differs(file: Path, sha256: str) -> bool:
    """Tell whether a file has other bytes; one that cannot be read, or has no end, does not tell."""
    # Whoever may look at a folder may not be allowed to see the study file, or be on another machine.
    with suppress(OSError):
        return file.is_file() and content_hash(file) != sha256
    return False


def _command(path: Path, study: Path | None) -> str:
    """The command that makes the files of a folder again."""
    if study is None or not os.path.isfile(study):
        return f"lithobrake run STUDY.toml --out {shlex.quote(str(path))}"
    inside = study.is_relative_to(Path.cwd())
    shown = os.path.relpath(study) if inside else str(study)
    return f"lithobrake run {shlex.quote(shown)} --out {shlex.quote(str(path))}"


_ANOTHER = "choose another folder with --out"


def refuse_others_folder(source: StudySource, out: Path) -> None:
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
