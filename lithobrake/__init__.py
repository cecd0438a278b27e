"""Predict where a lander comes to rest on a small body whose soil is unknown, with confidence intervals."""

from typing import TYPE_CHECKING

from lithobrake.vocabulary.lazy_names import lazy_names

if TYPE_CHECKING:
    from lithobrake.pipeline.study_run import run
    from lithobrake.report.plotted_study import open_study
    from lithobrake.results import StudyResults
else:
    __getattr__, __dir__ = lazy_names(__name__)

__version__ = "0.1.0"
__all__ = ["StudyResults", "__version__", "open_study", "run"]
