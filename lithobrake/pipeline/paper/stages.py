"""The stages of the paper method."""

from collections.abc import Callable
from typing import Any

from lithobrake.pipeline.answer.stages import PARTS as ANSWER_PARTS
from lithobrake.pipeline.answer.summary_parts import summary_dependencies
from lithobrake.pipeline.design.dependencies import design_dependencies
from lithobrake.pipeline.emulate.explorer_tables import FILE as EXPLORER
from lithobrake.pipeline.emulate.stages import PARTS as EMULATOR_PARTS
from lithobrake.pipeline.emulate.stages import sample_dependencies
from lithobrake.pipeline.fly.flights import flight_dependencies
from lithobrake.pipeline.fly.stages import FILES as FLIGHT_FILES
from lithobrake.pipeline.fly.stages import PARTS as FLIGHT_PARTS
from lithobrake.pipeline.paper.expansion_flights import fly_expansion_samples
from lithobrake.pipeline.paper.expansion_journeys import follow_expansion_samples
from lithobrake.pipeline.paper.expansion_tables import sample_expansion
from lithobrake.pipeline.paper.expansions import fit_refined, fit_screening, score_all
from lithobrake.pipeline.paper.paper_runs import make_refined_runs, make_screening_runs, make_test_runs
from lithobrake.pipeline.paper.paper_summary import write_summary
from lithobrake.pipeline.rest.journeys import rest_dependencies, rest_files
from lithobrake.pipeline.rest.stages import PARTS as REST_PARTS
from lithobrake.pipeline.runs.run_table import file_of
from lithobrake.pipeline.runs.shown_landing import land_once, landing_dependencies, landing_files
from lithobrake.pipeline.runs.stages import PARTS as RUN_PARTS
from lithobrake.pipeline.stage import Stage, same_files
from lithobrake.study import Study

PARTS = ("pipeline/paper", "analysis", "emulator", *RUN_PARTS)


def _design(*names: str) -> Callable[[Study], Any]:
    return lambda study: [study.design.model_dump()[name] for name in names]


def _screening_dependencies(study: Study) -> Any:
    # The points of one design are best for the degree that is fitted to them.
    own = _design("points", "replicate_count", "screening_level", "screening_count", "screening_degree")
    return [design_dependencies(study), study.seed, *own(study)]


MEDIAN_LANDING = Stage("landing", "median landing", landing_files, land_once, ("bed",), landing_dependencies)
SCREENING_RUNS = Stage(
    "screening_runs",
    "screening runs",
    same_files(file_of("screening")),
    make_screening_runs,
    ("bed",),
    _screening_dependencies,
    PARTS,
)
SCREEN = Stage(
    "screen", "screening", same_files("screening.json"), fit_screening, ("screening_runs",), _design("fit"), PARTS
)
REFINED_RUNS = Stage(
    "refined_runs",
    "refined runs",
    same_files(file_of("refined")),
    make_refined_runs,
    ("screen",),
    _design("refined_level", "refined_count", "refined_degree", "kept_share", "kept_outputs"),
    PARTS,
)
REFINE = Stage("refine", "refinement", same_files("refined.json"), fit_refined, ("refined_runs",), parts=PARTS)
TEST_RUNS = Stage(
    "test_runs",
    "test runs",
    same_files(file_of("test_kept"), file_of("test_all")),
    make_test_runs,
    ("refined_runs",),
    _design("test_count"),
    PARTS,
)
TEST = Stage("test", "scores", same_files("scores.json"), score_all, ("refine", "test_runs"), parts=PARTS)
SAMPLE = Stage(
    "sample",
    "samples",
    same_files("samples.h5", EXPLORER),
    sample_expansion,
    ("refine", "test"),
    sample_dependencies,
    (*PARTS, *EMULATOR_PARTS),
)
FLY = Stage(
    "fly",
    "flights",
    same_files(*FLIGHT_FILES, "flights_without_scatter.csv"),
    fly_expansion_samples,
    ("sample",),
    flight_dependencies,
    FLIGHT_PARTS,
)
REST = Stage(
    "rest",
    "bounces until rest",
    rest_files,
    follow_expansion_samples,
    ("fly",),
    rest_dependencies,
    (*PARTS, *REST_PARTS),
)
SUMMARY = Stage(
    "summary",
    "summary",
    same_files("summary.json"),
    write_summary,
    ("landing", "rest"),
    summary_dependencies,
    (*PARTS, *ANSWER_PARTS),
)
