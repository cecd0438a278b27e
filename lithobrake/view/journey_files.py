"""A whole journey as a file of the kind that its name ends with: a page, a film, a sheet, or one file a touchdown."""

from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.atomic import atomic_path
from lithobrake.view.files import refuse_other_kinds
from lithobrake.view.film import KINDS, journey_film
from lithobrake.view.vtkhdf import write_vtkhdf
from lithobrake.vocabulary.progress import Progress, silent

if TYPE_CHECKING:
    from lithobrake.results import JourneyMotion

JOURNEY_KINDS = (".html", *KINDS, ".png", ".vtkhdf")
# Of these kinds each touchdown has a file of its own.
FILE_EACH = (".vtkhdf", ".h5")


def write_journey(motion: "JourneyMotion", path: Path, seconds: float = 8.0, progress: Progress = silent) -> list[Path]:
    """Write a journey and give the paths of its files.

    A page with every touchdown to turn (.html), a film of so many seconds a touchdown (.mp4, .webp), a sheet with the
    map and pictures of each touchdown (.png), or for ParaView a file a touchdown, NAME_0.vtkhdf and on.
    """
    refuse_other_kinds(path, JOURNEY_KINDS)
    if path.suffix == ".vtkhdf":
        paths = touchdown_paths(path, len(motion.bodies))
        for bodies, one in zip(motion.bodies, paths, strict=True):
            write_vtkhdf(bodies, one)
        return paths
    if path.suffix in KINDS:
        journey_film(motion, path, seconds, progress)
    elif path.suffix == ".png":
        from lithobrake.report.figures.journey_sheet import journey_sheet

        with atomic_path(path) as draft:
            draft.write_bytes(journey_sheet(motion))
    else:
        from lithobrake.report.pages.one_journey_page import one_journey_page

        with atomic_path(path) as draft:
            draft.write_text(one_journey_page(motion), encoding="utf-8")
    return [path]


def touchdown_paths(path: Path, count: int) -> list[Path]:
    """Names of a file for each touchdown: the number stands behind the stem."""
    return [path.with_name(f"{path.stem}_{number}{path.suffix}") for number in range(count)]


def written_over(path: Path) -> list[Path]:
    """What a journey of any number of touchdowns may replace."""
    return sorted(path.parent.glob(f"{path.stem}_[0-9]*{path.suffix}")) if path.suffix in FILE_EACH else [path]
