"""A log that no program can make larger than a few megabytes: its beginning and its end are kept."""

import io
from pathlib import Path
from typing import Any

# Bytes kept of the beginning, and at least of the end; the end may be twice as long until its first half is dropped.
KEPT = 1 << 20


class CappedLog(io.RawIOBase):
    """A file to write into; of more than 3 MiB the first is kept, and what came last, at least 1 MiB of it.

    What has been written is on the disk at once, so the last words of a process that is ended are there too.
    """

    def __init__(self, path: Path) -> None:
        """Create or empty the file."""
        self._file = path.open("w+b")
        self._dropped = 0

    def writable(self) -> bool:
        """Tell that it takes bytes."""
        return True

    def write(self, content: Any, /) -> int:
        """Append bytes, and drop the middle where they are too many."""
        view = memoryview(content)
        for start in range(0, len(view), KEPT):
            self._file.write(view[start : start + KEPT])
            if self._file.tell() > 3 * KEPT:
                self._drop_the_middle()
        self._file.flush()
        return len(view)

    def _drop_the_middle(self) -> None:
        end = self._file.tell()
        self._file.seek(end - KEPT)
        last = self._file.read()
        # The sentence about what was dropped before goes with it.
        self._dropped += end - 2 * KEPT - len(self._notice() if self._dropped else b"")
        self._file.seek(KEPT)
        self._file.truncate()
        self._file.write(self._notice() + last)

    def _notice(self) -> bytes:
        return f"\n... {self._dropped} bytes are left out here ...\n".encode()

    def close(self) -> None:
        """Close the file."""
        self._file.close()
        super().close()


def last_words(path: Path) -> str:
    """The last line of a log that is not blank, at most 200 characters of it."""
    if not path.is_file():
        return "its log is no longer there"
    with path.open("rb") as file:
        size = file.seek(0, io.SEEK_END)
        file.seek(max(size - KEPT, 0))
        lines = file.read().decode("utf-8", "replace").splitlines()
    return next((line.strip()[-200:] for line in reversed(lines) if line.strip()), "it printed nothing")
