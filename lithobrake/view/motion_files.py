"""A motion or a whole journey as a file of the kind that its name ends with."""

from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.atomic import atomic_path, write_whole
from lithobrake.view.film import KINDS, film, journey_film
from lithobrake.view.motion import write_vtkhdf
from lithobrake.vocabulary.progress import Progress, silent

if TYPE_CHECKING:
    from lithobrake.results import JourneyMotion
    from lithobrake.results.motions import MovingBodies

ALL_KINDS = (".vtkhdf", *KINDS, ".png")
# Of a contact sheet.
PICTURES = 12


def refuse_other_kinds(path: Path, kinds: tuple[str, ...] = ALL_KINDS) -> None:
    """Raise ValueError for a name that ends otherwise."""
    if path.suffix not in kinds:
        raise ValueError(f"--out is {str(path)!r}; allowed: a name that ends in {', '.join(kinds)}")


def write_motion(bodies: "MovingBodies", path: Path, seconds: float = 8.0, progress: Progress = silent) -> None:
    """Write a motion for ParaView (.vtkhdf), as a film of so many seconds (.mp4, .webp), or on a sheet (.png)."""
    refuse_other_kinds(path)
    if path.suffix == ".vtkhdf":
        write_vtkhdf(bodies, path)
    elif path.suffix == ".png":
        contact_sheet(bodies, path)
    else:
        film(bodies, path, seconds, progress)


def contact_sheet(bodies: "MovingBodies", path: str | Path, picture_count: int = PICTURES) -> None:
    """Write a PNG with so many pictures of a landing, half of them up to its deepest point, each with its time [s].

    Of ground that repeats the images around the lander's way are drawn. Raises ValueError for bodies that are no
    landing.
    """
    from lithobrake.report.figures.hulls import scene
    from lithobrake.report.figures.landing_figure import landing_figure
    from lithobrake.report.figures.style import figure_style

    if bodies.attributes.get("format") != "lithobrake landing":
        raise ValueError(
            f"{bodies.attributes.get('format', 'the motion')} is no landing, and a contact sheet shows one; "
            "take a file that ends in .vtkhdf, .mp4 or .webp for other motions"
        )
    with figure_style(), atomic_path(path) as draft:
        figure = landing_figure(scene(bodies, has_lander=True), picture_count)
        figure.savefig(draft, format="png")


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
        from lithobrake.report.figures.landing_figure import journey_sheet

        write_whole(path, journey_sheet(motion))
    else:
        from lithobrake.report.pages.journey_page import one_journey_page

        write_whole(path, one_journey_page(motion))
    return [path]


def touchdown_paths(path: Path, count: int) -> list[Path]:
    """Names of a file for each touchdown: the number stands behind the stem."""
    return [path.with_name(f"{path.stem}_{number}{path.suffix}") for number in range(count)]


def written_over(path: Path) -> list[Path]:
    """What a journey of any number of touchdowns may replace."""
    return sorted(path.parent.glob(f"{path.stem}_[0-9]*{path.suffix}")) if path.suffix in FILE_EACH else [path]
