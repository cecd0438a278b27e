"""What came out of a study: read from its folder, nothing written, nothing computed."""

from lithobrake.results.study_results import StudyResults, open_study
from lithobrake.results.table import Column, Table

__all__ = ["Column", "StudyResults", "Table", "open_study"]
