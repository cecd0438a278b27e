"""The report of a study: reads the files of its folder, draws the figures, writes one page. Computes nothing new."""

from collections.abc import Callable
from pathlib import Path

__all__ = ["write_corner", "write_report"]


def write_report(folder: Path, progress: Callable[[int, int], None] = lambda done, total: None) -> Path:
    """Write report/index.html of a study's folder, and its figures as PNG files; returns the path of the page.

    progress: called with the number of figures that are drawn, and that of all.
    Raises ValueError when a file that the report reads is missing.
    """
    # matplotlib is imported only when a report is made, so that the command line starts at once.
    from lithobrake.report.study_report import write_report as write

    return write(folder, progress)


def write_corner(posterior: Path, picture: Path) -> None:
    """Draw the posterior.json of an inference as a corner plot, a PNG file: each input before and after, and each pair.

    Raises ValueError for another file.
    """
    from lithobrake.report.figures.corner_figure import write_corner as write

    write(posterior, picture)
