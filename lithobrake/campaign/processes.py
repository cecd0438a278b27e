"""All processes that a worker has started, found by a mark in their environment, which each of them inherits."""

import contextlib
import os
import signal
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from uuid import uuid4

# Sessions and process groups can be left, and a process whose parent has ended has no ancestor here; what a process is
# given at its start stays readable (proc(5)). One that clears its environment and leaves its session is not found.
_PREFIX = "LITHOBRAKE_WORKER_"


def new_mark() -> str:
    """Return the name of an environment variable of one worker; workers of a model's own campaign add another."""
    return f"{_PREFIX}{uuid4().hex}"


def end_marked(mark: str) -> None:
    """Kill every process with a mark but this one. Nothing is found where there is no /proc, as on macOS."""
    ended: set[int] = {os.getpid()}
    # What a process starts while it is being killed is found at the next look.
    while new := {number for number, environment in _environments() if mark.encode() in environment} - ended:
        for number in new:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.kill(number, signal.SIGKILL)
        ended |= new


def memory_of_workers(marks: Mapping[int, str]) -> Counter[int]:
    """Resident memory [bytes] of each worker with all that it has started.

    marks: of each worker by the number of its process, which leads a session of its own.
    """
    page, memory = os.sysconf("SC_PAGE_SIZE"), Counter[int]()
    for path in Path("/proc").glob("[0-9]*"):
        try:
            # The name of a program may hold blanks and brackets; what follows it holds neither.
            fields = (path / "stat").read_text(errors="replace").rpartition(")")[2].split()
        except (FileNotFoundError, ProcessLookupError):
            continue  # it ended while the list was read
        # Fields 6 (session) and 24 (rss [pages]) of proc(5), of which two stand before the bracket.
        session, size = int(fields[3]), page * int(fields[21])
        if session not in marks:
            environment = _environment(path)
            session = next((number for number, mark in marks.items() if mark.encode() in environment), session)
        memory[session] += size
    return memory


def _environments() -> Iterator[tuple[int, bytes]]:
    for path in Path("/proc").glob("[0-9]*"):
        yield int(path.name), _environment(path)


def _environment(path: Path) -> bytes:
    """What a process was started with; nothing of one that has ended or is another user's."""
    try:
        return (path / "environ").read_bytes()
    except OSError:
        return b""
