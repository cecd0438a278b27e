"""A study from its file to its report, stage by stage."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lithobrake.pipeline.commands.one_landing import OneLanding, land_one, landing_inputs
    from lithobrake.pipeline.commands.rare_landings import rare_failure
    from lithobrake.pipeline.commands.serving import ServedStudy, served_models
    from lithobrake.pipeline.commands.serving_process import EvaluationProcess
    from lithobrake.pipeline.commands.status import study_status
    from lithobrake.pipeline.folder.state import report_page
    from lithobrake.pipeline.folder.study_folder import StudyFolder
    from lithobrake.pipeline.inference.inferred_study import InferredStudy, infer_study
    from lithobrake.pipeline.job import Job
    from lithobrake.pipeline.planning.plan import Plan
    from lithobrake.pipeline.planning.plan_in_words import plan_lines
    from lithobrake.pipeline.planning.planner import plan_study
    from lithobrake.pipeline.stages import Stage, make, stage_keys, stages_of
    from lithobrake.pipeline.study_run import run_study, write_report_again

_HOME = {
    "EvaluationProcess": "commands.serving_process",
    "InferredStudy": "inference.inferred_study",
    "Job": "job",
    "OneLanding": "commands.one_landing",
    "Plan": "planning.plan",
    "ServedStudy": "commands.serving",
    "Stage": "stages",
    "StudyFolder": "folder.study_folder",
    "infer_study": "inference.inferred_study",
    "land_one": "commands.one_landing",
    "landing_inputs": "commands.one_landing",
    "make": "stages",
    "plan_lines": "planning.plan_in_words",
    "plan_study": "planning.planner",
    "rare_failure": "commands.rare_landings",
    "report_page": "folder.state",
    "run_study": "study_run",
    "served_models": "commands.serving",
    "stage_keys": "stages",
    "stages_of": "stages",
    "study_status": "commands.status",
    "write_report_again": "study_run",
}
__all__ = [
    "EvaluationProcess",
    "InferredStudy",
    "Job",
    "OneLanding",
    "Plan",
    "ServedStudy",
    "Stage",
    "StudyFolder",
    "infer_study",
    "land_one",
    "landing_inputs",
    "make",
    "plan_lines",
    "plan_study",
    "rare_failure",
    "report_page",
    "run_study",
    "served_models",
    "stage_keys",
    "stages_of",
    "study_status",
    "write_report_again",
]


def __getattr__(name: str) -> Any:
    # Who only looks at a study, as a second terminal does every few seconds, does not wait for what makes one.
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
