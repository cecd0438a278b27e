"""Files that nothing can spoil: written whole or not at all, and by one process at a time."""

import csv
import errno
import json
import os
import platform
import stat
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from io import FileIO
from pathlib import Path
from tempfile import TemporaryFile
from typing import Any

from lithobrake.files.reading import parsed, reading

# A reader of a lock holds it for microseconds; only a coordinator holds it for longer than this [s].
_PATIENCE, _PAUSE = 0.5, 0.02
_NOTE_LENGTH, _NOTE = 1024, {"process": int, "host": str}


@contextmanager
def atomic_path(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path beside `path`; on success it is flushed to disk and renamed onto `path`, else removed.

    Raises ValueError where `path` is a folder, or in none.
    """
    final = Path(path)
    if final.is_dir():
        raise ValueError(f"{final} is a folder; name a file")
    refuse_no_folder(final)
    draft = final.with_name(f".{final.name}.{os.getpid()}.part")
    try:
        yield draft
        with open(draft, "rb+") as file:
            os.fsync(file.fileno())
        os.replace(draft, final)
    finally:
        draft.unlink(missing_ok=True)


def write_whole(path: str | os.PathLike[str], content: str | bytes, encoding: str = "utf-8") -> None:
    """Write a file, whole or not at all."""
    with atomic_path(path) as draft:
        draft.write_bytes(content if isinstance(content, bytes) else content.encode(encoding))


def write_json(path: str | os.PathLike[str], content: Any, indent: int | None = 2) -> None:
    """Write a JSON file, whole or not at all. Raises ValueError for NaN and infinity, which JSON does not have."""
    write_whole(path, json.dumps(content, indent=indent, allow_nan=False) + "\n")


def write_rows(path: str | os.PathLike[str], titles: Iterable[str], rows: Iterable[Iterable[Any]]) -> None:
    """Write a CSV file, whole or not at all."""
    with atomic_path(path) as draft, draft.open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(titles)
        table.writerows(rows)


def refuse_existing(paths: Iterable[Path], remedy: str) -> None:
    """Raise ValueError, with the remedy, where files of these names are there: they may be anyone's."""
    there = [path for path in paths if os.path.lexists(path)]
    if there:
        more = f" and {len(there) - 1} more of what would be written" if len(there) > 1 else ""
        raise ValueError(f"{there[0]} exists{more}; {remedy}")


def refuse_no_folder(path: Path) -> None:
    """Raise ValueError for a file whose folder is not there."""
    if not path.parent.is_dir():
        raise ValueError(f"{path} cannot be written (there is no folder {path.parent}); make it, or choose another")


def make_folder(path: Path, remedy: str = "choose another folder with --out") -> None:
    """Make a folder where there is none.

    Raises ValueError, with the remedy, where that cannot be, or no file can be made in it.
    """
    if path.exists() and not path.is_dir():
        raise ValueError(f"{path} is no folder and cannot become one; {remedy}")
    try:
        path.mkdir(parents=True, exist_ok=True)
        # Of a name that nothing else has, if it gets one at all.
        with TemporaryFile(dir=path):
            pass
    except OSError as error:
        raise ValueError(f"{path} cannot be written ({error}); {remedy}") from error


@contextmanager
def locked(path: str | os.PathLike[str], refusal: str) -> Iterator[Callable[..., None]]:
    """Hold a lock file while no other process does; the lock goes with the process, however it ends.

    Gives a function that notes what is being done, for `lock_holder` to read. Raises ValueError with the refusal, and
    who is at work, when another process holds the lock, and for a file of this name that is no lock.
    """
    if os.name != "posix":
        yield lambda **what: None
        return
    import fcntl

    with _opened(path) as lock:
        limit = time.monotonic() + _PATIENCE
        while not _taken(lock.fileno(), fcntl.LOCK_EX):
            if time.monotonic() > limit:
                holder = _noted(Path(path))
                who = f" (process {holder['process']} on {holder['host']})" if holder else ""
                raise ValueError(refusal.format(who=who))
            time.sleep(_PAUSE)

        def note(**what: Any) -> None:
            content = {"process": os.getpid(), "host": platform.node(), **what}
            # One write of one length: a reader sees the old note or the new one.
            os.pwrite(lock.fileno(), json.dumps(content).ljust(_NOTE_LENGTH).encode(), 0)

        note()
        yield note


@contextmanager
def _opened(path: str | os.PathLike[str]) -> Iterator[FileIO]:
    """Open a lock file, or make one. Raises ValueError for what is none: notes would be written over it."""
    flags = os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK
    remedy = "move it away, or choose another folder"
    try:
        lock = FileIO(path, "r+", opener=lambda path, _: os.open(path, flags, mode=0o666))
    except OSError as error:
        if error.errno in (errno.ELOOP, errno.EISDIR, errno.ENXIO):
            raise ValueError(f"{path} is a link, a folder or a pipe, and no lock of lithobrake; {remedy}") from error
        raise
    with lock:
        status = os.fstat(lock.fileno())
        # A note that names a long host is longer than most, but not by much.
        if not stat.S_ISREG(status.st_mode) or status.st_size > 4 * _NOTE_LENGTH or not _is_note(lock.readall()):
            raise ValueError(f"{path} is no lock of lithobrake; {remedy}")
        yield lock


def _is_note(content: bytes) -> bool:
    """Whether a file that begins so is a lock: it is empty, or of a process and its host."""
    # After a power cut a file may have its length and none of its bytes.
    text = content.strip(b"\0 \n")
    try:
        return not text or bool(parsed(text, _NOTE))
    except (ValueError, RecursionError):
        return False


def lock_holder(path: str | os.PathLike[str]) -> dict[str, Any] | None:
    """What the process that holds a lock file has noted, its number and host included; None when nobody holds it."""
    if os.name != "posix" or not Path(path).is_file():
        return None
    import fcntl

    with open(path, "rb") as lock:
        return None if _taken(lock.fileno(), fcntl.LOCK_SH) else _noted(Path(path))


def _taken(file: int, kind: int) -> bool:
    import fcntl

    try:
        fcntl.flock(file, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _noted(path: Path) -> dict[str, Any]:
    with reading(path, "what is at work notes it anew at its next stage"):
        text = path.read_text(encoding="utf-8").strip()
        note: dict[str, Any] = parsed(text, _NOTE) if text else {}
    return note
