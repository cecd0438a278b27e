"""What every stage is given."""

from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

from lithobrake.pipeline.folder import StudyFolder
from lithobrake.study import Study

# progress(done, total, what is being done)
Progress = Callable[[float, float, str], None]


@dataclass(frozen=True)
class Job:
    """A study, its folder, where runs are made, and where progress is shown.

    tables: the study file as it was written, for the record.
    """

    study: Study
    tables: Mapping[str, Any]
    folder: StudyFolder
    executor: Executor
    progress: Progress
