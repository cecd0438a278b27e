"""The report of a study: reads the files of its folder, draws the figures, writes one page. Computes nothing new."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lithobrake.report.figures.corner_figure import write_corner
    from lithobrake.report.study_report import write_report

_HOME = {"write_corner": "figures.corner_figure", "write_report": "study_report"}
__all__ = ["write_corner", "write_report"]


def __getattr__(name: str) -> Any:
    # matplotlib is imported only when a report is made, so that the command line starts at once.
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
