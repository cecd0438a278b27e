"""A study from its file to its report, stage by stage."""

from lithobrake.pipeline.folder import StudyFolder
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.plan import Plan, plan_study
from lithobrake.pipeline.stages import STAGES, Stage, make, stage_keys
from lithobrake.pipeline.status import study_status
from lithobrake.pipeline.study_run import run_study

__all__ = [
    "STAGES", "Job", "Plan", "Stage", "StudyFolder", "make", "plan_study", "run_study", "stage_keys", "study_status",
]  # fmt: skip
