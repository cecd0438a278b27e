"""Whose folder is it? A study writes into a new folder, an empty one, or its own, and into no other."""

import shlex
from pathlib import Path

from lithobrake.files.reading import DamagedFileError
from lithobrake.pipeline.folder.notes import NAME, Notes
from lithobrake.pipeline.folder.study_folder import LOCK
from lithobrake.study import StudySource

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
    owner, copy = _noted_study(out), out / "study.toml"
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
