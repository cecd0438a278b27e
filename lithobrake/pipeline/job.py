"""What every stage is given."""

from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any, Protocol

from lithobrake.pipeline.folder import StudyFolder
from lithobrake.study import Study


class Progress(Protocol):
    """Shows how far a piece of work is; detail: more about it, in lines."""

    def __call__(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Show it."""


@dataclass(frozen=True)
class Job:
    """A study, its folder, where runs are made, and where progress is shown.

    tables: the study file as it was written, for the record. say: tells the user a sentence. keeps_logs: each run
    leaves a log in the folder. wanted: files of the present stage that are not there, or no longer good.
    """

    study: Study
    tables: Mapping[str, Any]
    folder: StudyFolder
    executor: Executor
    progress: Progress
    say: Callable[[str], None]
    keeps_logs: bool = False
    wanted: tuple[str, ...] = ()
