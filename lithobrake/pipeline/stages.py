"""The stages of a study in order: what each writes, of what, and by which code; one without files is passed over."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from lithobrake.files.reading import content_hash
from lithobrake.pipeline.answer.run_estimates import ESTIMATES_FILE, estimate
from lithobrake.pipeline.answer.study_summary import summary_dependencies, write_summary
from lithobrake.pipeline.design.arrivals import place_region
from lithobrake.pipeline.design.bed_order import beds_of_runs
from lithobrake.pipeline.design.dependencies import bed_dependencies, bed_files, design_dependencies
from lithobrake.pipeline.design.side_designs import SIDE_DESIGNS
from lithobrake.pipeline.expansion import expansions
from lithobrake.pipeline.expansion.expansion_samples import draw_samples
from lithobrake.pipeline.first_touchdown import emulator
from lithobrake.pipeline.first_touchdown.flights import PATHS_FILE, flight_dependencies, fly_samples, write_paths
from lithobrake.pipeline.first_touchdown.run_flights import IMPACTS, RUN_FLIGHTS_FILE, fly_runs, run_flight_dependencies
from lithobrake.pipeline.job import Job, Stage, no_dependencies, same_files
from lithobrake.pipeline.journeys import delivery_options, emulated_journeys, hard_ground
from lithobrake.pipeline.journeys.campaign import JOURNEY_FILES, make_journeys
from lithobrake.pipeline.runs import landings
from lithobrake.pipeline.runs.beds import pour_beds
from lithobrake.pipeline.runs.run_table import file_of
from lithobrake.pipeline.sky_at_rest import look_up, sky_dependencies, sky_files
from lithobrake.study import Study
from lithobrake.study.delivery_sections import OWN_KEYS
from lithobrake.vocabulary import file_names

Asked = Callable[[Study], bool]


def drawn(study: Study) -> bool:
    """Whether landers are drawn and followed."""
    return study.design.run_count > 0


def expanded(study: Study) -> bool:
    return study.expansion is not None


def emulates_touchdowns(study: Study) -> bool:
    """Whether the emulator of all touchdowns follows landers, further ones or those of delivery options."""
    return drawn(study) and bool(study.journey.emulated_count or study.aim.names)


def sampled(study: Study) -> bool:
    return study.sample_count > 0


def files_if(asked: Asked, *names: str) -> Callable[[Study], list[str]]:
    """These files of a study that asks for them."""
    return lambda study: list(names) if asked(study) else []


# Beds and landings are known by the hash of the engine and of all that they follow from; this is how they are chosen
# and written down.
RUN_PARTS = (
    "pipeline/design", "pipeline/runs/energy_bound.py", "pipeline/runs/landings.py", "pipeline/runs/run_table.py",
    "chaos", "vocabulary/quantities.py", "geometry/attitude.py",
)  # fmt: skip
FLIGHT_PARTS = (
    "pipeline/first_touchdown/flights.py", "pipeline/first_touchdown/run_flights.py",
    "pipeline/first_touchdown/samples.py", "pipeline/site.py", "pipeline/runs/run_table.py", "smallbody", "geometry",
    "chaos", "vocabulary/clock.py", "vocabulary/constants.py", "vocabulary/known_bodies.py",
    "vocabulary/quantities.py",
)  # fmt: skip
JOURNEY_PARTS = (
    "pipeline/journeys/campaign.py", "pipeline/journeys/landers.py",
    "pipeline/journeys/first_arrivals.py", "pipeline/journeys/simulated_touchdowns.py",
    "study/delivered_states.py", "files/oem_reader.py", *RUN_PARTS, *FLIGHT_PARTS,
)  # fmt: skip
EMULATOR_PARTS = (
    "pipeline/first_touchdown/emulator.py", "pipeline/first_touchdown/explorer_tables.py",
    "pipeline/first_touchdown/samples.py", "pipeline/design/lander_attitude.py", "pipeline/runs/energy_bound.py",
    "emulator", "chaos", "analysis", "geometry/attitude.py", "results/table.py", "vocabulary/quantities.py",
)  # fmt: skip
EMULATED_PARTS = (
    *("pipeline/journeys", "pipeline/first_touchdown", "results/named_emulator.py"),
    *EMULATOR_PARTS,
    *FLIGHT_PARTS,
)
EXPANSION_PARTS = ("pipeline/expansion", "analysis", "emulator", *RUN_PARTS)
ANSWER_PARTS = (
    *("pipeline/answer", "pipeline/site.py", "pipeline/journeys", "pipeline/expansion"),
    *("analysis", "chaos", "emulator", "results", "statements", "vocabulary"),
)


def drawn_dependencies(study: Study) -> Any:
    count = study.design.run_count
    return [design_dependencies(study), place_region(study), study.seed, count, beds_of_runs(study, count)]


def journey_dependencies(study: Study) -> Any:
    # The count enters by the runs, and further emulated landers leave the journeys as they are.
    journey = study.journey.model_dump(exclude={"count", "emulated_count"})
    ground = study.has_local_ground
    return [drawn_dependencies(study), run_flight_dependencies(study), journey, ground, *_delivery(study)]


def _delivery(study: Study) -> list[Any]:
    """What the states and correlations of a delivery depend on; nothing for one that has neither."""
    if study.delivery is None:
        return []
    given = study.delivery.model_dump(include=set(OWN_KEYS), exclude_none=True)
    if study.delivery.states is not None:
        # A table counts with its content, wherever it lies.
        given["states"] = content_hash(Path(study.delivery.states))
    return [given] if given else []


def sample_dependencies(study: Study) -> Any:
    return study.monte_carlo.model_dump()


def _side_files(study: Study) -> list[str]:
    return [file_of(design) for design in SIDE_DESIGNS] if drawn(study) and study.design.side_runs else []


def _expansion(*names: str) -> Callable[[Study], Any]:
    return lambda study: None if study.expansion is None else [study.expansion.model_dump()[name] for name in names]


def _screening_dependencies(study: Study) -> Any:
    # The points of one design are best for the degree that is fitted to them.
    own = _expansion("points", "replicate_count", "screening_level", "screening_count", "screening_degree")
    return [design_dependencies(study), study.seed, own(study)]


def _sample_files(study: Study) -> list[str]:
    return [file_names.SAMPLES_FILE, file_names.EXPLORER_FILE] if sampled(study) else []


def _flight_files(study: Study) -> list[str]:
    alone = [file_names.FLIGHTS_WITHOUT_SCATTER_FILE] if study.monte_carlo.scatter else []
    return [file_names.SAMPLE_FLIGHTS_FILE, file_names.FLIGHT_CHECKS_FILE, *alone] if sampled(study) else []


def _write_report(job: Job) -> None:
    from lithobrake.report import write_report

    write_report(job.folder.path, lambda done, total: job.progress(done, total, "figures"))


BED = Stage("bed", "bed", bed_files, pour_beds, dependencies=bed_dependencies)
FIRST_LANDING = Stage(
    "landing", "preview landing", landings.landing_files, landings.land_once, ("bed",), landings.landing_dependencies
)
RUNS = Stage(
    "runs",
    "landers",
    files_if(drawn, file_of("drawn"), file_of("touchdowns"), *JOURNEY_FILES),
    make_journeys,
    ("bed",),
    journey_dependencies,
    JOURNEY_PARTS,
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
# After the side runs, since pairs and twins fly with the runs that they belong to.
FLY_RUNS = Stage(
    "fly_runs",
    "flights of the first touchdowns",
    files_if(drawn, RUN_FLIGHTS_FILE, IMPACTS),
    fly_runs,
    ("side_runs",),
    run_flight_dependencies,
    FLIGHT_PARTS,
)
# Without parts of its own: the choice of the run is made by code that is among those of the runs.
TELLING_LANDING = Stage(
    "telling_landing", "representative landing", landings.telling_files, landings.land_tellingly, ("runs",)
)
ESTIMATE = Stage(
    "estimate", "estimates", files_if(drawn, ESTIMATES_FILE), estimate, ("fly_runs",), parts=ANSWER_PARTS
)  # fmt: skip
EMULATOR = Stage(
    "emulator",
    "emulator of the first touchdown",
    files_if(drawn, file_names.EMULATOR_FILE),
    emulator.fit_emulator,
    ("runs",),
    parts=EMULATOR_PARTS,
)
SCREENING_RUNS = Stage(
    "screening_runs",
    "screening runs",
    files_if(expanded, file_of("screening")),
    expansions.make_screening_runs,
    ("bed",),
    _screening_dependencies,
    EXPANSION_PARTS,
)
SCREEN = Stage(
    "screen",
    "screening",
    files_if(expanded, file_names.SCREENING_FILE),
    expansions.fit_screening,
    ("screening_runs",),
    _expansion("fit"),
    EXPANSION_PARTS,
)
REFINED_RUNS = Stage(
    "refined_runs",
    "refined runs",
    files_if(expanded, file_of("refined")),
    expansions.make_refined_runs,
    ("screen",),
    _expansion("refined_level", "refined_count", "refined_degree", "kept_share", "kept_outputs"),
    EXPANSION_PARTS,
)
REFINE = Stage(
    "refine",
    "refinement",
    files_if(expanded, file_names.REFINED_FILE),
    expansions.fit_refined,
    ("refined_runs",),
    parts=EXPANSION_PARTS,
)
TEST_RUNS = Stage(
    "test_runs",
    "test runs",
    files_if(expanded, file_of("test_kept"), file_of("test_all")),
    expansions.make_test_runs,
    ("refined_runs",),
    _expansion("test_count"),
    EXPANSION_PARTS,
)
TEST = Stage(
    "test",
    "scores",
    files_if(expanded, file_names.SCORES_FILE),
    expansions.score_all,
    ("refine", "test_runs"),
    parts=EXPANSION_PARTS,
)
SAMPLE = Stage(
    "sample",
    "samples",
    _sample_files,
    draw_samples,
    ("emulator", "refine", "test"),
    sample_dependencies,
    (*EXPANSION_PARTS, *EMULATOR_PARTS),
)
FLY = Stage("fly", "flights", _flight_files, fly_samples, ("sample",), flight_dependencies, FLIGHT_PARTS)
PATHS = Stage(
    "paths",
    "paths of flights",
    same_files(file_names.BODY_FILE, PATHS_FILE),
    write_paths,
    ("runs", "fly"),
    run_flight_dependencies,
    FLIGHT_PARTS,
)
EMULATED = Stage(
    "emulated",
    "landers by the emulator",
    files_if(emulates_touchdowns, *emulated_journeys.EMULATED_FILES),
    emulated_journeys.make_emulated,
    ("runs",),
    emulated_journeys.emulated_dependencies,
    EMULATED_PARTS,
)
HARD_GROUND = Stage(
    "hard_ground",
    "landers on hard ground",
    hard_ground.hard_ground_files,
    hard_ground.follow_on_hard_ground,
    ("runs", "sample"),
    hard_ground.hard_ground_dependencies,
    (*EXPANSION_PARTS, *EMULATED_PARTS),
)
AIM = Stage(
    "aim",
    "delivery options",
    delivery_options.option_files,
    delivery_options.follow_options,
    ("emulated",),
    delivery_options.option_dependencies,
    (*EXPANSION_PARTS, *EMULATED_PARTS),
)
SKY = Stage(
    "sky",
    "sky over the landers at rest",
    sky_files,
    look_up,
    ("runs",),
    sky_dependencies,
    ("pipeline/sky_at_rest.py", "pipeline/site.py", *FLIGHT_PARTS),
)
SUMMARY = Stage(
    "summary",
    "summary",
    same_files(file_names.SUMMARY_FILE),
    write_summary,
    ("landing", "telling_landing", "estimate", "test", "fly", "emulated", "hard_ground", "aim", "sky"),
    summary_dependencies,
    (*EXPANSION_PARTS, *ANSWER_PARTS),
)
REPORT = Stage(
    "report",
    "report",
    same_files("report/index.html"),
    _write_report,
    ("summary", "paths"),
    no_dependencies,
    ("report", "statements", "results", "vocabulary"),
)
STAGES = (
    BED, FIRST_LANDING, RUNS, SIDE_RUNS, FLY_RUNS, TELLING_LANDING, ESTIMATE, EMULATOR, SCREENING_RUNS, SCREEN,
    REFINED_RUNS, REFINE, TEST_RUNS, TEST, SAMPLE, FLY, PATHS, EMULATED, HARD_GROUND, AIM, SKY, SUMMARY, REPORT,
)  # fmt: skip

# Of a study whose touchdowns a program makes these write nothing, and may be asked for all the same.
OF_SOIL = (BED, FIRST_LANDING, TELLING_LANDING)


def stages_until(study: Study, until: str) -> tuple[Stage, ...]:
    """The stages up to and including one, with those that write nothing of this study.

    Raises ValueError for a name of none, and for a stage that the study asks nothing of.
    """
    names = [stage.name for stage in STAGES]
    asked = [stage.name for stage in STAGES if stage.files(study) or stage in OF_SOIL]
    if until not in asked:
        raise ValueError(
            f'"{until}" is no stage of this study; allowed: {", ".join(asked)}; run all of it with: lithobrake run'
        )
    return STAGES[: names.index(until) + 1]
