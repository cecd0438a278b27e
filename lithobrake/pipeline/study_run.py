"""Running a study file in a folder, and writing the report of a folder again."""

import os
import shutil
import tempfile
import time
import weakref
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from lithobrake.campaign import DaskExecutor, LocalExecutor
from lithobrake.campaign.model_server import PREFIX
from lithobrake.campaign.single_run import Model
from lithobrake.campaign.worker import refuse_while_importing
from lithobrake.chaos.training_data import one_thread
from lithobrake.pipeline.answer.run_answers import ANSWERED_AFTER
from lithobrake.pipeline.design.drawn_design import DrawnDesign
from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.folder_state import grouped, read_state
from lithobrake.pipeline.job import Job, Silent, StudyProgress
from lithobrake.pipeline.outdated_files import make, setting
from lithobrake.pipeline.planning.plan import brief_lines
from lithobrake.pipeline.planning.planner import plan_of
from lithobrake.pipeline.runs.solver import function_identity
from lithobrake.pipeline.sequential_sampling import grow, grown
from lithobrake.pipeline.site import with_site_gravity
from lithobrake.pipeline.sky_at_rest import refuse_hidden_orbiter
from lithobrake.pipeline.stages import stages_until
from lithobrake.pipeline.study_folder import NAME, StudyFolder, refuse_others_folder
from lithobrake.report.plotted_study import PlottedStudy
from lithobrake.study import StudySource
from lithobrake.vocabulary.plain_text import in_lines


def run(
    study: str | os.PathLike[str] | Mapping[str, Any],
    out: str | os.PathLike[str] | None = None,
    *,
    workers: int | None = None,
    model: Model | None = None,
    report: bool = True,
    progress: StudyProgress | None = None,
) -> PlottedStudy:
    """Run a study to its end and return its results; reuse what its folder already has.

    study: path of a study file, the name of a study that comes with the package ("quick"; `lithobrake examples` lists
    them), or tables as a dict, in which relative paths count from the current folder and numbers may be NumPy's.
    out: folder of the study; None: runs/NAME, after the name of the file. Tables have no name: without a folder they
    run in a temporary one, which goes with the results; `results.save(folder)` keeps it.
    workers: number of processes; None: one a core. They import the script that calls this only where it defines the
    model: such a script calls it under `if __name__ == "__main__":`.
    model: a callable that can be pickled, `(inputs, seed) -> {"outcome": ..., "outputs": {...}}`, which makes the
    touchdowns in place of the soil, under the contract of docs/own_solver.md (outcomes clear, captured, left_sideways,
    time_limit). No bed is poured for it. Its inputs are all numbers of the study by dotted key and what the run drew.
    It is identified by its pickle, which holds the name of a function and not its body: after an edit, use another
    `out`.
    report: also make the page.
    progress: shows the stages as they run, as lithobrake.progress.study_progress() does; None: silence.
    Raises ValueError for a study or folder that is refused, too few runs with outputs, a model that cannot be pickled.
    """
    refuse_while_importing()
    # Before the study is read, as the checks of a study depend on whether a function makes its touchdowns.
    function = None if model is None else function_identity(model)
    if isinstance(study, Mapping):
        source = StudySource.of_tables(study, function)
    else:
        source = StudySource.read(Path(study), function)
    return _run(source, out, model, workers, report, progress)


class Study:
    """A study that is written in Python: a keyword for each table and key at the top of a study file.

    `Study(lander={"shape": "box", ...}, grain={...}, seed=2).run()`; docs/study_file.md has them all. Numbers may be
    NumPy's, and relative paths count from the current folder.
    """

    def __init__(self, *, model: Model | None = None, **tables: Any) -> None:
        """Check the tables as those of a study file are.

        model: makes the touchdowns in place of the soil, as in lithobrake.run(). Raises ValueError with a sentence for
        each problem.
        """
        self._model = model
        self._source = StudySource.of_tables(tables, None if model is None else function_identity(model))

    def run(
        self,
        out: str | os.PathLike[str] | None = None,
        *,
        workers: int | None = None,
        report: bool = True,
        progress: StudyProgress | None = None,
    ) -> PlottedStudy:
        """Run the study to its end and return its results; all arguments are those of lithobrake.run()."""
        refuse_while_importing()
        return _run(self._source, out, self._model, workers, report, progress)

    def __repr__(self) -> str:
        """Name its title and its tables."""
        title = self._source.study.title
        return in_lines(f"Study{f' {title!r}' if title else ''} of {', '.join(self._source.tables)}", "  ")


def _run(
    source: StudySource,
    out: str | os.PathLike[str] | None,
    model: Model | None,
    workers: int | None,
    report: bool,
    progress: StudyProgress | None,
) -> PlottedStudy:
    """Run a study that was checked; see run()."""
    lacking = [name for name in ("begin", "say", "progress") if progress and not hasattr(progress, name)]
    if lacking:
        raise ValueError(
            f"progress is {progress!r}, which has no {', '.join(lacking)}; allowed: None, or what "
            "lithobrake.progress.study_progress() gives"
        )
    # An empty text, as of a variable that is not set, would mean the current folder.
    if not str(out).strip():
        raise ValueError(f"out is {str(out)!r}; allowed: the path of a folder; leave it out for {_default(source)}")
    until, is_temporary = "report" if report else "summary", out is None and source.path is None
    folder = Path(tempfile.mkdtemp(prefix="lithobrake-")) if is_temporary else Path(out or Path("runs") / source.stem)
    try:
        run_study(source, folder, until=until, worker_count=workers, model=model, shown=progress)
        results = PlottedStudy(folder)
    except BaseException:
        if is_temporary:
            shutil.rmtree(folder, ignore_errors=True)
        raise
    if is_temporary:
        # With the last of what reads in it, or as Python ends.
        weakref.finalize(results, shutil.rmtree, folder, ignore_errors=True)
    return results


def _default(source: StudySource) -> str:
    """The folder of a study for which none is given, in words."""
    return "a temporary folder" if source.path is None else f"runs/{source.stem}"


def _say_solver(command: str | None, shown: StudyProgress) -> None:
    if command:
        what = "model of a server, which every remaining run calls"
        if not command.startswith(PREFIX):
            what = "program, which every remaining run starts"
        shown.say(f"This study names a {what}: {command}")


def run_study(
    source: StudySource,
    out: Path,
    *,
    until: str = "report",
    worker_count: int | None = None,
    scheduler: str | None = None,
    model: Model | None = None,
    shown: StudyProgress | None = None,
    keeps_logs: bool = False,
) -> None:
    """Run the stages of a study up to and including `until`; reuse what the folder already has.

    worker_count: number of processes here; None: one a core.
    scheduler: address of a Dask scheduler, whose workers make the runs instead.
    model: makes the touchdowns in place of the soil.
    shown: shows the progress. keeps_logs: each run leaves a log in the folder.
    Raises ValueError for a study that is refused, a folder that is not the study's or cannot be written, too few runs
    with outputs.
    """
    shown = shown or Silent()
    study = with_site_gravity(source.study)
    # Refuses a stage that the method does not have, before anything is made.
    stages_until(study, until)
    drawn = DrawnDesign(study)
    Soils(drawn.site).refuse()
    refuse_hidden_orbiter(drawn.site)
    refuse_others_folder(source, out)
    _say_solver(study.solver.command, shown)
    # The bits of a least-squares fit depend on the threads of the linear algebra. A folder is made once there is who
    # works in it.
    with (
        one_thread(),
        DaskExecutor(scheduler) if scheduler is not None else LocalExecutor(worker_count) as executor,
        (folder := StudyFolder(out)).alone() as note,
    ):
        design = grown(drawn, folder)
        folder.begin(source.path, source.content, setting(design.study), shown.say)
        if until == "report":
            plan = plan_of(design, source.stem, folder, worker_count, on_cluster=scheduler is not None)
            command = f"lithobrake plan {source.path or 'STUDY.toml'} --out {folder.path}"
            for line in brief_lines(plan, command) if plan.stages else ():
                shown.say(line)
        try:
            _make_all(Job(design, source.tables, folder, executor, shown, model, keeps_logs), source, until, note)
        except BaseException:
            # What is under way would be waited for otherwise; every finished run is in the ledger already.
            executor.shutdown(cancel_futures=True)
            raise


def _make_all(job: Job, source: StudySource, until: str, note: Callable[..., None]) -> None:
    def make_runs(job: Job) -> None:
        # The setting follows from the number of runs, which grows.
        job.folder.begin(source.path, source.content, setting(job.study), job.say)
        # While further beds are poured, whoever looks still finds the runs that there are.
        job.folder.note_runs("drawn", job.design.keys)
        make(job, ANSWERED_AFTER, note)

    names = [stage.name for stage in stages_until(job.study, until)]
    if job.study.design.half_width is not None and ANSWERED_AFTER in names:
        job = grow(job, make_runs)
    make(job, until, note)


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
