"""A motion as a file of the kind that its name ends with, and the contact sheet, which needs nothing but Matplotlib."""

from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.atomic import atomic_path
from lithobrake.view.film import KINDS, film
from lithobrake.view.vtkhdf import write_vtkhdf
from lithobrake.vocabulary.progress import Progress, silent

if TYPE_CHECKING:
    from lithobrake.results.moving_bodies import MovingBodies

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
