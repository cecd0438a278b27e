"""What every stage is given, and what a stage is."""

from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any, Protocol

from lithobrake.campaign.single_run import Model
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.site import Site
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.study import Study


class StudyProgress(Protocol):
    """Shows a study at work: the stages as they begin, how far the work in each is, sentences that stay."""

    def begin(self, title: str, number: int, count: int) -> None:
        """Show that a stage begins, the one of this number out of `count`."""

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Show how far a piece of work is; detail: more about it, in lines."""

    def say(self, sentence: str) -> None:
        """Tell the user a sentence."""


class Silent:
    def begin(self, title: str, number: int, count: int) -> None:
        """Show nothing."""

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Show nothing."""

    def say(self, sentence: str) -> None:
        """Tell nothing."""


def note_nothing(**what: Any) -> None:
    """Note nothing: no other process looks."""


@dataclass(frozen=True)
class Job:
    """A study, its folder, where runs are made, and where progress is shown.

    design: the runs that the study asks for, and where it lands, each worked out once.
    tables: the study file as it was written, for the record. model: a function of the user's own that makes the
    touchdowns in place of the soil. keeps_logs: each run leaves a log in the folder. wanted: files of the present stage
    that are not there, or no longer good. note: notes for other processes how far the stage is, by name.
    """

    design: DrawnDesign
    tables: Mapping[str, Any]
    folder: StudyFolder
    executor: Executor
    shown: StudyProgress
    model: Model | None = None
    keeps_logs: bool = False
    wanted: tuple[str, ...] = ()
    note: Callable[..., None] = note_nothing

    @property
    def study(self) -> Study:
        """The study, with as many runs as it has by now."""
        return self.design.study

    @property
    def site(self) -> Site:
        """Where the study lands."""
        return self.design.site

    def progress(self, done: float, total: float, what: str, detail: str = "", /) -> None:
        """Show how far a piece of work is; detail: more about it, in lines."""
        self.shown.progress(done, total, what, detail)

    def say(self, sentence: str) -> None:
        """Tell the user a sentence."""
        self.shown.say(sentence)


def no_dependencies(study: Study) -> Any:
    """Nothing of the study itself, beside what the stages before depend on."""
    return None


def same_files(*names: str) -> Callable[[Study], list[str]]:
    return lambda study: list(names)


@dataclass(frozen=True)
class Stage:
    """One stage of a study: its files, its inputs, and the function that writes them.

    files: what it writes. make: writes it. after: stages whose files it reads. dependencies: what of the study it
    depends on, as JSON values. parts: rooms and files of the package whose code decides what it writes, beside those of
    the stages before; a change in any other makes no file of it outdated.
    """

    name: str
    title: str
    files: Callable[[Study], list[str]]
    make: Callable[[Job], None]
    after: tuple[str, ...] = ()
    dependencies: Callable[[Study], Any] = no_dependencies
    parts: tuple[str, ...] = ()
