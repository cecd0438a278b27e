"""Two lines on a terminal that show where a study is: the stage, and what is done in it."""

import sys
from collections.abc import Iterable
from types import TracebackType
from typing import Self

from rich.console import Console, RenderableType
from rich.progress import BarColumn, Progress, Task, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.text import Text

from lithobrake.progress_log import ProgressLog, counted
from lithobrake.vocabulary.plain_text import plain


class _TimeLeft(TimeRemainingColumn):
    """Time left of the work; none for the stages, which differ too much, and none where the lines below tell it."""

    def render(self, task: Task) -> Text:
        """Give what is drawn."""
        return Text.assemble("left ", super().render(task)) if task.fields["tells_time_left"] else Text("")


class _Lines(Progress):
    """The bars, and below them more about the work."""

    detail = ""

    def get_renderables(self) -> Iterable[RenderableType]:
        """Give what is drawn."""
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

    def say(self, sentence: str) -> None:
        """Write a sentence that stays."""
        self._progress.console.print(Text(plain(sentence)))

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Show how far the work of the stage is, and more about it; a change of `what` starts a new bar."""
        count = counted(done, total)
        if self._work is not None and self._progress.tasks[-1].description != f"  {what}":
            self._end_work()
        if self._work is None:
            self._work = self._progress.add_task(f"  {what}", total=total, count=count, tells_time_left=not detail)
        self._progress.update(self._work, completed=done, total=total, count=count)
        self._progress.detail = detail

    def _end_work(self) -> None:
        if self._work is not None:
            self._progress.remove_task(self._work)
            self._work = None

    def __enter__(self) -> Self:
        """Give the lines."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Leave the last state on the screen."""
        if kind is None:
            self._progress.detail = ""
            self._progress.update(self._stages, completed=self._progress.tasks[0].total)
        self._progress.stop()


def study_progress() -> ProgressBars | ProgressLog:
    """Progress of a study on standard error: bars on a terminal that can redraw a line, and else what a file takes."""
    console = Console(stderr=True)
    moves = console.is_terminal and not console.is_dumb_terminal
    return ProgressBars(console) if moves else ProgressLog(sys.stderr)
