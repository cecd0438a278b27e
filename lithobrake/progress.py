"""Two lines that show where a study is: the stage, and what is done in it."""

from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn, TimeRemainingColumn


class StudyProgress:
    """Progress of a study on standard error: stages on the first line, the work within the stage on the second."""

    def __init__(self) -> None:
        """Prepare the lines; they appear with the first stage."""
        self._progress = Progress(
            TextColumn("{task.description:<28}"),
            BarColumn(),
            TextColumn("{task.fields[count]:>11}"),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
            console=Console(stderr=True),
        )
        self._stages = self._progress.add_task("study", total=None, count="")
        self._work: TaskID | None = None

    def begin(self, title: str, number: int, count: int) -> None:
        """Start a stage; the first one makes the lines appear, so a refusal before it stands alone."""
        self._progress.start()
        if self._work is not None:
            self._progress.remove_task(self._work)
            self._work = None
        self._progress.update(
            self._stages, description=f"stage: {title}", completed=number - 1, total=count, count=f"{number}/{count}"
        )
        if not self._progress.console.is_terminal:
            self._progress.console.print(f"stage {number} of {count}: {title}")

    def progress(self, done: float, total: float, what: str) -> None:
        """Show how far the work of the stage is; a change of `what` starts a new bar."""
        count = f"{done:.0f}/{total:.0f}" if total > 1 else f"{100 * done / max(total, 1e-300):.0f} %"
        if self._work is not None and self._progress.tasks[-1].description != f"  {what}":
            self._progress.remove_task(self._work)
            self._work = None
        if self._work is None:
            self._work = self._progress.add_task(f"  {what}", total=total, count=count)
        self._progress.update(self._work, completed=done, total=total, count=count)

    def __enter__(self) -> Self:
        """Give the lines."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Leave the last state on the screen."""
        if kind is None:
            self._progress.update(self._stages, completed=self._progress.tasks[0].total)
        self._progress.stop()
