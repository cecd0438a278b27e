"""What has been computed once for this machine and user, kept on disk: compiled kernels, gravity tables and beds.

A kernel is kept as a pickle, which runs as code when it is read. So a file counts only where nobody but this user can
have written it: file and folder are this user's, and closed to writers. It ends with a hash of its name and content,
and one that is damaged is as good as none.
"""

import hashlib
import logging
import os
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import cached_property
from pathlib import Path

from lithobrake.atomic import atomic_path

log = logging.getLogger(__name__)

_DIGEST_LENGTH = 32
_LOCK = "lock"
_WRITABLE_BY_OTHERS = 0o022
_REMEDY = "set LITHOBRAKE_CACHE to a folder that is yours alone"
# A draft that is older [s] was left behind by a process that was killed while it wrote.
_ABANDONED = 86_400.0


class DiskCache:
    """Files in a folder of their own, below LITHOBRAKE_CACHE, XDG_CACHE_HOME or ~/.cache.

    Nothing here raises an error: what cannot be read or kept is made anew, and a warning says why, once.
    """

    def __init__(
        self, name: str, holds: str = "compiled kernels and gravity tables", limit: int | None = None
    ) -> None:  # fmt: skip
        """Take the folder of this name, which is made when it is first needed.

        holds: in words. limit: most bytes that are kept, those of the files that were last read or written; None: all.
        """
        self._holds, self._limit = holds, limit
        root = os.environ.get("LITHOBRAKE_CACHE") or os.environ.get("XDG_CACHE_HOME") or "~/.cache"
        self._path = Path(root) / "lithobrake" / name
        self._told, self._waited, self._thread = False, False, threading.Lock()

    @cached_property
    def folder(self) -> Path | None:
        """The folder, or None where there is none to be trusted."""
        try:
            folder = self._path.expanduser()
            folder.parent.parent.mkdir(parents=True, exist_ok=True)
            for path in (folder.parent, folder):
                path.mkdir(mode=0o700, exist_ok=True)
            if not _is_ours(folder.stat()):
                self._do_without(f"{folder} belongs to another user or can be written by others")
                return None
        # A RuntimeError where this user has no home.
        except (OSError, RuntimeError) as error:
            self._do_without(f"no folder for a cache can be made ({error})")
            return None
        return folder

    @cached_property
    def keeps(self) -> bool:
        """Whether files can be written, as far as can be told before."""
        return self.folder is not None and os.access(self.folder, os.W_OK)

    def read(self, name: str) -> bytes | None:
        """The content of a file; None where there is none that is whole and this user's."""
        if self.folder is None:
            return None
        path = self.folder / name
        try:
            with path.open("rb") as file:
                # Asked of the open file: what has this name may change meanwhile.
                ours, whole = _is_ours(os.fstat(file.fileno())), file.read()
        except FileNotFoundError:
            return None
        except OSError as error:
            log.warning("%s cannot be read (%s): it is made again.", path, error.strerror)
            return None
        content, digest = whole[:-_DIGEST_LENGTH], whole[-_DIGEST_LENGTH:]
        if ours and digest == _digest(name, content):
            self._note_use(path)
            return content
        log.warning("%s %s: it is made again.", path, "is damaged" if ours else "may be another user's work")
        return None

    def write(self, name: str, content: bytes) -> None:
        """Keep a file, for this user alone, where that is possible."""
        if self.folder is None:
            return
        if not self.keeps:
            self._do_without(f"{self.folder} cannot be written")
            return
        # What does not fit would drive all else out, and then go itself.
        if self._limit is not None and len(content) + _DIGEST_LENGTH > self._limit:
            return
        try:
            with (
                atomic_path(self.folder / name) as draft,
                open(draft, "wb", opener=lambda path, flags: os.open(path, flags, mode=0o600)) as file,
            ):
                file.write(content)
                file.write(_digest(name, content))
            self._make_room()
        except OSError as error:
            self.keeps = False
            self._do_without(f"{self.folder} cannot be written ({error})")

    def has(self, name: str) -> bool:
        """Whether there is such a file, whole or not."""
        return self.folder is not None and (self.folder / name).is_file()

    def _note_use(self, path: Path) -> None:
        """Set the time of a file to now, by which it is known how long it has not been used."""
        if self._limit is not None:
            # Where it may only be read, or is gone already, the order is that in which files were written.
            with suppress(OSError):
                os.utime(path)

    def _make_room(self) -> None:
        """Remove the files that were unused for longest, until the others keep within the limit."""
        if self._limit is None or self.folder is None:
            return
        found, now = [], time.time()
        for path in self.folder.iterdir():
            # Another process may make room at the same time.
            with suppress(FileNotFoundError):
                status = path.stat()
                drafted = path.name.startswith(".") and now - status.st_mtime < _ABANDONED
                if not drafted and not path.name.startswith(_LOCK):
                    found.append((status.st_mtime_ns, status.st_size, path))
        total = sum(size for _, size, _ in found)
        for _, size, path in sorted(found):
            if total <= self._limit:
                return
            path.unlink(missing_ok=True)
            total -= size

    @contextmanager
    def turn(self, meanwhile: str, which: str = "") -> Iterator[None]:
        """Wait until no other thread or process is in its turn; for a process say the sentence `meanwhile`, once.

        which: turns of other names do not wait for this one; each name leaves an empty file behind, so let them be few.
        The turn of a process that dies ends with it. Where nothing can be kept no process waits: there would be nothing
        to find.
        """
        with self._thread, ExitStack() as held:
            if os.name != "posix" or self.folder is None or not self.keeps:
                yield
                return
            import fcntl

            try:
                lock = held.enter_context(open(self.folder / f"{_LOCK}{which}", "a"))
                try:
                    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                except BlockingIOError:
                    if not self._waited:
                        log.warning(meanwhile)
                    self._waited = True
                    fcntl.flock(lock, fcntl.LOCK_EX)
            # Some file systems have no locks: the work is then done by each, as it would be without a cache.
            except OSError as error:
                log.info("%s cannot be locked (%s)", self.folder, error)
            yield

    def _do_without(self, reason: str) -> None:
        """Say once that nothing is kept, and why."""
        if not self._told:
            self._told = True
            log.warning("%s, so %s are made anew each time; %s.", reason, self._holds, _REMEDY)


def _is_ours(status: os.stat_result) -> bool:
    """Whether a file or folder is this user's and nobody else may write it; where there are no such modes it is."""
    return os.name != "posix" or (status.st_uid == os.geteuid() and not status.st_mode & _WRITABLE_BY_OTHERS)


def _digest(name: str, content: bytes) -> bytes:
    # With its name: a whole file in the place of another is wrong too.
    return hashlib.sha256(name.encode() + b"\0" + content).digest()
