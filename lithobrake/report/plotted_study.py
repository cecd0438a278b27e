"""The results of a study as a notebook has them: with the figures of the report, one by one."""

import os
import shutil
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.results import StudyResults

if TYPE_CHECKING:
    from lithobrake.report.study_plots import StudyPlots


class PlottedStudy(StudyResults):
    """Results of a study with figures (`plot`); returned by `lithobrake.run` and `lithobrake.open_study`."""

    @cached_property
    def plot(self) -> "StudyPlots":
        """Figures one by one, on axes of matplotlib: `plot.map()`, `plot.ends(ax=axes)`, `plot.sensitivity()`, others.

        `dir(plot)` lists those that this study has. Needs a study that has run to its end.
        """
        from lithobrake.report.study_plots import StudyPlots

        return StudyPlots(self)

    def save(self, folder: str | os.PathLike[str]) -> "PlottedStudy":
        """Copy the study's folder, as a temporary one goes with the results, and return the results of the copy.

        Raises ValueError where the path is taken.
        """
        target = Path(folder)
        if target.exists():
            raise ValueError(f"folder is {str(folder)!r}, which is there already; allowed: a new path; name another")
        shutil.copytree(self.folder, target)
        return PlottedStudy(target)


def open_study(folder: str | os.PathLike[str]) -> PlottedStudy:
    """The results of a study's folder, for reading only. Raises ValueError when it is none."""
    return PlottedStudy(folder)
