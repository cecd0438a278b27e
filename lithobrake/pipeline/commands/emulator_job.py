"""A job that asks the emulator of all touchdowns of a study, made first, and refusals of studies without it."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from lithobrake.campaign import DaskExecutor, LocalExecutor
from lithobrake.campaign.single_run import Model
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.job import Job, StudyProgress
from lithobrake.pipeline.journeys.touchdown_emulator import TOUCHDOWN_EMULATOR_FILE, why_no_emulator
from lithobrake.pipeline.sequential_sampling import grown
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.stages import emulates_touchdowns
from lithobrake.pipeline.study_folder import StudyFolder
from lithobrake.pipeline.study_run import run_study
from lithobrake.study import Study, StudySource
from lithobrake.vocabulary.constants import REFIT_COUNT

# The stage whose emulator is asked.
UNTIL = "emulated"
# Landers of all questions together: they are followed at once, in arrays.
MOST_LANDERS = 2_000_000


@contextmanager
def emulator_job(
    source: StudySource,
    out: Path,
    title: str,
    *,
    worker_count: int | None,
    scheduler: str | None,
    model: Model | None,
    shown: StudyProgress,
) -> Iterator[Job]:
    """The job of a study whose journeys and emulator are there, made first as by `run_study`.

    title: of what begins. Raises ValueError for journeys that tell no emulator, and for what `run_study` refuses.
    """
    run_study(source, out, until=UNTIL, worker_count=worker_count, scheduler=scheduler, model=model, shown=shown)
    study, folder = with_site_gravity(source.study), StudyFolder(out)
    why = why_no_emulator(folder.read_json(TOUCHDOWN_EMULATOR_FILE))
    if why is not None:
        raise ValueError(f"{out} has no emulator of touchdowns. {why} Follow more journeys (journey.count).")
    with folder.alone(), DaskExecutor(scheduler) if scheduler is not None else LocalExecutor(worker_count) as executor:
        job = Job(grown(DrawnDesign(study), folder), source.tables, folder, executor, shown, model)
        shown.begin(title, 1, 1)
        yield job


def refuse_no_emulator(study: Study, what: str) -> None:
    """Raise ValueError, with what asks, for a study that has no emulator of all touchdowns."""
    if not emulates_touchdowns(study):
        lacking = "journey.emulated_count" if study.design.run_count else "design.run_count"
        raise ValueError(
            f"{what} asks the emulator of all touchdowns, and this study has none; set {lacking} above 0 to fit it"
        )


def refuse_lander_count(count: int, usual: int) -> None:
    """Raise ValueError for landers of a question that the refits of the emulator cannot share.

    The scatter between refits is its error, so each has as many landers, and two of one refit are the fewest that
    scatter.
    """
    if count < 2 * REFIT_COUNT or count % REFIT_COUNT:
        raise ValueError(
            f"--landers is {count}; allowed: multiples of {REFIT_COUNT} from {2 * REFIT_COUNT}; take {usual}"
        )
