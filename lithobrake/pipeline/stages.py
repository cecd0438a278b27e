"""The stages of a study in order, by its method; each is declared in the room that makes its files."""

from lithobrake.pipeline.answer import stages as answer
from lithobrake.pipeline.emulate import stages as emulate
from lithobrake.pipeline.emulated import stages as emulated
from lithobrake.pipeline.fly import stages as fly
from lithobrake.pipeline.job import Job
from lithobrake.pipeline.journeys import stages as journeys
from lithobrake.pipeline.paper import stages as paper
from lithobrake.pipeline.rest import stages as rest
from lithobrake.pipeline.runs import stages as runs
from lithobrake.pipeline.sky import stages as sky
from lithobrake.pipeline.stage import Stage, same_files
from lithobrake.study import Study


def _write_report(job: Job) -> None:
    from lithobrake.report import write_report

    write_report(job.folder.path, lambda done, total: job.progress(done, total, "figures"))


REPORT = Stage(
    "report",
    "report",
    same_files("report/index.html"),
    _write_report,
    ("summary",),
    parts=("report", "results", "vocabulary"),
)
DRAWN = (
    runs.BED,
    runs.FIRST_LANDING,
    runs.DRAWN_RUNS,
    runs.SIDE_RUNS,
    fly.FLY_RUNS,
    runs.TELLING_LANDING,
    answer.ESTIMATE,
    emulate.EMULATOR,
    emulate.SAMPLE,
    fly.FLY,
    rest.REST,
    rest.AIM,
    answer.SUMMARY,
    REPORT,
)
# Landings that follow each other until the lander rests, in the place of single ones, and journeys by their emulator.
JOURNEYS = (
    runs.BED,
    runs.FIRST_LANDING,
    journeys.JOURNEYS,
    runs.SIDE_RUNS,
    fly.FLY_RUNS,
    runs.TELLING_LANDING,
    answer.ESTIMATE,
    emulated.EMULATED,
    emulated.OPTIONS,
    sky.SKY,
    answer.JOURNEY_SUMMARY,
    REPORT,
)
PAPER = (
    runs.BED,
    paper.MEDIAN_LANDING,
    paper.SCREENING_RUNS,
    paper.SCREEN,
    paper.REFINED_RUNS,
    paper.REFINE,
    paper.TEST_RUNS,
    paper.TEST,
    paper.SAMPLE,
    paper.FLY,
    paper.REST,
    paper.SUMMARY,
    REPORT,
)


def stages_of(study: Study) -> tuple[Stage, ...]:
    """The stages of a study in order, by its method."""
    if study.design.method == "paper":
        return PAPER
    return DRAWN if study.journey is None else JOURNEYS


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
