"""A landing as frames on one sheet: a picture to print or to put in a paper, which needs nothing beside Matplotlib."""

from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.atomic import atomic_path

if TYPE_CHECKING:
    from lithobrake.results.moving_bodies import MovingBodies

PICTURES = 12


def contact_sheet(bodies: "MovingBodies", path: str | Path, picture_count: int = PICTURES) -> None:
    """Write a PNG with so many pictures of a landing, half of them up to its deepest point, each with its time [s].

    Raises ValueError for bodies that are no landing in a box.
    """
    from lithobrake.report.figures.hulls import scene
    from lithobrake.report.figures.landing_figure import landing_figure
    from lithobrake.report.figures.style import figure_style

    if bodies.attributes.get("format") != "lithobrake landing":
        raise ValueError(
            f"{bodies.attributes.get('format', 'the motion')} is no landing, and a contact sheet shows one; "
            "take a file that ends in .vtkhdf, .mp4 or .webp for other motions"
        )
    east, north = bodies.attributes["width"]
    with figure_style(), atomic_path(path) as draft:
        figure = landing_figure(
            *(scene(bodies, has_lander=True).bodies, bodies.time, bodies.position, bodies.orientation),
            *((east, north), picture_count),
        )
        figure.savefig(draft, format="png")
