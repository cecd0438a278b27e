"""The results of a study as a notebook has them: with the figures of the report, one by one."""

import os
from functools import cached_property
from typing import TYPE_CHECKING

from lithobrake.results import StudyResults

if TYPE_CHECKING:
    from lithobrake.report.study_plots import StudyPlots


class PlottedStudy(StudyResults):
    """What came out of a study, and its figures; what `lithobrake.run` and `lithobrake.open_study` return."""

    @cached_property
    def plot(self) -> "StudyPlots":
        """Figures one by one, on axes of matplotlib: `plot.map()`, `plot.ends(ax=axes)`, `plot.variance()` and others.

        Needs a study that has run to its end.
        """
        from lithobrake.report.study_plots import StudyPlots

        return StudyPlots(self)


def open_study(folder: str | os.PathLike[str]) -> PlottedStudy:
    """The results of a study's folder, for reading only. Raises ValueError when it is none."""
    return PlottedStudy(folder)
