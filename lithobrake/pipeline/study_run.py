"""Running a study file in a folder."""

from collections.abc import Callable
from pathlib import Path

from lithobrake import study_file
from lithobrake.atomic import atomic_path
from lithobrake.campaign import LocalExecutor
from lithobrake.pipeline.folder import StudyFolder
from lithobrake.pipeline.job import Job, Progress
from lithobrake.pipeline.stages import make


def run_study(
    path: Path,
    out: Path,
    *,
    worker_count: int | None = None,
    until: str = "report",
    begin: Callable[[str, int, int], None] = lambda title, number, count: None,
    progress: Progress = lambda done, total, what: None,
) -> None:
    """Make what a study file asks for, up to and with a stage; what the folder already has is kept.

    begin(title, number, count) is called as each stage begins, progress(done, total, what) within it.
    Raises ValueError for a study file that is refused, a folder that cannot be written, too few runs with outputs.
    """
    study, tables = study_file.read(path), study_file.load(path)
    folder = StudyFolder(out)
    with folder.alone(), LocalExecutor(worker_count) as executor:
        with atomic_path(folder / "study.toml") as draft:
            draft.write_bytes(path.read_bytes())
        try:
            make(Job(study, tables, folder, executor, progress), until, begin)
        except BaseException:
            # What is under way would be waited for otherwise; every finished run is in the ledger already.
            executor.shutdown(cancel_futures=True)
            raise
