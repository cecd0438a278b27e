"""Runs that a folder's ledger has already."""

from lithobrake.campaign import Record, read_records
from lithobrake.pipeline.folder.study_folder import StudyFolder
from lithobrake.study import Study


def known_runs(study: Study, folder: StudyFolder) -> dict[str, Record]:
    """Runs of the folder's ledger, by key, that are not made again; none where there is no ledger.

    Raises ValueError for a file that is no ledger.
    """
    path = folder / "runs.sqlite"
    records = read_records(path) if path.is_file() else []
    tries = study.campaign.retry_count
    return {
        entry.key: entry
        for entry in records
        if entry.status == "done" or (entry.status == "failed" and entry.attempts > tries)
    }
