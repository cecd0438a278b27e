"""A step of a study: what it writes, of what, and by which code."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from lithobrake.pipeline.job import Job
from lithobrake.study import Study


def no_dependencies(study: Study) -> Any:
    """Nothing of the study itself, beside what the stages before depend on."""
    return None


def same_files(*names: str) -> Callable[[Study], list[str]]:
    """These files, whatever the study says."""
    return lambda study: list(names)


@dataclass(frozen=True)
class Stage:
    """A step of a study.

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
