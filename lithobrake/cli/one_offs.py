"""Commands beside a study: one landing, a server, a look at the installation, and those for experts."""

import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lithobrake.cli import arguments
from lithobrake.cli.studies import study_command
from lithobrake.vocabulary.plain_text import plain
from lithobrake.vocabulary.quantities import Row

if TYPE_CHECKING:
    from lithobrake.study import Study

# Exit code of `doctor` where a library is missing without which nothing works.
INCOMPLETE = 1


@arguments.command(arguments.RUN, "land study.toml --set grain.friction=0.4 --out landing.h5")
def land(
    study: arguments.StudyPath,
    change: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Override a study parameter.")
    ] = None,
    number: Annotated[int, typer.Option("--number", metavar="N", help="Number of the run or journey, from 0.")] = 0,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="FILE",
            help="Keep the motion: .h5, .vtkhdf (ParaView), .mp4, .webp (films), .png (a sheet), .html (a journey).",
        ),
    ] = None,
    show: Annotated[bool, typer.Option("--show", help="Show the motion in a window.")] = False,
    force: arguments.Force = False,
    json: arguments.Json = False,
) -> None:
    """Simulate one landing of a study, or one journey to rest, and print the outcome.

    The study's folder is neither read nor written.
    """
    from lithobrake.study import read_study

    checked = read_study(study)
    from lithobrake.pipeline import landing_inputs

    values = landing_inputs(checked, change or (), number)
    found = _landed if checked.journey.touchdowns == 1 else _followed
    told, lines = found(checked, values, out, show, force, json)
    arguments.tell_result(json, told, lines)


@arguments.command(arguments.EXPORT, "serve study.toml --out results --port 4242")
def serve(
    study: arguments.StudyPath,
    out: arguments.OutPath = None,
    host: Annotated[
        str,
        typer.Option("--host", metavar="ADDRESS", help="Address to listen on; the default serves this machine only."),
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option("--port", min=0, max=65535, help="Port; 0: any free port.")] = 4242,
    time_limit: Annotated[
        float | None,
        typer.Option(
            "--time-limit",
            metavar="SECONDS",
            help="Longest evaluation; the default is campaign.wall_limit, else 600.",
        ),
    ] = None,
) -> None:
    """Serve landing, emulator and flight of a study to UM-Bridge clients, until Ctrl-C. Writes nothing."""
    folder = arguments.study_folder(study, out)
    # Refused before the imports below, which take seconds.
    from lithobrake.serve.server import refuse_empty_host

    refuse_empty_host(host)
    # What follows brings NumPy and the compiler, and for some studies the shape of the body.
    if sys.stderr.isatty():
        print(f"Reading {plain(str(study))} and its files ...", file=sys.stderr, flush=True)
    from lithobrake.pipeline import EvaluationProcess, ServedStudy
    from lithobrake.serve import ClientServer

    served = ServedStudy(study, folder)
    models, evaluations = served.models(), EvaluationProcess(served, time_limit)
    server = ClientServer(models, host, port, evaluations)
    with server, evaluations:
        names = ", ".join(model.name for model in models)
        reach = "" if server.is_local else ", which any machine of the network can reach"
        arguments.tell([f"Serving {names} at {server.address}{reach}; Ctrl-C ends it."])
        # That it was ended is no news to whoever ended it.
        with suppress(KeyboardInterrupt):
            server.serve_forever()


@arguments.command(arguments.START, "doctor --json > doctor.json")
def doctor(
    quick: Annotated[bool, typer.Option("--quick", help="Skip the measurement of speed.")] = False,
    json: arguments.Json = False,
) -> None:
    """Report what is installed, what is missing and how to get it, and how fast this machine is."""
    from lithobrake.doctor import examine

    found = examine(quick)
    arguments.tell_result(json, found.to_json(), found.lines())
    if found.lacking:
        raise typer.Exit(INCOMPLETE)


def _landed(
    study: "Study", values: Row, out: Path | None, shown: bool, force: bool, json: bool
) -> tuple[dict[str, Any], list[str]]:
    from lithobrake.cli.results import refuse_motion_file
    from lithobrake.pipeline import energy_gained, land_one
    from lithobrake.view import show, write_motion

    if out is not None:
        # Refused before the landing, which may need a bed to be poured first.
        refuse_motion_file(out, force, also=(".h5",))
    with arguments.shown_progress("landing") as progress:
        found = land_one(study, values, progress)
    # The file of a landing needs no library of the extra [view].
    if out is not None and out.suffix == ".h5":
        found.save(out)
    elif out is not None:
        write_motion(found.bodies(), out)
    if shown:
        show(found.bodies())
    gained = energy_gained(study, [found])
    return found.to_json(), [*found.lines(), *_warned(gained), *_motion_lines([] if out is None else [out])]


def _followed(
    study: "Study", values: Row, out: Path | None, shown: bool, force: bool, json: bool
) -> tuple[dict[str, Any], list[str]]:
    """Follow a lander to its end, with lines as it goes; give the same as JSON values, and what is left to say."""
    from lithobrake.cli.results import refuse_journey_file, show_touchdowns
    from lithobrake.pipeline import energy_gained, follow_one
    from lithobrake.view.motion_files import touchdown_paths, write_journey

    def tell(line: str) -> None:
        arguments.tell([] if json else [line])

    if out is not None:
        refuse_journey_file(out, force, (".h5",))
    paths: list[Path] = []
    with arguments.shown_progress("journey") as progress:
        found = follow_one(study, values, tell, progress)
        tell(found.track.end_words)
        if out is not None and out.suffix == ".h5":
            paths = touchdown_paths(out, len(found.landings))
            found.save(paths)
        elif out is not None:
            paths = write_journey(found.motion(), out, progress=progress)
    if shown:
        show_touchdowns(found.motion())
    return found.to_json(), [*_warned(energy_gained(study, found.landings)), *_motion_lines(paths)]


def _warned(gained: str | None) -> list[str]:
    return [] if gained is None else [f"Warning: {gained}."]


def _motion_lines(paths: list[Path]) -> list[str]:
    return [f"Motion: {path.resolve()}" for path in paths]


@arguments.command(arguments.EXPERT, "rare study.toml fast --landings 500")
def rare(
    study: arguments.StudyPath,
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="Name of a limit state of the study.", show_default=False)
    ],
    landings: Annotated[int, typer.Option("--landings", metavar="N", help="Landings per level.")] = 500,
    out: arguments.OutPath = None,
    workers: arguments.Workers = None,
    scheduler: arguments.Scheduler = None,
) -> None:
    """Estimate the probability of a rare limit state by subset simulation with landings; writes rare_NAME.json."""
    folder = arguments.study_folder(study, out)
    from lithobrake.study import StudySource

    source = StudySource.read(study)
    from lithobrake.pipeline import rare_failure
    from lithobrake.progress import study_progress

    with study_progress() as shown:
        found = rare_failure(
            source, folder, name, landing_count=landings, worker_count=workers, scheduler=scheduler, shown=shown
        )
    arguments.tell([found["statement"], f"Written: {folder / f'rare_{name}.json'}"])


@arguments.command(arguments.EXPERT, "infer runs/study --bounce bounces.csv")
def infer(
    folder: arguments.StudyDirectory,
    bounce: Annotated[
        Path | None,
        typer.Option(
            "--bounce",
            metavar="FILE",
            help="Observed bounces, or the record of a first contact, a CSV file. If omitted, report identifiability.",
        ),
    ] = None,
) -> None:
    """Infer the soil from observed bounces with the emulator of a study; writes posterior.json and posterior.png.

    In a study of journeys to rest, infer ground and place of rest from a first contact (nowcast.json).
    """
    from lithobrake.pipeline import InferredStudy, infer_study, is_first_contact, nowcast_study

    if bounce is not None and is_first_contact(folder, bounce):
        with arguments.shown_progress("inference") as progress:
            said = nowcast_study(folder, bounce, progress)["statement"]
        made = (folder / f"nowcast.{kind}" for kind in ("json", "csv", "png"))
        written = ", ".join(str(path) for path in made if path.is_file())
        arguments.tell([*said, f"Nowcast: {written}"])
        return
    study = InferredStudy.open(folder)
    with arguments.shown_progress("inference") as progress:
        progress(0.0, "identifiability")
        plan = study.plan().lines()
        if bounce is not None:
            progress(0.5, "posterior")
        found = None if bounce is None else infer_study(folder, bounce)
    arguments.tell(plan)
    if found is not None:
        written = f"Posterior: {folder / 'posterior.json'}, {folder / 'posterior.png'}"
        arguments.tell([line for line in (found["statement"], found["beds"], written) if line])


study_command("bed", "Pour and settle the beds, and simulate a preview landing.", arguments.EXPERT, until="landing")
study_command("screen", "Expansion: run the screening design and fit an expansion in all inputs.", arguments.EXPERT)
study_command("refine", "Expansion: run the refined design and fit an expansion in the kept inputs.", arguments.EXPERT)
study_command("test", "Expansion: run the test points and score the expansions on them.", arguments.EXPERT)
study_command(
    "sample", "Sample the first touchdown by the refined expansion, or else by the emulator.", arguments.EXPERT
)
study_command("fly", "Fly the samples that leave the surface to their next impact.", arguments.EXPERT)
study_command(
    "hard-ground", "Follow landers on hard ground until they come to rest.", arguments.EXPERT, until="hard_ground"
)
