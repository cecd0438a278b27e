"""Commands that show the results of a study, and one journey of it."""

import shutil
import sys
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lithobrake.cli import arguments
from lithobrake.vocabulary.callbacks import Progress, silent
from lithobrake.vocabulary.file_names import STUDY_FILE

if TYPE_CHECKING:
    from lithobrake.results import JourneyMotion
    from lithobrake.results.motions import MovingBodies
    from lithobrake.results.study_results import StudyResults

JourneyNumber = Annotated[
    int | None, typer.Option("--journey", metavar="N", help="Show all touchdowns of this journey, from 0.")
]
# What `runs` lists first, in columns with these heads, and the most characters of a line.
TOLD = {
    "journey": ("", "journey"),
    "touchdown": ("touch-", "down"),
    "speed_out": ("rebound", "speed"),
    "bed": ("", "bed"),
    "impact.place.x": ("impact", "x"),
    "impact.place.y": ("impact", "y"),
}
LISTED = 100
COMPARISON = "comparison"


def refuse_motion_file(out: Path, force: bool, seconds: float = 8.0, also: tuple[str, ...] = ()) -> None:
    """Raise ValueError for a file of a landing that is of another kind, but for these, or exists and is not replaced,
    and for a film of no length [s].
    """
    from lithobrake.view.motion_files import ALL_KINDS, refuse_film, refuse_other_kinds

    refuse_other_kinds(out, (*ALL_KINDS, *also))
    arguments.refuse_written(out, force)
    refuse_film(out, seconds)


def refuse_journey_file(out: Path, force: bool, also: tuple[str, ...] = (), seconds: float = 8.0) -> None:
    """The same of a file of a journey, some of which have a file for each touchdown."""
    from lithobrake.view.motion_files import JOURNEY_KINDS, refuse_film, refuse_other_kinds, written_over

    refuse_other_kinds(out, (*JOURNEY_KINDS, *also))
    for path in written_over(out):
        arguments.refuse_written(path, force)
    refuse_film(out, seconds)


def show_touchdowns(motion: "JourneyMotion") -> None:
    from lithobrake.view import show

    for bodies in motion.bodies:
        show(bodies)


@arguments.command(arguments.LOOK, "report runs/study")
def report(folder: arguments.StudyDirectory) -> None:
    """Write the report of a study again from its files."""
    from lithobrake.pipeline import write_report_again

    write_report_again(folder)
    arguments.tell(arguments.study_headline(folder))


@arguments.command(arguments.LOOK, "runs runs/study --csv > runs.csv")
def runs(
    folder: arguments.StudyDirectory,
    csv: Annotated[bool, typer.Option("--csv", help="Print every column as CSV.")] = False,
    json: arguments.Json = False,
) -> None:
    """List the runs of a study: outcome, rebound speed, bed and impact point of each."""
    from lithobrake.campaign import run_lines, write_csv
    from lithobrake.results import open_study

    records = open_study(folder).ledger
    units: dict[str, str] = {}
    # The names of a campaign that is no study are its author's, and so are their units.
    if (folder / STUDY_FILE).is_file():
        from lithobrake.study.units import run_units

        units = run_units()
    if csv and json:
        raise ValueError("--csv and --json are two forms of one list; give one of them")
    if json:
        arguments.tell_json({"units": units, "runs": [asdict(record) for record in records]})
        return
    if csv:
        with arguments.reader_may_leave():
            write_csv(records, sys.stdout, units)
        return
    # Of one width where there is no terminal, so that a list in a file is the same wherever it was made.
    width = min(shutil.get_terminal_size().columns, LISTED) if sys.stdout.isatty() else LISTED
    arguments.tell(run_lines(records, units, width, TOLD))


@arguments.command(arguments.LOOK, "view runs/study")
def view(
    folder: arguments.StudyDirectory,
    solid: Annotated[bool, typer.Option("--3d", help="Show a landing in a window instead (PyVista).")] = False,
    run: Annotated[str | None, typer.Option("--run", metavar="ID", help="Run to show with --3d.")] = None,
    journey: JourneyNumber = None,
) -> None:
    """Open the report of a study, or a page about one journey, in the browser."""
    if journey is not None:
        _view_journey(folder, journey, run, solid)
        return
    if run is not None and not solid:
        raise ValueError(
            f"--run {run} is given without --3d, and the report shows no single run; add --3d or omit --run"
        )
    if solid:
        from lithobrake.results import open_study
        from lithobrake.view import show

        show(_landing(open_study(folder), run))
        return
    from lithobrake.pipeline import report_page

    page, doubt = report_page(folder)
    arguments.tell([doubt] if doubt else [])
    _open(page)


@arguments.command(arguments.LOOK, "film runs/study --run 3 --out landing.mp4")
def film(
    folder: arguments.StudyDirectory,
    run: Annotated[
        str | None, typer.Option("--run", metavar="ID", help="The run; default: the preview landing.")
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="FILE",
            help="A film (.mp4, .webp), a sheet of pictures (.png), or .vtkhdf for ParaView; default: DIR/landing.mp4.",
        ),
    ] = None,
    seconds: Annotated[
        float, typer.Option("--seconds", metavar="S", help="Duration of the film, or of each touchdown in it, seconds.")
    ] = 8.0,
    journey: JourneyNumber = None,
    force: arguments.Force = False,
) -> None:
    """Simulate a landing or a journey of a study again, and write it as a film."""
    what = "landing" if journey is None else "journey"
    path = out or folder / ("landing.mp4" if journey is None else f"journey_{journey}.mp4")
    _refuse_both(journey, run)
    from lithobrake.results import open_study
    from lithobrake.view import write_journey, write_motion

    results = open_study(folder)
    results.refuse_unknown_motion()
    # Before the landings, which take minutes.
    if journey is None:
        refuse_motion_file(path, force, seconds)
    else:
        refuse_journey_file(path, force, seconds=seconds)
    paths = [path]
    with arguments.shown_progress(what) as progress:
        if journey is None:
            write_motion(_landing(results, run, progress), path, seconds, progress)
        else:
            paths = write_journey(results.journey(journey).motion(progress=progress), path, seconds, progress)
    arguments.tell(f"Film: {one.resolve()}" for one in paths)


@arguments.command(arguments.LOOK, "compare runs/soft runs/stiff --out runs/soft_stiff")
def compare(
    first: Annotated[Path, typer.Argument(metavar="A", help="The folder of a study.", show_default=False)],
    second: Annotated[Path, typer.Argument(metavar="B", help="The folder of the other study.", show_default=False)],
    out: Annotated[str, typer.Option("--out", metavar="DIR", help="Folder of the page.")] = COMPARISON,
    json: arguments.Json = False,
    force: arguments.Force = False,
) -> None:
    """Compare two studies run by run: the difference of every result with its interval, as a page and as JSON."""
    place = arguments.given_folder(out, COMPARISON)
    from lithobrake.files.atomic import refuse_existing
    from lithobrake.pipeline import compare_studies, comparison_files, comparison_lines, write_compared
    from lithobrake.results.study_files import json_values

    # The folder is made when there is something to write: a refusal leaves none behind.
    refuse_existing(() if force else comparison_files(place), arguments.REPLACE)
    comparison = compare_studies(first, second)
    page, numbers = write_compared(comparison, place)
    lines = [*comparison_lines(comparison), f"Page: {page.resolve()}", f"Numbers: {numbers.resolve()}"]
    arguments.tell_result(json, json_values(comparison), lines)


@arguments.command(arguments.LOOK, "score runs/mascot hard_ground.csv --landing mascot")
def score(
    predictions: Annotated[
        list[Path],
        typer.Argument(
            metavar="PREDICTION...",
            help="Study folders, or tables (CSV) with a row for each predicted landing.",
            show_default=False,
        ),
    ],
    landing: Annotated[
        str | None, typer.Option("--landing", metavar="NAME", help="A landing of the archive (docs/scoring.md).")
    ] = None,
    observation: Annotated[
        Path | None, typer.Option("--observation", metavar="FILE.toml", help="What was observed of another landing.")
    ] = None,
    json: arguments.Json = False,
) -> None:
    """Score predictions of a landing against what was observed: ends, times, contacts, place, side."""
    from lithobrake.results.study_files import json_values
    from lithobrake.scoring.landing_scores import score_lines, scores
    from lithobrake.scoring.observed_landing import archive, past_landing, read_observation
    from lithobrake.scoring.predicted_landings import read_prediction

    if (landing is None) == (observation is None):
        given = "neither --landing nor --observation is" if landing is None else "--landing and --observation are both"
        raise ValueError(
            f"{given} given; allowed: one of --observation FILE.toml and --landing {' | '.join(archive())}; give one"
        )
    observed = past_landing(landing) if landing is not None else read_observation(observation or Path())
    found = [one for path in predictions for one in scores(read_prediction(path), observed)]
    lines = [f"{observed.title} ({observed.source})", *score_lines(found)]
    arguments.tell_result(json, json_values([asdict(one) for one in found]), lines)


def _view_journey(folder: Path, number: int, run: str | None, solid: bool) -> None:
    page = folder / "report" / f"journey_{number}.html"
    _refuse_both(number, run)
    from lithobrake.results import open_study
    from lithobrake.view import write_journey

    with arguments.shown_progress("journey") as progress:
        motion = open_study(folder).journey(number).motion(progress=progress)
    if solid:
        show_touchdowns(motion)
        return
    # A study that has not come to its report has no such folder yet.
    page.parent.mkdir(exist_ok=True)
    write_journey(motion, page)
    _open(page.resolve())


def _refuse_both(number: int | None, run: str | None) -> None:
    if number is not None and run is not None:
        raise ValueError(f"--run {run} and --journey {number} are given, and one thing is shown; omit one of them")


def _open(page: Path) -> None:
    import webbrowser

    if not webbrowser.open(page.as_uri()):
        arguments.tell([f"No browser found; open this file: {page}"])


def _landing(results: "StudyResults", run: str | None, progress: Progress = silent) -> "MovingBodies":
    if run is None:
        return results.median_landing
    return results.landing_bodies(arguments.run_of(run), progress=progress)
