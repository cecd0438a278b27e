"""The stages of a study in order, by its method: what each writes, of what, and by which code."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from lithobrake.files.reading import content_hash
from lithobrake.pipeline.answer.expansion_results import write_summary
from lithobrake.pipeline.answer.run_estimates import ESTIMATES_FILE, estimate
from lithobrake.pipeline.answer.study_summary import summary_dependencies, write_drawn_summary, write_journey_summary
from lithobrake.pipeline.design.arrivals import place_region
from lithobrake.pipeline.design.dependencies import bed_dependencies, bed_files, design_dependencies
from lithobrake.pipeline.design.drawn_design import SIDE_DESIGNS, beds_of_runs
from lithobrake.pipeline.expansion import expansions
from lithobrake.pipeline.expansion.expansion_journeys import follow_expansion_samples
from lithobrake.pipeline.expansion.expansion_samples import sample_expansion
from lithobrake.pipeline.first_bounces import bounces_to_rest, emulator
from lithobrake.pipeline.flights import PATHS_FILE, flight_dependencies, fly_expansion_samples, fly_samples
from lithobrake.pipeline.job import Job, Stage, same_files
from lithobrake.pipeline.journeys import emulated_journeys
from lithobrake.pipeline.journeys.campaign import JOURNEY_FILES, make_journeys
from lithobrake.pipeline.run_flights import IMPACTS, RUN_FLIGHTS_FILE, fly_runs, run_flight_dependencies
from lithobrake.pipeline.runs import landings
from lithobrake.pipeline.runs.beds import pour_beds
from lithobrake.pipeline.runs.run_table import file_of
from lithobrake.pipeline.sky_at_rest import look_up, sky_dependencies, sky_files
from lithobrake.study import Study
from lithobrake.study.delivery_sections import OWN_KEYS
from lithobrake.vocabulary import file_names

# Beds and landings are known by the hash of the engine and of all that they follow from; this is how they are chosen
# and written down.
RUN_PARTS = (
    "pipeline/design", "pipeline/runs/energy_bound.py", "pipeline/runs/landings.py", "pipeline/runs/run_table.py",
    "chaos", "vocabulary/quantities.py", "geometry/attitude.py",
)  # fmt: skip
BED = Stage("bed", "bed", bed_files, pour_beds, dependencies=bed_dependencies)
FIRST_LANDING = Stage(
    "landing", "preview landing", landings.landing_files, landings.land_once, ("bed",), landings.landing_dependencies
)
# Without parts of its own: the choice of the run is made by code that is among those of the runs.
TELLING_LANDING = Stage(
    "telling_landing", "representative landing", landings.telling_files, landings.land_tellingly, ("runs",)
)
FLIGHT_FILES = (file_names.SAMPLE_FLIGHTS_FILE, file_names.FLIGHT_CHECKS_FILE, file_names.BODY_FILE, PATHS_FILE)
FLIGHT_PARTS = (
    "pipeline/flights.py", "pipeline/run_flights.py", "pipeline/site.py", "pipeline/samples.py",
    "pipeline/runs/run_table.py", "smallbody", "geometry", "chaos", "vocabulary/constants.py",
    "vocabulary/known_bodies.py", "vocabulary/quantities.py",
)  # fmt: skip
# After the side runs, since pairs and twins fly with the runs that they belong to.
FLY_RUNS = Stage(
    "fly_runs",
    "flights of the runs",
    same_files(RUN_FLIGHTS_FILE, IMPACTS),
    fly_runs,
    ("side_runs",),
    run_flight_dependencies,
    FLIGHT_PARTS,
)
FLY = Stage("fly", "flights", same_files(*FLIGHT_FILES), fly_samples, ("sample",), flight_dependencies, FLIGHT_PARTS)
EMULATOR_PARTS = (
    "pipeline/first_bounces/emulator.py", "pipeline/samples.py", "pipeline/runs/energy_bound.py", "emulator", "chaos",
    "analysis", "results/table.py", "vocabulary/quantities.py",
)  # fmt: skip
EMULATOR = Stage(
    "emulator",
    "emulator",
    same_files(emulator.EMULATOR_FILE, emulator.EXPLORER_FILE),
    emulator.make_emulator,
    ("runs",),
    parts=EMULATOR_PARTS,
)
REST_PARTS = ("pipeline/first_bounces", *FLIGHT_PARTS)
REST = Stage(
    "rest",
    "bounces until rest",
    bounces_to_rest.rest_files,
    bounces_to_rest.follow_samples,
    ("fly",),
    bounces_to_rest.rest_dependencies,
    REST_PARTS,
)
AIM = Stage(
    "aim",
    "aims",
    bounces_to_rest.aim_files,
    bounces_to_rest.follow_aims,
    ("fly",),
    bounces_to_rest.aim_dependencies,
    REST_PARTS,
)
JOURNEY_PARTS = (
    "pipeline/journeys/campaign.py", "pipeline/journeys/journey.py", "geometry/attitude.py", *RUN_PARTS, *FLIGHT_PARTS,
)  # fmt: skip
EMULATED_PARTS = ("pipeline/journeys", "pipeline/first_bounces", *EMULATOR_PARTS, *FLIGHT_PARTS)
EMULATED = Stage(
    "emulated",
    "journeys by the emulator",
    same_files(*emulated_journeys.EMULATED_FILES),
    emulated_journeys.make_emulated,
    ("runs",),
    emulated_journeys.emulated_dependencies,
    EMULATED_PARTS,
)
OPTIONS = Stage(
    "aim",
    "delivery options",
    emulated_journeys.option_files,
    emulated_journeys.follow_options,
    ("emulated",),
    emulated_journeys.option_dependencies,
    EMULATED_PARTS,
)
SKY_PARTS = ("pipeline/sky_at_rest.py", "pipeline/site.py", *FLIGHT_PARTS)
SKY = Stage("sky", "sky over the landers at rest", sky_files, look_up, ("runs",), sky_dependencies, SKY_PARTS)
ANSWER_PARTS = (
    *("pipeline/answer", "pipeline/site.py", "pipeline/journeys"),
    *("analysis", "chaos", "emulator", "results", "statements", "vocabulary"),
)
ESTIMATE = Stage("estimate", "estimates", same_files(ESTIMATES_FILE), estimate, ("fly_runs",), parts=ANSWER_PARTS)
JOURNEY_SUMMARY = Stage(
    "summary",
    "summary",
    same_files(file_names.SUMMARY_FILE),
    write_journey_summary,
    ("landing", "telling_landing", "estimate", "emulated", "aim", "sky"),
    summary_dependencies,
    ANSWER_PARTS,
)
SUMMARY = Stage(
    "summary",
    "summary",
    same_files(file_names.SUMMARY_FILE),
    write_drawn_summary,
    ("landing", "telling_landing", "estimate", "rest", "aim"),
    summary_dependencies,
    ANSWER_PARTS,
)
PAPER_PARTS = ("pipeline/expansion", "analysis", "emulator", *RUN_PARTS)
MEDIAN_LANDING = Stage(
    "landing", "median landing", landings.landing_files, landings.land_once, ("bed",), landings.landing_dependencies
)
REFINE = Stage(
    "refine",
    "refinement",
    same_files(file_names.REFINED_FILE),
    expansions.fit_refined,
    ("refined_runs",),
    parts=PAPER_PARTS,
)
TEST = Stage(
    "test",
    "scores",
    same_files(file_names.SCORES_FILE),
    expansions.score_all,
    ("refine", "test_runs"),
    parts=PAPER_PARTS,
)
FLY_EXPANSION_SAMPLES = Stage(
    "fly",
    "flights",
    same_files(*FLIGHT_FILES, "flights_without_scatter.csv"),
    fly_expansion_samples,
    ("sample",),
    flight_dependencies,
    FLIGHT_PARTS,
)
FOLLOW_EXPANSION_SAMPLES = Stage(
    "rest",
    "bounces until rest",
    bounces_to_rest.rest_files,
    follow_expansion_samples,
    ("fly",),
    bounces_to_rest.rest_dependencies,
    (*PAPER_PARTS, *REST_PARTS),
)
PAPER_SUMMARY = Stage(
    "summary",
    "summary",
    same_files(file_names.SUMMARY_FILE),
    write_summary,
    ("landing", "rest"),
    summary_dependencies,
    (*PAPER_PARTS, *ANSWER_PARTS),
)


def drawn_dependencies(study: Study) -> Any:
    count = study.design.run_count
    return [design_dependencies(study), place_region(study), study.seed, count, beds_of_runs(study, count)]


def _side_files(study: Study) -> list[str]:
    return [file_of(design) for design in SIDE_DESIGNS] if study.design.side_runs else []


DRAWN_RUNS = Stage(
    "runs", "runs", same_files(file_of("drawn")), landings.make_drawn_runs, ("bed",), drawn_dependencies, RUN_PARTS
)
SIDE_RUNS = Stage(
    "side_runs",
    "side runs",
    _side_files,
    landings.make_side_runs,
    ("runs",),
    lambda study: [study.design.side_runs, study.design.twin_shift],
    RUN_PARTS,
)


def sample_dependencies(study: Study) -> Any:
    return study.monte_carlo.model_dump()


SAMPLE = Stage(
    "sample",
    "samples",
    same_files(file_names.SAMPLES_FILE),
    emulator.draw_emulator_samples,
    ("emulator",),
    sample_dependencies,
    EMULATOR_PARTS,
)


def journey_dependencies(study: Study) -> Any:
    # The count enters by the runs, and further emulated landers leave the journeys as they are.
    journey = None if study.journey is None else study.journey.model_dump(exclude={"count", "emulated_count"})
    return [drawn_dependencies(study), run_flight_dependencies(study), journey, *_delivery(study)]


def _delivery(study: Study) -> list[Any]:
    """What the states and correlations of a delivery depend on; nothing for one that has neither."""
    if study.delivery is None:
        return []
    given = study.delivery.model_dump(include=set(OWN_KEYS), exclude_none=True)
    if study.delivery.states is not None:
        # A table counts with its content, wherever it lies.
        given["states"] = content_hash(Path(study.delivery.states))
    return [given] if given else []


# Of the name of the drawn runs, as its first touchdowns take their place for all later stages.
FOLLOW_JOURNEYS = Stage(
    "runs",
    "journeys",
    same_files(file_of("drawn"), file_of("touchdowns"), *JOURNEY_FILES, file_names.BODY_FILE, PATHS_FILE),
    make_journeys,
    ("bed",),
    journey_dependencies,
    JOURNEY_PARTS,
)


def _design(*names: str) -> Callable[[Study], Any]:
    return lambda study: [study.design.model_dump()[name] for name in names]


def _screening_dependencies(study: Study) -> Any:
    # The points of one design are best for the degree that is fitted to them.
    own = _design("points", "replicate_count", "screening_level", "screening_count", "screening_degree")
    return [design_dependencies(study), study.seed, *own(study)]


SCREENING_RUNS = Stage(
    "screening_runs",
    "screening runs",
    same_files(file_of("screening")),
    expansions.make_screening_runs,
    ("bed",),
    _screening_dependencies,
    PAPER_PARTS,
)
SCREEN = Stage(
    "screen",
    "screening",
    same_files(file_names.SCREENING_FILE),
    expansions.fit_screening,
    ("screening_runs",),
    _design("fit"),
    PAPER_PARTS,
)
REFINED_RUNS = Stage(
    "refined_runs",
    "refined runs",
    same_files(file_of("refined")),
    expansions.make_refined_runs,
    ("screen",),
    _design("refined_level", "refined_count", "refined_degree", "kept_share", "kept_outputs"),
    PAPER_PARTS,
)
TEST_RUNS = Stage(
    "test_runs",
    "test runs",
    same_files(file_of("test_kept"), file_of("test_all")),
    expansions.make_test_runs,
    ("refined_runs",),
    _design("test_count"),
    PAPER_PARTS,
)
SAMPLE_EXPANSION = Stage(
    "sample",
    "samples",
    same_files(file_names.SAMPLES_FILE, emulator.EXPLORER_FILE),
    sample_expansion,
    ("refine", "test"),
    sample_dependencies,
    (*PAPER_PARTS, *EMULATOR_PARTS),
)


def _write_report(job: Job) -> None:
    from lithobrake.report import write_report

    write_report(job.folder.path, lambda done, total: job.progress(done, total, "figures"))


REPORT = Stage(
    "report",
    "report",
    same_files("report/index.html"),
    _write_report,
    ("summary",),
    parts=("report", "statements", "results", "vocabulary"),
)
DRAWN_STAGES = (
    BED, FIRST_LANDING, DRAWN_RUNS, SIDE_RUNS, FLY_RUNS, TELLING_LANDING, ESTIMATE, EMULATOR, SAMPLE, FLY, REST, AIM,
    SUMMARY, REPORT,
)  # fmt: skip
# Landings that follow each other until the lander rests, in the place of single ones, and journeys by their emulator.
JOURNEY_STAGES = (
    BED, FIRST_LANDING, FOLLOW_JOURNEYS, SIDE_RUNS, FLY_RUNS, TELLING_LANDING, ESTIMATE, EMULATED, OPTIONS, SKY,
    JOURNEY_SUMMARY, REPORT,
)  # fmt: skip
PAPER_STAGES = (
    BED, MEDIAN_LANDING, SCREENING_RUNS, SCREEN, REFINED_RUNS, REFINE, TEST_RUNS, TEST, SAMPLE_EXPANSION,
    FLY_EXPANSION_SAMPLES, FOLLOW_EXPANSION_SAMPLES, PAPER_SUMMARY, REPORT,
)  # fmt: skip


def stages_of(study: Study) -> tuple[Stage, ...]:
    """The stages of a study in order, by its method."""
    if study.design.method == "paper":
        return PAPER_STAGES
    return DRAWN_STAGES if study.journey is None else JOURNEY_STAGES


def stages_until(study: Study, until: str) -> tuple[Stage, ...]:
    """The stages of a study up to and including one.

    Raises ValueError for a stage that the method of the study does not have.
    """
    stages, method = stages_of(study), study.design.method
    names = [stage.name for stage in stages]
    if until in names:
        return stages[: names.index(until) + 1]
    raise ValueError(
        f'"{until}" is no stage of a study with design.method = "{method}"; allowed: {", ".join(names)}; '
        "run all of it with: lithobrake run"
    )
