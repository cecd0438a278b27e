"""Commands that begin, make, plan and watch a study."""

from pathlib import Path
from typing import Annotated

import typer

from lithobrake.cli.arguments import (
    ExecutorName,
    Json,
    Logs,
    OutPath,
    Scheduler,
    StudyDirectory,
    StudyPath,
    Workers,
    app,
    scheduler_of,
    study_folder,
)
from lithobrake.cli.terminal import command_line, one_sentence, study_headline, tell, tell_json

BODY, LANDER, AT = "Dimorphos", "2U", "10,-60"


@app.command(epilog="Example: lithobrake new hera --body dimorphos --lander 6u --at 10,120")
def new(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the study.", show_default=False)],
    body: Annotated[str, typer.Option(help="A body by name: Dimorphos, Didymos, Bennu, Ryugu, ...")] = BODY,
    lander: Annotated[str, typer.Option(help="A lander by name: 1U to 12U, Juventas, Milani, MASCOT.")] = LANDER,
    at: Annotated[str, typer.Option(metavar="LAT,LON", help="Aim point, latitude and longitude in degrees.")] = AT,
    shape: Annotated[
        str | None, typer.Option(metavar="FILE", help="Mesh of the body, its path as seen from the study.")
    ] = None,
    full: Annotated[bool, typer.Option("--full", help="Also list every key of a study file.")] = False,
    first_bounce: Annotated[
        bool, typer.Option("--first-bounce", help="Ask for the first bounce and an emulator of it, not for the end.")
    ] = False,
) -> None:
    """Write a commented study file, NAME.toml, that follows landers to rest."""
    with one_sentence():
        path = Path(name if name.endswith(".toml") else f"{name}.toml")
        # The stem also names the folder of the study, and stands in commands that are pasted.
        odd = path.stem in ("", ".toml", ".", "..") or path.stem[0] == "-" or path.stem != path.stem.strip()
        if odd or not name.isprintable():
            raise ValueError(f"NAME is {name!r}; allowed: a name, or a path that ends in one; write, say, bennu")
        from lithobrake.study.template import template

        given = {"--body": body != BODY, "--lander": lander != LANDER, "--at": at != AT, "--shape": shape is not None}
        if first_bounce and (full or any(given.values())):
            raise ValueError(f"--first-bounce takes none of {', '.join(given)}, --full; leave one or the other out")
        text = template() if first_bounce else _journeys(body, lander, at, shape, full)
        _write_new(path, text)
    tell([f"Wrote {path}. Edit it, then: {command_line('run', path)}"])


def _journeys(body: str, lander: str, at: str, shape: str | None, full: bool) -> str:
    """The text of a study of journeys."""
    from lithobrake.study.known_bodies import known_body
    from lithobrake.study.known_landers import known_lander
    from lithobrake.study.short_study import aim_point, all_keys, short_study

    return short_study(known_body(body), known_lander(lander), aim_point(at), shape) + (all_keys() if full else "")


def _write_new(path: Path, text: str) -> None:
    """Write a study file where there is none. Raises ValueError where there is one, or where none can be."""
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise ValueError(f"{path} exists; choose another name or remove it") from None
    except OSError as error:
        reason = error.strerror or error
        raise ValueError(f"{path} cannot be written ({reason}); choose another name or an existing folder") from error


def _study_command(name: str, what: str, until: str | None = None) -> None:
    """Add the command that runs a study up to a stage."""
    last = until or name

    def command(
        study: StudyPath,
        out: OutPath = None,
        workers: Workers = None,
        executor: ExecutorName = "local",
        scheduler: Scheduler = None,
        logs: Logs = False,
    ) -> None:
        folder = study_folder(study, out)
        _make(study, folder, last, workers, scheduler_of(executor, scheduler), logs)
        tell(study_headline(folder) if last == "report" else [f"Done: {folder}"])

    app.command(name, help=what, epilog=f"Example: lithobrake {name} study.toml --out results --workers 4")(command)


BEFORE = "Runs any earlier stage whose output is missing."
_study_command(
    "run", "Run a study from its file to its report. Reuses whatever its folder already has.", until="report"
)
_study_command("bed", f"Pour and settle the beds, and make one landing to look at. {BEFORE}", until="landing")
_study_command("screen", f"Run the screening design and fit an expansion in all inputs. {BEFORE}")
_study_command("refine", f"Run the refined design and fit an expansion in the inputs that matter. {BEFORE}")
_study_command("test", f"Run the test points and score the expansions on them. {BEFORE}")
_study_command("sample", f"Draw Monte Carlo samples from the refined expansion. {BEFORE}")
_study_command("fly", f"Fly the samples that leave the surface to their next impact. {BEFORE}")
_study_command("rest", f"Follow samples from bounce to bounce until they come to rest. {BEFORE}")


@app.command(epilog="Example: lithobrake plan study.toml")
def plan(
    study: StudyPath,
    out: OutPath = None,
    workers: Workers = None,
    infer: Annotated[
        bool,
        typer.Option("--infer", help="Also report how many observed bounces halve each input's standard deviation."),
    ] = False,
    json: Json = False,
) -> None:
    """Show what a study will make, how long that takes, and what to watch out for. Runs nothing."""
    folder = study_folder(study, out)
    with one_sentence():
        from lithobrake.pipeline import plan_lines, plan_study

        found = plan_study(study, folder, workers, infers=infer)
    if json:
        tell_json(found.to_json())
    else:
        tell(plan_lines(found))


@app.command(epilog="Example: lithobrake rare study.toml fast --landings 500")
def rare(
    study: StudyPath,
    name: Annotated[str, typer.Argument(metavar="NAME", help="A name of \\[limit_states].", show_default=False)],
    landings: Annotated[int, typer.Option("--landings", metavar="N", help="Landings of each level.")] = 500,
    out: OutPath = None,
    workers: Workers = None,
    executor: ExecutorName = "local",
    scheduler: Scheduler = None,
) -> None:
    """Tell how probable a rare limit state is by levels of landings of their own; writes rare_NAME.json."""
    folder, address = study_folder(study, out), scheduler_of(executor, scheduler)
    with one_sentence():
        from lithobrake.study import StudySource

        source = StudySource.read(study)
        from lithobrake.pipeline import rare_failure
        from lithobrake.progress import study_progress

        with study_progress() as shown:
            found = rare_failure(
                source, folder, name, landing_count=landings, worker_count=workers, scheduler=address, shown=shown
            )
    tell([found["statement"], f"Written: {folder / f'rare_{name}.json'}"])


@app.command(epilog="Example: lithobrake status runs/study")
def status(folder: StudyDirectory, json: Json = False) -> None:
    """Show the progress of a study. Works from any terminal, even while the study runs."""
    with one_sentence():
        from lithobrake.pipeline import study_status

        found = study_status(folder)
        lines, content = found.lines(), found.to_json()
    if json:
        tell_json(content)
    else:
        tell(lines)


def _make(study: Path, out: Path, until: str, workers: int | None, scheduler: str | None, logs: bool) -> None:
    """Make the files of a study up to a stage, with two lines of progress."""
    with one_sentence():
        from lithobrake.study import StudySource

        # A study that is refused is refused at once: what follows brings NumPy and the compiler.
        source = StudySource.read(study)
        from lithobrake.pipeline import run_study
        from lithobrake.progress import study_progress

        with study_progress() as shown:
            run_study(source, out, until=until, worker_count=workers, scheduler=scheduler, shown=shown, keeps_logs=logs)
