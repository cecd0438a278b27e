"""A study from its file to its report, stage by stage."""

from typing import TYPE_CHECKING

from lithobrake.vocabulary.lazy_names import lazy_names

if TYPE_CHECKING:
    from lithobrake.pipeline.commands.comparison import compare_studies as compare_studies
    from lithobrake.pipeline.commands.comparison import comparison_files as comparison_files
    from lithobrake.pipeline.commands.comparison import comparison_lines as comparison_lines
    from lithobrake.pipeline.commands.comparison import write_compared as write_compared
    from lithobrake.pipeline.commands.one_lander import OneJourney as OneJourney
    from lithobrake.pipeline.commands.one_lander import OneLanding as OneLanding
    from lithobrake.pipeline.commands.one_lander import follow_one as follow_one
    from lithobrake.pipeline.commands.one_lander import land_one as land_one
    from lithobrake.pipeline.commands.one_lander import landing_inputs as landing_inputs
    from lithobrake.pipeline.commands.rare_landings import rare_failure as rare_failure
    from lithobrake.pipeline.commands.serving import EvaluationProcess as EvaluationProcess
    from lithobrake.pipeline.commands.serving import ServedStudy as ServedStudy
    from lithobrake.pipeline.commands.serving import served_models as served_models
    from lithobrake.pipeline.commands.site_maps import map_sites as map_sites
    from lithobrake.pipeline.commands.site_maps import site_lines as site_lines
    from lithobrake.pipeline.commands.site_maps import site_map_files as site_map_files
    from lithobrake.pipeline.commands.site_maps import write_site_map as write_site_map
    from lithobrake.pipeline.commands.status import study_status as study_status
    from lithobrake.pipeline.folder_state import report_page as report_page
    from lithobrake.pipeline.inferred_study import InferredStudy as InferredStudy
    from lithobrake.pipeline.inferred_study import infer_study as infer_study
    from lithobrake.pipeline.job import Job as Job
    from lithobrake.pipeline.job import Stage as Stage
    from lithobrake.pipeline.outdated_files import make as make
    from lithobrake.pipeline.outdated_files import stage_keys as stage_keys
    from lithobrake.pipeline.planning.plan import Plan as Plan
    from lithobrake.pipeline.planning.plan import plan_lines as plan_lines
    from lithobrake.pipeline.planning.planner import plan_study as plan_study
    from lithobrake.pipeline.stages import stages_of as stages_of
    from lithobrake.pipeline.study_folder import StudyFolder as StudyFolder
    from lithobrake.pipeline.study_run import run_study as run_study
    from lithobrake.pipeline.study_run import write_report_again as write_report_again
else:
    __getattr__, __dir__ = lazy_names(__name__)
