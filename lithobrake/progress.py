"""Two lines that show where a study is: the stage, and what is done in it."""

import time
from collections.abc import Iterable
from types import TracebackType
from typing import Self

from rich.console import Console, RenderableType
from rich.progress import BarColumn, Progress, Task, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn
from rich.text import Text

# Where no terminal shows the lines, say in a log file, they are written this often [s].
_WRITTEN_EVERY = 60.0


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
            yield Text(self.detail, style="dim")


class StudyProgress:
    """Progress of a study on standard error: stages on the first line, the work within the stage on the second."""

    def __init__(self) -> None:
        """Prepare the lines; they appear with the first stage."""
        self._progress = _Lines(
            TextColumn("{task.description:<28}"),
            BarColumn(),
            TextColumn("{task.fields[count]:>11}"),
            TimeElapsedColumn(),
            _TimeLeft(),
            console=Console(stderr=True),
        )
        self._stages = self._progress.add_task("study", total=None, count="", tells_time_left=False)
        self._work: TaskID | None = None
        self._written = time.monotonic()

    def begin(self, title: str, number: int, count: int) -> None:
        """Start a stage; the first one makes the lines appear, so a refusal before it stands alone."""
        self._progress.start()
        if self._work is not None:
            self._progress.remove_task(self._work)
            self._work = None
        self._progress.detail = ""
        self._progress.update(
            self._stages, description=f"stage: {title}", completed=number - 1, total=count, count=f"{number}/{count}"
        )
        if not self._progress.console.is_terminal:
            self._progress.console.print(f"stage {number} of {count}: {title}")

    def say(self, sentence: str) -> None:
        """Write a sentence that stays."""
        # A file takes lines as long as they are.
        console = self._progress.console
        console.print(sentence, highlight=False, soft_wrap=not console.is_terminal)

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Show how far the work of the stage is, and more about it; a change of `what` starts a new bar."""
        count = f"{done:.0f}/{total:.0f}" if total > 1 else f"{100 * done / max(total, 1e-300):.0f} %"
        if self._work is not None and self._progress.tasks[-1].description != f"  {what}":
            self._progress.remove_task(self._work)
            self._work = None
        if self._work is None:
            self._work = self._progress.add_task(f"  {what}", total=total, count=count, tells_time_left=not detail)
        self._progress.update(self._work, completed=done, total=total, count=count)
        self._progress.detail = detail
        if not self._progress.console.is_terminal and time.monotonic() > self._written + _WRITTEN_EVERY:
            self._written = time.monotonic()
            self.say(f"  {what}: {detail.partition(chr(10))[0] or count}")

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
