from .pipeline.study_run import Study as Study
from .pipeline.study_run import run as run
from .report.plotted_study import open_study as open_study
from .results import StudyResults as StudyResults

__version__: str
__all__ = ["Study", "StudyResults", "__version__", "open_study", "run"]
