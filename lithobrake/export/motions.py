"""A landing and the bed under it for ParaView, and the landing as one picture."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path

from lithobrake.results import MovingBodies, StudyResults
from lithobrake.view import contact_sheet, write_vtkhdf


def write_motions(results: StudyResults, folder: Path, landing: MovingBodies, name: str) -> list[Path]:
    """Write a landing, and how the first bed was poured and settled, as VTKHDF files; their paths."""
    # Of the other beds a study keeps no pictures.
    moving = {folder / f"{name}.vtkhdf": landing, folder / "bed_0.vtkhdf": results.bed_bodies(0)}
    for path, bodies in moving.items():
        write_vtkhdf(bodies, path)
    return list(moving)


def write_sheet(folder: Path, landing: MovingBodies, name: str) -> Path:
    """Write a landing as frames on a contact sheet; its path."""
    path = folder / f"{name}.png"
    contact_sheet(landing, path)
    return path


# Two kinds of files show one landing, which may take minutes to make again.
@lru_cache(maxsize=1)
def named_landing(
    results: StudyResults, run: str | int | None, progress: Callable[[float, str], None]
) -> tuple[MovingBodies, str]:
    """The landing of a run, made again, or for None the one that the study keeps; and the name of its files."""
    if run is None:
        return results.median_landing, "landing"
    return results.landing_bodies(run, progress=progress), f"landing_{run}"
