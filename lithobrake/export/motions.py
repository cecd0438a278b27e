"""The landing that an export shows: the one that a study keeps, or that of a run, made again."""

from collections.abc import Callable
from functools import lru_cache

from lithobrake.results import MovingBodies, StudyResults


# Two kinds of files show one landing, which may take minutes to make again.
@lru_cache(maxsize=1)
def named_landing(
    results: StudyResults, run: str | int | None, progress: Callable[[float, str], None]
) -> MovingBodies:  # fmt: skip
    """The landing of a run, made again, or for None the one that the study keeps."""
    return results.median_landing if run is None else results.landing_bodies(run, progress=progress)
