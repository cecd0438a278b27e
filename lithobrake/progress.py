"""Progress of a study: two lines on a terminal, and else what a file takes, say the log of a queue."""

import math
import sys
import threading
import time
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self, TextIO

from rich.console import Console, RenderableType
from rich.progress import BarColumn, Progress, Task, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.text import Text

from lithobrake.campaign import duration, per_time
from lithobrake.vocabulary.number_words import percent
from lithobrake.vocabulary.plain_text import plain

# A stage is soon seen to be at work, and a night of it does not fill the file: first line, then the others [s].
FIRST, EVERY = 5.0, 30.0
# With less than this done the time left is no estimate [-].
LEAST_FRACTION = 0.01


class _TimeLeft(TimeRemainingColumn):
    """Time left of the work; none for the stages, which differ too much, and none where the lines below tell it."""

    def render(self, task: Task) -> Text:
        return Text.assemble("left ", super().render(task)) if task.fields["tells_time_left"] else Text("")


class _Lines(Progress):
    """The bars, and below them more about the work."""

    detail = ""

    def get_renderables(self) -> Iterable[RenderableType]:
        yield from super().get_renderables()
        if self.detail:
            yield Text(plain(self.detail), style="dim")


class ProgressBars:
    """Progress of a study on a terminal: stages on the first line, the work within the stage on the second.

    All words are shown as they are: square brackets in them are no markup.
    """

    def __init__(self, console: Console) -> None:
        """Prepare the lines; they appear with the first stage."""
        self._progress = _Lines(
            TextColumn("{task.description:<28}", markup=False),
            BarColumn(),
            TextColumn("{task.fields[count]:>11}", markup=False),
            TimeElapsedColumn(),
            _TimeLeft(),
            console=console,
            # What a command prints goes above the lines where both are one terminal, and else its own way.
            redirect_stdout=sys.stdout.isatty(),
        )
        self._stages = self._progress.add_task("study", total=None, count="", tells_time_left=False)
        self._work: TaskID | None = None

    def begin(self, title: str, number: int, count: int) -> None:
        """Start a stage; the first one makes the lines appear, so a refusal before it stands alone."""
        self._progress.start()
        self._end_work()
        self._progress.detail = ""
        self._progress.update(
            self._stages, description=f"stage: {title}", completed=number - 1, total=count, count=f"{number}/{count}"
        )
        # A bar that swings, until the stage says how far its work is: many fit and sum up for long without a measure.
        self.progress(0.0, 1.0, title)

    def say(self, sentence: str) -> None:
        """Write a sentence that stays."""
        self._progress.console.print(Text(plain(sentence)))

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Show how far the work of the stage is, and more about it; a change of `what` starts a new bar.

        The bar of work that is one thing, of which nothing is done, swings from side to side.
        """
        has_measure = done > 0.0 or total > 1.0
        count = counted(done, total) if has_measure else ""
        if self._work is not None and self._progress.tasks[-1].description != f"  {what}":
            self._end_work()
        if self._work is None:
            self._work = self._progress.add_task(f"  {what}", total=None, count=count, tells_time_left=False)
        length, tells_time_left = (total if has_measure else None), has_measure and not detail
        self._progress.update(self._work, completed=done, total=length, count=count, tells_time_left=tells_time_left)
        self._progress.detail = detail

    def _end_work(self) -> None:
        if self._work is not None:
            self._progress.remove_task(self._work)
            self._work = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        """Leave the last state on the screen."""
        if kind is None:
            self._progress.detail = ""
            self._progress.update(self._stages, completed=self._progress.tasks[0].total)
        self._progress.stop()


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
        known = LEAST_FRACTION <= fraction < 1.0
        left = f"{duration(self.seconds * (1.0 / fraction - 1.0))} left" if known else ""
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

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        """Write no more."""
        with self._lock:
            if kind is None:
                self._end_stage()
            self._closed = True
        self._changed.set()
        self._thread.join()


def study_progress() -> ProgressBars | ProgressLog:
    """Progress of a study on standard error: bars on a terminal that can redraw a line, and else what a file takes."""
    console = Console(stderr=True)
    moves = console.is_terminal and not console.is_dumb_terminal
    return ProgressBars(console) if moves else ProgressLog(sys.stderr)


def counted(done: float, total: float) -> str:
    """How much of how much, in numbers where things are counted and else as a fraction."""
    return f"{done:.0f}/{total:.0f}" if total > 1 else percent(done / max(total, 1e-300))
