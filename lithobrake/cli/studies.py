"""Commands that begin, plan, make and watch a study."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from lithobrake.cli import arguments

if TYPE_CHECKING:
    from lithobrake.study.reader import Shipped
    from lithobrake.vocabulary.known_bodies import KnownBody

BODY, LANDER, AT = "Dimorphos", "2U", "10,-60"
# Width of the column of names in the list of examples.
NAMES = 26


@arguments.command(arguments.START, "new hera --body dimorphos --lander 6u --at 10,120")
def new(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the study.", show_default=False)],
    body: Annotated[
        str | None,
        typer.Option(help=f"A body by name: Dimorphos, Didymos, Bennu, Ryugu, ...; absent: {BODY}, without --shape."),
    ] = None,
    lander: Annotated[str, typer.Option(help="A lander by name: 1U to 12U, Juventas, Milani, MASCOT.")] = LANDER,
    at: Annotated[str, typer.Option(metavar="LAT,LON", help="Aim point, latitude and longitude in degrees.")] = AT,
    shape: Annotated[
        str | None,
        typer.Option(
            metavar="FILE", help="Mesh of the body, relative to the study file, with --body, or --mass and --spin."
        ),
    ] = None,
    mass: Annotated[float | None, typer.Option(metavar="KG", help="Mass of the body of --shape.")] = None,
    spin: Annotated[float | None, typer.Option(metavar="S", help="Spin period of the body of --shape.")] = None,
    full: Annotated[bool, typer.Option("--full", help="Also list every key of a study file.")] = False,
    first_bounce: Annotated[
        bool,
        typer.Option(
            "--first-bounce", help="Study the first bounce and fit an emulator to it, instead of journeys to rest."
        ),
    ] = False,
) -> None:
    """Write a commented study file, NAME.toml, that follows landers to rest."""
    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    # The stem also names the folder of the study, and stands in commands that are pasted.
    odd = path.stem in ("", ".toml", ".", "..") or path.stem[0] == "-" or path.stem != path.stem.strip()
    if odd or not name.isprintable():
        raise ValueError(f"NAME is {name!r}; allowed: a name, or a path that ends in one; write, say, bennu")
    from lithobrake.study.template import template

    given = {"--lander": lander != LANDER, "--at": at != AT}
    options = {"--body": body, "--shape": shape, "--mass": mass, "--spin": spin}
    given = {**given, **{name: value is not None for name, value in options.items()}}
    # The template has no place for these options; ignored silently they would be missed only in its results.
    if first_bounce and (full or any(given.values())):
        raise ValueError(f"--first-bounce takes none of {', '.join(given)}, --full; leave one or the other out")
    text = template() if first_bounce else _journeys(_body(body, shape, mass, spin), lander, at, shape, full)
    _write_new(path, text)
    arguments.tell([f"Wrote {path}. Edit it, then: {arguments.command_line('run', path)}"])


def _body(name: str | None, shape: str | None, mass: float | None, spin: float | None) -> "KnownBody":
    """The body of a new study. Raises ValueError where its mass and spin would be those of another."""
    from lithobrake.study.short_study import body_of_mesh, known_body, refuse_other_body

    if mass is None and spin is None and (shape is None or name is not None):
        found = known_body(name or BODY)
        if shape is not None:
            refuse_other_body(found, shape)
        return found
    if shape is None or name is not None or mass is None or spin is None:
        words = {"--body": name, "--shape": shape, "--mass": mass, "--spin": spin}
        said = " and ".join(option for option, value in words.items() if value is not None)
        raise ValueError(
            f"{said} {'is' if ' and ' not in said else 'are'} given; allowed: --shape with --body, whose mass and spin "
            "are known, or with both --mass and --spin; give these"
        )
    return body_of_mesh(shape, mass, spin)


def _journeys(body: "KnownBody", lander: str, at: str, shape: str | None, full: bool) -> str:
    from lithobrake.study.short_study import aim_point, all_keys, known_lander, short_study

    return short_study(body, known_lander(lander), aim_point(at), shape) + (all_keys() if full else "")


def _write_new(path: Path, text: str) -> None:
    """Write a study file where there is none. Raises ValueError where there is one, or where none can be."""
    try:
        # Mode x leaves no moment between the check and the write in which another process could make the file.
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        raise ValueError(f"{path} exists; choose another name or remove it") from None
    except OSError as error:
        reason = error.strerror or error
        raise ValueError(f"{path} cannot be written ({reason}); choose another name or an existing folder") from error


@arguments.command(arguments.START, "examples notebook_one_landing")
def examples(
    name: Annotated[
        str | None, typer.Argument(metavar="NAME", help="Which one to copy; absent: list them.", show_default=False)
    ] = None,
) -> None:
    """List the studies and examples that come with the package, or copy one to the current folder."""
    from lithobrake.study.reader import shipped, shipped_by_name

    if name is None:
        arguments.tell(_listed(shipped().values()))
        return
    found = shipped_by_name(name)
    first, *beside = found.write(Path())
    others = f", with {' and '.join(map(str, beside))}" if beside else ""
    command = arguments.command_line("run", first) if found.is_study else f"python {first}"
    arguments.tell([f"Wrote {first}{others}. Run it with: {command}"])


def _listed(known: Iterable["Shipped"]) -> list[str]:
    lines = ["Studies; run one with `lithobrake run NAME`, or copy it here with `lithobrake examples NAME`:"]
    known = list(known)
    lines += [f"  {one.name:<{NAMES}}{one.title}" for one in known if one.is_study]
    lines += ["Programs and notebooks; copy one here with `lithobrake examples NAME`:"]
    return lines + [f"  {one.name:<{NAMES}}{one.title}" for one in known if not one.is_study]


def study_command(name: str, what: str, group: str, until: str | None = None) -> None:
    last = until or name

    def command(
        study: arguments.StudyPath,
        out: arguments.OutPath = None,
        workers: arguments.Workers = None,
        scheduler: arguments.Scheduler = None,
        logs: arguments.Logs = False,
    ) -> None:
        folder = arguments.study_folder(study, out)
        _make(study, folder, last, workers, scheduler, logs)
        arguments.tell(arguments.study_headline(folder) if last == "report" else [f"Done: {folder}"])

    epilog = f"Example: lithobrake {name} study.toml --out results --workers 4"
    full = f"{what} Reuses the files in its folder, and first runs all earlier stages whose files are missing."
    add = arguments.app.command(name, help=full, short_help=what, rich_help_panel=group, epilog=epilog)
    add(arguments.one_sentence()(command))


@arguments.command(arguments.RUN, "plan study.toml")
def plan(
    study: arguments.StudyPath,
    out: arguments.OutPath = None,
    workers: arguments.Workers = None,
    infer: Annotated[
        bool,
        typer.Option("--infer", help="Also report how many observed bounces halve each input's standard deviation."),
    ] = False,
    against: Annotated[
        Path | None,
        typer.Option(
            "--against",
            metavar="OTHER.toml",
            help="Also report how well the difference to this study, in runs/OTHER, will be known, run by run.",
            show_default=False,
        ),
    ] = None,
    half_width: Annotated[
        float | None,
        typer.Option(
            "--half-width",
            metavar="FRACTION",
            help="With --against: also the runs that this half-width of the difference asks for (0.05: 5 points).",
            show_default=False,
        ),
    ] = None,
    json: arguments.Json = False,
) -> None:
    """Print the runs of a study, their time and disk space, the expected half-width, and warnings. Runs nothing."""
    folder = arguments.study_folder(study, out)
    _refuse_unlike(infer, against, half_width)
    from lithobrake.pipeline import plan_comparison, plan_lines, plan_study

    if against is None:
        found = plan_study(study, folder, workers, infers=infer)
    else:
        other = arguments.study_folder(against, None)
        found = plan_comparison(study, folder, against, other, workers, half_width=half_width)
    arguments.tell_result(json, found.to_json(), plan_lines(found))


def _refuse_unlike(infer: bool, against: Path | None, half_width: float | None) -> None:
    """Raise ValueError for options of `plan` that do not go together."""
    if against is None and half_width is not None:
        raise ValueError("--half-width is that of a difference; name the other study with --against")
    if against is not None and infer:
        raise ValueError("--against and --infer are two questions; ask them one after the other")


study_command("run", "Run a study from its file to its report.", arguments.RUN, until="report")


@arguments.command(arguments.RUN, "status runs/study")
def status(folder: arguments.StudyDirectory, json: arguments.Json = False) -> None:
    """Show the progress of a study, from any terminal, also while the study runs."""
    from lithobrake.pipeline import study_status

    found = study_status(folder)
    lines, content = found.lines(), found.to_json()
    arguments.tell_result(json, content, lines)


def _make(study: Path, out: Path, until: str, workers: int | None, scheduler: str | None, logs: bool) -> None:
    from lithobrake.study import StudySource

    # A study that is refused is refused at once: what follows brings the engine and its compiler.
    source = StudySource.read(study)
    from lithobrake.pipeline import run_study
    from lithobrake.progress import study_progress

    with study_progress() as shown:
        run_study(source, out, until=until, worker_count=workers, scheduler=scheduler, shown=shown, keeps_logs=logs)
