"""Running a study file in a folder, and writing the report of a folder again."""

import time
from collections.abc import Callable
from pathlib import Path

from lithobrake.campaign import DaskExecutor, LocalExecutor
from lithobrake.pipeline.folder import StudyFolder
from lithobrake.pipeline.job import Job, Progress
from lithobrake.pipeline.notes import NAME
from lithobrake.pipeline.owner import refuse_others_folder
from lithobrake.pipeline.plan import plan_of
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.stages import make, setting
from lithobrake.pipeline.state import grouped, read_state
from lithobrake.study import Study, load_tables, read_study


def run_study(
    path: Path,
    out: Path,
    *,
    worker_count: int | None = None,
    scheduler: str | None = None,
    until: str = "report",
    begin: Callable[[str, int, int], None] = lambda title, number, count: None,
    progress: Progress = lambda done, total, what, detail="": None,
    say: Callable[[str], None] = lambda sentence: None,
    keeps_logs: bool = False,
) -> None:
    """Make what a study file asks for, up to and with a stage; what the folder already has is kept.

    worker_count: processes here (None: one for each core); scheduler: address of a Dask scheduler, whose workers make
    the runs instead. begin(title, number, count) is called as each stage begins, progress(done, total, what, detail)
    within it, say with a sentence that the user should read. keeps_logs: each run leaves a log in the folder.
    Raises ValueError for a study file that is refused, a folder that is not the study's or cannot be written, too few
    runs with outputs.
    """
    study, tables = with_site_gravity(read_study(path), path.name), load_tables(path)
    refuse_others_folder(path, out)
    if study.solver.command:
        say(f"This study names a program, which every run that is still to be made starts: {study.solver.command}")
    folder = StudyFolder(out)
    with folder.alone() as note, DaskExecutor(scheduler) if scheduler else LocalExecutor(worker_count) as executor:
        folder.begin(path, setting(study), say)

        if until == "report":
            _say_plan(study, path, folder, worker_count, scheduler, say)

        def begin_and_note(title: str, number: int, count: int) -> None:
            note(stage=title, number=number, count=count)
            begin(title, number, count)

        try:
            make(Job(study, tables, folder, executor, progress, say, keeps_logs), until, begin_and_note)
        except BaseException:
            # What is under way would be waited for otherwise; every finished run is in the ledger already.
            executor.shutdown(cancel_futures=True)
            raise


def write_report_again(path: Path) -> None:
    """Write the report of a study's folder again. Raises ValueError when its files do not belong together."""
    if not (path / NAME).is_file():
        # Nothing is to be made in a folder that is none of a study.
        raise ValueError(read_state(path).unknown)
    folder = StudyFolder(path, f"no report can be written there; copy {path} to where you may write")
    with folder.alone():
        state = read_state(path)
        wrong = grouped([stage for stage in state.stages if stage.name != "report"])
        if state.unknown or wrong:
            mixed = f"{path} has no files that make one report ({wrong}); make them with: {state.command}"
            raise ValueError(state.unknown or mixed)
        from lithobrake.report import write_report

        started, stage = time.perf_counter(), state.notes.stages["report"]
        write_report(path)
        folder.note("report", stage["files"], stage["key"], time.perf_counter() - started)


def _say_plan(
    study: Study, path: Path, folder: StudyFolder, worker_count: int | None, scheduler: str | None,
    say: Callable[[str], None],
) -> None:  # fmt: skip
    """Say what will be made, where anything is left to be."""
    plan = plan_of(study, path.stem, folder, worker_count, on_cluster=scheduler is not None)
    for line in plan.brief(f"lithobrake plan {path}") if plan.stages else ():
        say(line)
