"""What a run may take, and what it takes."""

import math
import os
from collections import Counter
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Limits:
    """The most that one run may take: wall time [s] and memory [bytes], with all processes that it starts.

    Raises ValueError for a limit that is not above 0, and for a memory limit where memory cannot be measured.
    """

    wall_s: float = math.inf
    memory_bytes: float = math.inf

    def __post_init__(self) -> None:
        for name, unit in (("wall_s", "s"), ("memory_bytes", "bytes")):
            if not getattr(self, name) > 0:
                raise ValueError(
                    f"Limits.{name} is {getattr(self, name)}; allowed: above 0 {unit}; leave it out for none"
                )
        if self.memory_bytes < math.inf and not Path("/proc/self/stat").exists():
            raise ValueError(
                f"Limits.memory_bytes is {self.memory_bytes:g}; memory is measured on Linux only: leave the limit out"
            )

    def exceeded(self, wall_s: float, memory_bytes: float) -> str | None:
        """The reason why a run must end; None while it may continue."""
        if wall_s > self.wall_s:
            return f"it ran longer than its limit of {self.wall_s:g} s"
        if memory_bytes > self.memory_bytes:
            return f"it held {memory_bytes:.3g} bytes of memory, more than its limit of {self.memory_bytes:.3g}"
        return None


def memory_by_session() -> Counter[int]:
    """Resident memory of all processes [bytes], by the session that they belong to."""
    page = os.sysconf("SC_PAGE_SIZE")
    memory: Counter[int] = Counter()
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            # The name of a program may hold blanks and brackets; what follows it holds neither.
            fields = path.read_text(errors="replace").rpartition(")")[2].split()
        except (FileNotFoundError, ProcessLookupError):
            continue  # it ended while the list was read
        memory[int(fields[3])] += page * int(fields[21])
    return memory
