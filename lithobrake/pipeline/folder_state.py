"""How the files of a study's folder stand to each other, for whoever reads them: nothing is written here."""

import os
import shlex
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from lithobrake.files.reading import content_hash
from lithobrake.pipeline.study_folder import NAME, FileState, Notes, file_state
from lithobrake.vocabulary.file_names import STUDY_FILE


@dataclass(frozen=True)
class StageState:
    """A stage and the state of its files by name; number: its place, from 1 (0: the copy of the study file)."""

    number: int
    name: str
    title: str
    files: dict[str, FileState]

    @property
    def is_current(self) -> bool:
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
    # Noted keys are compared and not computed again, which would need the study file, its meshes and a second.
    notes = Notes.read(path)
    study = notes.study_path(path)
    command = _command(path, study)
    if not notes.stages:
        reason = "is of an earlier format" if notes.files else "is not there"
        unknown = f"{path / NAME} {reason}, so it is unknown which files belong together; restore it with: {command}"
        return FolderState(notes, [], unknown, command, None)
    # The copy of the study file is part of the folder: the report and the inference read it.
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
    if study is None or not os.path.isfile(study):
        return f"lithobrake run STUDY.toml --out {shlex.quote(str(path))}"
    inside = study.is_relative_to(Path.cwd())
    shown = os.path.relpath(study) if inside else str(study)
    return f"lithobrake run {shlex.quote(shown)} --out {shlex.quote(str(path))}"
