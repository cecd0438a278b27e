"""The key of this user, with which what is kept on disk is signed.

It lies in the user's home, at a place that no variable of its own moves. So what comes with a study, an archive or a
repository can hold files that look like those of a cache, but none with this user's signature.
"""

import os
import secrets
from pathlib import Path

from lithobrake.files.reading import open_regular

PLACE = Path(".local", "state", "lithobrake", "cache.key")
_LENGTH = 32
_OPEN_TO_OTHERS = 0o077


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
