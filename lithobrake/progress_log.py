"""Progress of a study in a file, say the log of a queue: its stages, and now and then a line about the work."""

import math
import threading
import time
from dataclasses import dataclass
from types import TracebackType
from typing import Self, TextIO

from lithobrake.campaign import duration, per_time
from lithobrake.vocabulary.plain_text import plain

# A stage is soon seen to be at work, and a night of it does not fill the file: first line, then the others [s].
FIRST, EVERY = 5.0, 30.0


@dataclass
class _Work:
    """A piece of work; began: when it was first heard of, on the monotonic clock [s], with first_done done."""

    what: str
    total: float
    began: float
    first_done: float
    done: float = 0.0
    detail: str = ""

    def now(self) -> str:
        """How far it is, how fast it goes and how long it will take."""
        fraction = (self.done - self.first_done) / (self.total - self.first_done or 1.0)
        left = f"{duration(self.seconds * (1.0 / fraction - 1.0))} left" if 0.0 < fraction < 1.0 else ""
        return self._line(counted(self.done, self.total), f"{duration(self.seconds)} so far", self._rate, left)

    def end(self) -> str:
        """What it came to, and how long it took."""
        how_much = counted(self.done, self.total) if self.total > 1.0 else ""
        return self._line(how_much, self._rate, f"took {duration(self.seconds)}")

    @property
    def seconds(self) -> float:
        """Since it began [s]."""
        return max(time.monotonic() - self.began, 1e-9)

    @property
    def _rate(self) -> str:
        fresh = self.done - self.first_done
        return per_time(fresh / self.seconds) if self.total > 1.0 and fresh > 0.0 else ""

    def _line(self, *parts: str) -> str:
        # Work that says more about itself tells rate and time left better than they can be told here.
        told = [self.detail.partition("\n")[0]] if self.detail else filter(None, parts)
        return f"  {self.what}: {', '.join(told)}"


class ProgressLog:
    """Writes each stage as it begins and ends, and every half minute how far its work is.

    A thread writes those lines, so that a piece of work that tells nothing for long is seen to be alive.
    """

    def __init__(self, file: TextIO, first: float = FIRST, every: float = EVERY) -> None:
        """Prepare to write to a file: `first` [s] after a stage began, then `every` [s]."""
        self._file, self._first, self._every = file, first, every
        self._lock, self._changed, self._closed = threading.RLock(), threading.Event(), False
        self._thread = threading.Thread(target=self._write_now_and_then, name="progress log", daemon=True)
        self._title = ""
        self._began, self._due = math.inf, math.inf
        self._work: _Work | None = None

    def begin(self, title: str, number: int, count: int) -> None:
        """End the stage before and start this one."""
        with self._lock:
            self._end_stage()
            self._title, self._began, self._work = title, time.monotonic(), None
            self._due = self._began + self._first
            self._write(f"stage {number} of {count}: {title}")
        self._changed.set()

    def say(self, sentence: str) -> None:
        """Write a sentence."""
        with self._lock:
            self._write(sentence)

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Remember how far the work of the stage is, for the next line about it."""
        with self._lock:
            if self._work is None or (self._work.what, self._work.total) != (what, total):
                self._end_work()
                self._work = _Work(what, total, time.monotonic(), done)
            self._work.done, self._work.detail = done, detail

    def _write_now_and_then(self) -> None:
        while not self._closed:
            wait = self._due - time.monotonic()
            if self._changed.wait(None if math.isinf(wait) else max(wait, 0.0)):
                self._changed.clear()
                continue
            with self._lock:
                # Another stage may have begun between the waking and the lock.
                if time.monotonic() >= self._due:
                    stage = f"  {self._title}: {duration(time.monotonic() - self._began)} so far"
                    self._write(self._work.now() if self._work else stage)
                    self._due = time.monotonic() + self._every

    def _end_work(self) -> None:
        """Write how a piece of work ended, if it took long enough to be waited for."""
        if self._work and self._work.seconds > self._first:
            self._write(self._work.end())

    def _end_stage(self) -> None:
        self._end_work()
        if self._work or time.monotonic() - self._began > self._first:
            self._write(f"  {self._title} took {duration(time.monotonic() - self._began)}")

    def _write(self, line: str) -> None:
        self._file.write(f"{plain(line)}\n")
        self._file.flush()

    def __enter__(self) -> Self:
        """Start to write."""
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Write no more."""
        with self._lock:
            if kind is None:
                self._end_stage()
            self._closed = True
        self._changed.set()
        self._thread.join()


def counted(done: float, total: float) -> str:
    """How much of how much, in numbers where things are counted and else as a fraction."""
    return f"{done:.0f}/{total:.0f}" if total > 1 else f"{100 * done / max(total, 1e-300):.0f} %"
