"""A study from its file to its report, stage by stage."""

from lithobrake.pipeline.folder import StudyFolder
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.stages import STAGES, Stage, make, stage_keys
from lithobrake.pipeline.status import study_status
from lithobrake.pipeline.study_run import run_study

__all__ = ["STAGES", "Job", "Stage", "StudyFolder", "make", "run_study", "stage_keys", "study_status"]
