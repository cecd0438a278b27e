"""The command line. Everything heavy is imported inside the command that needs it, so that --help answers at once."""

import errno
import os
import shlex
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from lithobrake import __version__
from lithobrake.plain import plain

if TYPE_CHECKING:
    from lithobrake.results.moving_bodies import MovingBodies
    from lithobrake.results.study_results import StudyResults

app = typer.Typer(
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
)

StudyPath = Annotated[Path, typer.Argument(metavar="STUDY.toml", help="The study file.", show_default=False)]
OutPath = Annotated[
    str | None, typer.Option("--out", metavar="DIR", help="Folder of the study; the default is runs/<study name>.")
]
ExecutorName = Annotated[
    str, typer.Option("--executor", metavar="local|dask", help="Run on this machine or on a Dask cluster.")
]
Scheduler = Annotated[
    str | None, typer.Option("--scheduler", metavar="tcp://HOST:PORT", help="Address of the Dask scheduler.")
]
Logs = Annotated[bool, typer.Option("--logs", help="Keep a log of each run in DIR/logs.")]
Workers = Annotated[
    int | None, typer.Option("--workers", min=1, metavar="N", help="Number of processes; the default is all cores.")
]
StudyDirectory = Annotated[Path, typer.Argument(metavar="DIR", help="The folder of a study.", show_default=False)]

BAD_INPUT, INTERRUPTED = 2, 130


def _show_version(asked: bool) -> None:
    if asked:
        print(f"lithobrake {__version__}")
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """Where does a lander end up on a small body whose soil nobody knows, and how sure are we?"""


@app.command(epilog="Example: lithobrake new bennu")
def new(name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the study.", show_default=False)]) -> None:
    """Write a commented study file, NAME.toml."""
    with _one_sentence():
        path = Path(name if name.endswith(".toml") else f"{name}.toml")
        # The stem also names the folder of the study, and stands in commands that are pasted.
        odd = path.stem in ("", ".toml", ".", "..") or path.stem[0] == "-" or path.stem != path.stem.strip()
        if odd or not name.isprintable():
            raise ValueError(f"NAME is {name!r}; allowed: a name, or a path that ends in one; write, say, bennu")
        from lithobrake.study.template import template

        try:
            with path.open("x", encoding="utf-8") as file:
                file.write(template())
        except FileExistsError:
            raise ValueError(f"{path} exists; choose another name or remove it") from None
        except OSError as error:
            reason = error.strerror or error
            raise ValueError(
                f"{path} cannot be written ({reason}); choose another name or an existing folder"
            ) from error
        print(f"Wrote {path}. Edit it, then: {_command('run', path)}")


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
        folder = _default_folder(study) if out is None else _given_folder(out)
        _make(study, folder, last, workers, _scheduler(executor, scheduler), logs)
        _tell(_results(folder) if last == "report" else [f"Done: {folder}"])

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


@app.command(epilog="Example: lithobrake land study.toml --set grain.friction=0.4 --out landing.h5")
def land(
    study: StudyPath,
    change: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Another value for a number that it reads.")
    ] = None,
    number: Annotated[int, typer.Option("--number", metavar="N", help="Which run of the study, from 1.")] = 1,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="Keep the motion: .h5, .vtkhdf (ParaView), .mp4 or .webp (a film)."),
    ] = None,
    show: Annotated[bool, typer.Option("--show", help="Open a window on the motion.")] = False,
    json: Annotated[bool, typer.Option("--json", help="Print JSON, all numbers in SI.")] = False,
) -> None:
    """Make one landing of a study and tell what came out. Nothing of the study's folder is read or written."""
    with _one_sentence():
        from lithobrake.study import read_study

        checked = read_study(study)
        from lithobrake.pipeline import land_one, landing_inputs
        from lithobrake.progress import study_progress

        values = landing_inputs(checked, change or (), number)
        if out is not None and out.suffix != ".h5":
            from lithobrake.view import refuse_other_kinds

            refuse_other_kinds(out)
        with study_progress() as shown:
            shown.begin("landing", 1, 1)
            found = land_one(checked, values, lambda done, what: shown.progress(done, 1.0, what))
        _keep_motion(found.save, found.bodies, out, show)
        lines = found.lines()
    if json:
        from json import dumps

        lines = [dumps(found.to_json(), indent=2)]
    _tell(lines)
    if out is not None and not json:
        _tell([f"Motion: {out.resolve()}"])


@app.command(epilog="Example: lithobrake infer results --bounce bounces.csv")
def infer(
    folder: StudyDirectory,
    bounce: Annotated[
        Path | None,
        typer.Option("--bounce", metavar="FILE", help="Observed bounces, a CSV file. Absent: what they would say."),
    ] = None,
) -> None:
    """Infer the soil from observed bounces with a study's emulator: writes posterior.json and posterior.png there."""
    with _one_sentence():
        from lithobrake.pipeline import InferredStudy, infer_study

        plan = InferredStudy.open(folder).plan_lines()
        found = None if bounce is None else infer_study(folder, bounce)
    _tell(plan)
    if found is not None:
        _tell([found["statement"], f"Posterior: {folder / 'posterior.json'}, {folder / 'posterior.png'}"])


@app.command(epilog="Example: lithobrake plan study.toml")
def plan(
    study: StudyPath,
    out: OutPath = None,
    workers: Workers = None,
    json: Annotated[bool, typer.Option("--json", help="Print JSON, all numbers in SI.")] = False,
) -> None:
    """Show what a study will make, how long that takes, and what to watch out for. Runs nothing."""
    folder = _default_folder(study) if out is None else _given_folder(out)
    with _one_sentence():
        from lithobrake.pipeline import plan_lines, plan_study

        found = plan_study(study, folder, workers)
    if json:
        from json import dumps

        _tell([dumps(found.to_json(), indent=2)])
        return
    _tell(plan_lines(found))


@app.command(epilog="Example: lithobrake report runs/study")
def report(folder: StudyDirectory) -> None:
    """Write the report of a study again from its files."""
    with _one_sentence():
        from lithobrake.pipeline import write_report_again

        write_report_again(folder)
    _tell(_results(folder))


@app.command(epilog="Example: lithobrake status runs/study")
def status(
    folder: StudyDirectory, json: Annotated[bool, typer.Option("--json", help="Print JSON, all numbers in SI.")] = False
) -> None:
    """Show the progress of a study. Works from any terminal, even while the study runs."""
    with _one_sentence():
        from lithobrake.pipeline import study_status

        found = study_status(folder)
        lines = found.lines()
    if json:
        from json import dumps

        lines = [dumps(found.to_json(), indent=2, allow_nan=False)]
    _tell(lines)


@app.command(epilog="Example: lithobrake runs runs/study --csv > runs.csv")
def runs(
    folder: StudyDirectory, csv: Annotated[bool, typer.Option("--csv", help="Print every column as CSV.")] = False
) -> None:
    """List the runs of a study with the inputs that vary."""
    with _one_sentence():
        from lithobrake.campaign import run_lines, write_csv
        from lithobrake.results import open_study

        records = open_study(folder).ledger
        units: dict[str, str] = {}
        # The names of a campaign that is no study are its author's, and so are their units.
        if (folder / "study.toml").is_file():
            from lithobrake.study.units import run_units

            units = run_units()
    if csv:
        with _reader_may_leave():
            write_csv(records, sys.stdout, units)
        return
    width = shutil.get_terminal_size().columns if sys.stdout.isatty() else None
    _tell(run_lines(records, units, width))


@app.command(epilog="Example: lithobrake film runs/study --run 3 --out landing.mp4")
def film(
    folder: StudyDirectory,
    run: Annotated[str | None, typer.Option("--run", metavar="ID", help="A run; absent: the landing shown.")] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="A film, .mp4 or .webp, or .vtkhdf for ParaView; DIR/landing.mp4."),
    ] = None,
    seconds: Annotated[float, typer.Option("--seconds", metavar="S", help="How long the film lasts.")] = 8.0,
) -> None:
    """Make a landing of a study again, and show it as a film."""
    path = out or folder / "landing.mp4"
    with _one_sentence():
        from lithobrake.progress import study_progress
        from lithobrake.results import open_study
        from lithobrake.view import refuse_other_kinds, write_motion

        refuse_other_kinds(path)
        with study_progress() as shown:
            shown.begin("film", 1, 1)
            bodies = _landing(open_study(folder), run, lambda done, what: shown.progress(done, 1.0, what))
            write_motion(bodies, path, seconds, lambda done: shown.progress(done, 1.0, "drawing"))
    _tell([f"Film: {path.resolve()}"])


@app.command(epilog="Example: lithobrake export runs/study --to oem --flight 12 --epoch 2026-11-22T12:00:00")
def export(
    folder: StudyDirectory,
    to: Annotated[
        list[str],
        typer.Option("--to", metavar="KIND", help="oem, plates, facets, geotiff or geojson; may be repeated."),
    ],
    flight: Annotated[
        list[int] | None, typer.Option("--flight", metavar="SAMPLE", help="oem: a sample to follow; may be repeated.")
    ] = None,
    frame: Annotated[
        str, typer.Option("--frame", metavar="inertial|fixed", help="oem: axes of the states.")
    ] = "inertial",
    epoch: Annotated[str | None, typer.Option("--epoch", metavar="UTC", help="oem: when all flights start.")] = None,
    step: Annotated[
        float | None,
        typer.Option("--step", metavar="SECONDS", help="oem: between states; default: 1 % of the longest."),
    ] = None,
    resolution: Annotated[
        float, typer.Option("--resolution", metavar="DEGREES", help="geotiff: edge of a cell.")
    ] = 1.0,
    out: Annotated[str | None, typer.Option("--out", metavar="FOLDER", help="The default is DIR/export.")] = None,
) -> None:
    """Write results of a study as files of other programs: flights, shape, numbers per facet, map of the impacts."""
    place = folder / "export" if out is None else _given_folder(out)
    with _one_sentence():
        from lithobrake.results import open_study

        # A folder that is no study is refused before numbers are loaded.
        results = open_study(folder)
        from lithobrake.export import ExportOptions, export_study

        choices = ExportOptions(flight or (), frame, epoch, step, resolution)
        written = export_study(results, place, to, choices)
    _tell(f"Wrote {path}" for path in written)


@app.command(epilog="Example: lithobrake serve study.toml --out results --port 4242")
def serve(
    study: StudyPath,
    out: OutPath = None,
    host: Annotated[
        str, typer.Option("--host", metavar="ADDRESS", help="Address to listen on; others than this machine need one.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option("--port", min=0, max=65535, help="Port; 0 takes a free one.")] = 4242,
) -> None:
    """Serve landing, emulator and flight of a study to clients of UM-Bridge, until Ctrl-C. Writes nothing."""
    folder = _default_folder(study) if out is None else _given_folder(out)
    with _one_sentence():
        from lithobrake.pipeline import served_models

        models = served_models(study, folder)
        from lithobrake.serve import model_server

        server = model_server(models, host, port)
    with server:
        names = ", ".join(model.name for model in models)
        _tell([f"Serving {names} at http://{host}:{server.server_port}; Ctrl-C ends it."])
        # That it was ended is no news to whoever ended it.
        with suppress(KeyboardInterrupt):
            server.serve_forever()


@app.command(epilog="Example: lithobrake view runs/study")
def view(
    folder: StudyDirectory,
    solid: Annotated[bool, typer.Option("--3d", help="Open a window on a landing instead, by PyVista.")] = False,
    run: Annotated[str | None, typer.Option("--run", metavar="ID", help="Which run --3d shows.")] = None,
) -> None:
    """Open the report of a study in the browser."""
    if solid:
        with _one_sentence():
            from lithobrake.results import open_study
            from lithobrake.view import show

            show(_landing(open_study(folder), run))
        return
    with _one_sentence():
        from lithobrake.pipeline import report_page

        page, doubt = report_page(folder)
    _tell([doubt] if doubt else [])
    import webbrowser

    if not webbrowser.open(page.as_uri()):
        _tell([f"No browser found; open this file: {page}"])


def _landing(
    results: "StudyResults", run: str | None, progress: Callable[[float, str], None] = lambda done, what: None
) -> "MovingBodies":
    """The landing of a run, made again, or the one that the study keeps."""
    if run is None:
        return results.median_landing
    return results.landing_bodies(int(run) if run.isdigit() and len(run) < 6 else run, progress=progress)


def _keep_motion(
    save: Callable[[Path], None], bodies: Callable[[], "MovingBodies"], out: Path | None, shown: bool
) -> None:
    """Write a motion to a file of the kind that its name says, and open a window on it."""
    if out is not None and out.suffix == ".h5":
        save(out)
    elif out is not None:
        from lithobrake.view import write_motion

        write_motion(bodies(), out)
    if shown:
        from lithobrake.view import show

        show(bodies())


def _default_folder(study: Path) -> Path:
    return Path("runs") / study.stem


def _given_folder(out: str) -> Path:
    if not out.strip():
        _leave(
            "--out is empty (an unset variable?) and would mean the current folder; "
            "name a folder, or omit --out to use runs/<study name>",
            BAD_INPUT,
        )
    return Path(out)


def _scheduler(executor: str, scheduler: str | None) -> str | None:
    """The address of the Dask scheduler, or None for runs made here."""
    if executor not in ("local", "dask"):
        _leave(f"--executor is {executor!r}; allowed: local, dask", BAD_INPUT)
    if (executor == "dask") != (scheduler is not None):
        _leave("--executor dask and --scheduler tcp://HOST:PORT go together; give both or neither", BAD_INPUT)
    return scheduler


def _make(study: Path, out: Path, until: str, workers: int | None, scheduler: str | None, logs: bool) -> None:
    """Make the files of a study up to a stage, with two lines of progress."""
    with _one_sentence():
        from lithobrake.study import StudySource

        # A study that is refused is refused at once: what follows brings NumPy and the compiler.
        source = StudySource.read(study)
        from lithobrake.pipeline import run_study
        from lithobrake.progress import study_progress

        with study_progress() as shown:
            run_study(source, out, until=until, worker_count=workers, scheduler=scheduler, shown=shown, keeps_logs=logs)


def _results(folder: Path) -> list[str]:
    """The headline of the summary and the path of the report, in lines."""
    with _one_sentence():
        from lithobrake.results import open_study

        headline = open_study(folder).headline
    page = (folder / "report" / "index.html").resolve()
    return [*(f"  {sentence}" for sentence in headline), f"Report: {page}"]


def _tell(lines: Iterable[str]) -> None:
    with _reader_may_leave():
        for line in lines:
            print(plain(line))


@contextmanager
def _reader_may_leave() -> Iterator[None]:
    """Write to standard output for as long as it is read; a reader that stops early (`| head`) is no error."""
    try:
        yield
        print(end="", flush=True)
    except BrokenPipeError:
        # What is still buffered would be tried again at the end, and fail again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextmanager
def _one_sentence() -> Iterator[None]:
    """Turn an error that a user can fix into its sentence and exit code 2, and Ctrl-C into exit code 130."""
    try:
        yield
    except (ValueError, FloatingPointError, ImportError, OSError) as error:
        full = isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT)
        remedy = "; all finished work is kept: make room on the disk and run the same command again"
        _leave(f"{error}{remedy if full else ''}", BAD_INPUT)
    except KeyboardInterrupt:
        command = _command(*sys.argv[1:])
        _leave(f"Stopped. Every finished run is kept; to continue, run the same command: {command}", INTERRUPTED)


def _command(*words: str | Path) -> str:
    """A command line that a shell takes as it stands, blanks in paths included."""
    return shlex.join(["lithobrake", *map(str, words)])


def _leave(sentence: str, code: int) -> NoReturn:
    print(plain(sentence), file=sys.stderr)
    raise typer.Exit(code)
