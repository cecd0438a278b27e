"""A motion as a file of the kind that its name ends with."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.view.contact_sheet import contact_sheet
from lithobrake.view.film import KINDS, film
from lithobrake.view.vtkhdf import write_vtkhdf

if TYPE_CHECKING:
    from lithobrake.results.moving_bodies import MovingBodies

ALL_KINDS = (".vtkhdf", *KINDS, ".png")


def refuse_other_kinds(path: Path, kinds: tuple[str, ...] = ALL_KINDS) -> None:
    """Raise ValueError for a name that ends otherwise."""
    if path.suffix not in kinds:
        raise ValueError(f"--out is {str(path)!r}; allowed: a name that ends in {', '.join(kinds)}")


def write_motion(
    bodies: "MovingBodies",
    path: Path,
    seconds: float = 8.0,
    progress: Callable[[float], None] = lambda fraction: None,
) -> None:
    """Write a motion for ParaView (.vtkhdf), as a film of so many seconds (.mp4, .webp), or on a sheet (.png)."""
    refuse_other_kinds(path)
    if path.suffix == ".vtkhdf":
        write_vtkhdf(bodies, path)
    elif path.suffix == ".png":
        contact_sheet(bodies, path)
    else:
        film(bodies, path, seconds, progress)
