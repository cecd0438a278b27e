"""What has been computed once for this machine and user, kept on disk and signed."""

import hmac
import logging
import os
import re
import secrets
import stat
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from functools import cached_property
from pathlib import Path

from lithobrake.files.atomic import atomic_path
from lithobrake.files.reading import open_regular
from lithobrake.vocabulary.constants import DAY

PLACE = Path(".local", "state", "lithobrake", "cache.key")
_LENGTH = 32
_OPEN_TO_OTHERS = 0o077
log = logging.getLogger(__name__)
_SIGNATURE_LENGTH = 32
_LOCK = "lock"
_WRITABLE_BY_OTHERS = 0o022
# What is kept within a limit is named by hashes, and a draft of it as `atomic_path` names that.
_REMOVABLE = re.compile(r"[0-9a-f]{64}|\.[0-9a-f]{64}\.\d+\.part")
_REMEDY = "set LITHOBRAKE_CACHE to a folder that is yours alone"
# A draft that is older [s] was left behind by a process that was killed while it wrote.
_ABANDONED = DAY


def user_key() -> bytes:
    """The key of this user, which is made where there is none.

    Raises OSError or RuntimeError where this user has no home that can be written, ValueError for a key file that is
    damaged, or that others may read.
    """
    home = Path.home()
    if not home.is_absolute():
        raise ValueError(f"HOME is {str(home)!r}; allowed: an absolute path")
    path = home / PLACE
    if not path.exists():
        _make(path)
    with open_regular(path) as file:
        # One byte more than a key has, so that a longer file is noticed.
        status, key = os.fstat(file.fileno()), file.read(_LENGTH + 1)
    if os.name == "posix" and (status.st_uid != os.geteuid() or status.st_mode & _OPEN_TO_OTHERS):
        raise ValueError(f"{path} can be read by others; delete it, and another key is made")
    if len(key) != _LENGTH:
        raise ValueError(f"{path} has {len(key)} bytes for {_LENGTH}; delete it, and another key is made")
    return key


def _make(path: Path) -> None:
    """Write a key of random bytes, for this user alone; of processes that do so at once the first one's stays."""
    path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
    draft = path.with_name(f".{path.name}.{os.getpid()}.{secrets.token_hex(4)}.part")
    try:
        with open(draft, "xb", opener=lambda path, flags: os.open(path, flags, mode=0o600)) as file:
            file.write(secrets.token_bytes(_LENGTH))
            file.flush()
            os.fsync(file.fileno())
        # A link is made whole or not at all, and takes no name that another process has taken meanwhile.
        os.link(draft, path)
    except FileExistsError:
        return
    finally:
        draft.unlink(missing_ok=True)


class DiskCache:
    """Files in a folder of their own, below LITHOBRAKE_CACHE, XDG_CACHE_HOME or ~/.cache.

    Nothing here raises an error: what cannot be read or kept is made anew, and a warning says why, once.
    """

    def __init__(
        self, name: str, holds: str = "compiled kernels and gravity tables", limit: int | None = None
    ) -> None:  # fmt: skip
        """Take the folder of this name, which is made when it is first needed.

        holds: in words. limit: most bytes that are kept, those of the files that were last read or written; None: all.
        With a limit the names of files are SHA-256 in hexadecimal digits: nothing else is counted or removed.
        """
        self._holds, self._limit = holds, limit
        self._name, self._key = name, b""
        self._told, self._waited, self._thread = False, False, threading.Lock()

    @cached_property
    def folder(self) -> Path | None:
        """The folder, or None where there is none to be trusted."""
        try:
            root = _root()
            root.mkdir(mode=0o700, parents=True, exist_ok=True)
            folder = root / "lithobrake" / self._name
            for path in (root, folder.parent, folder):
                path.mkdir(mode=0o700, exist_ok=True)
                if not (_is_ours if path == folder else _is_held)(path.stat()):
                    self._do_without(f"{path} belongs to another user or can be written by others")
                    return None
        # A RuntimeError where this user has no home.
        except (OSError, RuntimeError, ValueError) as error:
            self._do_without(f"no folder for a cache can be made ({error})")
            return None
        try:
            self._key = user_key()
        except (OSError, RuntimeError, ValueError) as error:
            self._do_without(f"there is no key to sign files with ({error})", "set HOME to a folder that is yours")
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
            with open_regular(path) as file:
                # Asked of the open file: what has this name may change meanwhile.
                told = os.fstat(file.fileno())
                # In two pieces, as a gravity table is too large to be copied on the way.
                content, signature = file.read(max(told.st_size - _SIGNATURE_LENGTH, 0)), file.read()
        except FileNotFoundError:
            return None
        except (OSError, ValueError) as error:
            reason = error.strerror if isinstance(error, OSError) else "it is no regular file"
            log.warning("%s cannot be read (%s): it is made again.", path, reason)
            return None
        ours = _is_ours(told)
        if ours and hmac.compare_digest(signature, self._signature(name, content)):
            self._note_use(path)
            return content
        reason = "is damaged, or was not written with this user's key" if ours else "may be another user's work"
        log.warning("%s %s: it is made again.", path, reason)
        return None

    def write(self, name: str, content: bytes) -> None:
        """Keep a file, for this user alone, where that is possible."""
        if self.folder is None:
            return
        if not self.keeps:
            self._do_without(f"{self.folder} cannot be written")
            return
        # What does not fit would drive all else out, and then go itself.
        if self._limit is not None and len(content) + _SIGNATURE_LENGTH > self._limit:
            return
        try:
            with (
                atomic_path(self.folder / name) as draft,
                open(draft, "wb", opener=lambda path, flags: os.open(path, flags, mode=0o600)) as file,
            ):
                file.write(content)
                file.write(self._signature(name, content))
            self._make_room()
        except (OSError, ValueError) as error:
            # A folder in the place of one file is no reason to keep no other.
            self.keeps = isinstance(error, ValueError)
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
            # The folder may be one of the user's that happens to have this name.
            if not _REMOVABLE.fullmatch(path.name):
                continue
            # Another process may make room at the same time.
            with suppress(FileNotFoundError):
                status = path.lstat()
                drafted = path.name.startswith(".") and now - status.st_mtime < _ABANDONED
                if not drafted and stat.S_ISREG(status.st_mode):
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

    def _signature(self, name: str, content: bytes) -> bytes:
        # With its name: a whole file in the place of another is wrong too.
        signature = hmac.new(self._key, name.encode() + b"\0", "sha256")
        signature.update(content)
        return signature.digest()

    def _do_without(self, reason: str, remedy: str = _REMEDY) -> None:
        """Say once that nothing is kept, and why."""
        if not self._told:
            self._told = True
            log.warning("%s, so %s are made anew each time; %s.", reason, self._holds, remedy)


def _root() -> Path:
    """The folder below which caches lie. Raises ValueError for one that is counted from the current folder.

    A folder that was unpacked or cloned could bring a cache of its own.
    """
    given = os.environ.get("LITHOBRAKE_CACHE")
    if given and not Path(given).expanduser().is_absolute():
        raise ValueError(f"LITHOBRAKE_CACHE is {given!r}; allowed: an absolute path")
    # The XDG base directory specification: a relative path is to be ignored.
    for path in filter(None, (given, os.environ.get("XDG_CACHE_HOME"), "~/.cache")):
        if (root := Path(path).expanduser()).is_absolute():
            return root
    raise ValueError(f"HOME is {os.environ.get('HOME')!r}; allowed: an absolute path")


def _is_ours(status: os.stat_result) -> bool:
    """Whether a file or folder is this user's and nobody else may write it; where there are no such modes it is."""
    return os.name != "posix" or (status.st_uid == os.geteuid() and not status.st_mode & _WRITABLE_BY_OTHERS)


def _is_held(status: os.stat_result) -> bool:
    """Whether nobody but this user and root can put another folder in the place of one of this user's in a folder."""
    if os.name != "posix":
        return True
    # In a sticky folder, as /tmp is, each may remove only what is theirs.
    closed = not status.st_mode & _WRITABLE_BY_OTHERS or status.st_mode & stat.S_ISVTX
    return status.st_uid in (os.geteuid(), 0) and bool(closed)
