"""What commands do with one journey: follow it, write its files, open windows on its touchdowns."""

from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.cli.arguments import refuse_written
from lithobrake.cli.terminal import shown_progress, tell

if TYPE_CHECKING:
    from lithobrake.pipeline import OneJourney
    from lithobrake.results import JourneyMotion
    from lithobrake.study import Study


def refuse_journey_file(out: Path, force: bool, also: tuple[str, ...] = ()) -> None:
    """Raise ValueError for a file of another kind, but for these, and for one that exists unless it may be replaced."""
    from lithobrake.view import refuse_other_kinds
    from lithobrake.view.journey_files import JOURNEY_KINDS, written_over

    refuse_other_kinds(out, (*JOURNEY_KINDS, *also))
    for path in written_over(out):
        refuse_written(path, force)


def follow(
    study: "Study", values: dict[str, float], out: Path | None, is_told: bool
) -> "tuple[OneJourney, list[Path]]":
    """Follow a lander to its end and keep its motion; is_told: whether lines are printed as it goes."""
    from lithobrake.pipeline import follow_one
    from lithobrake.view.journey_files import touchdown_paths, write_journey

    with shown_progress("journey") as progress:
        found = follow_one(study, values, (lambda line: tell([line])) if is_told else (lambda line: None), progress)
        if is_told:
            tell([found.track.end_words])
        if out is None:
            return found, []
        if out.suffix == ".h5":
            paths = touchdown_paths(out, len(found.landings))
            found.save(paths)
            return found, paths
        return found, write_journey(found.motion(), out, progress=progress)


def show_touchdowns(motion: "JourneyMotion") -> None:
    """Open a window on each touchdown, the next one when it is closed."""
    from lithobrake.view import show

    for bodies in motion.bodies:
        show(bodies)
