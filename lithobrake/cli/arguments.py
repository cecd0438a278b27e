"""Arguments and options that several commands take, and the application that the commands add themselves to."""

from pathlib import Path
from typing import Annotated

import typer

from lithobrake import __version__
from lithobrake.cli.terminal import BAD_INPUT, leave

# Groups of commands in the help, in this order.
START, RUN, LOOK = "Start", "Run a study", "Look at results"
EXPORT, EXPERT = "Pass results on", "Expert: single stages and special questions"

app = typer.Typer(
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
)


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
    """Predict where a lander comes to rest on a small body whose soil is unknown, with confidence intervals."""


# More processes than any machine runs at once.
MOST_WORKERS = 10_000
StudyPath = Annotated[
    Path,
    typer.Argument(
        metavar="STUDY.toml",
        help="The study file, or the name of a study that comes with the package (lithobrake examples).",
        show_default=False,
    ),
]
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
    int | None,
    typer.Option(
        "--workers", min=1, max=MOST_WORKERS, metavar="N", help="Number of processes; the default is all cores."
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, all numbers in SI.")]
Force = Annotated[bool, typer.Option("--force", help="Replace files that exist.")]
StudyDirectory = Annotated[Path, typer.Argument(metavar="DIR", help="The folder of a study.", show_default=False)]


def study_folder(study: Path, out: str | None) -> Path:
    """The folder of a study: the one that is given, or runs/<study name>; a file in its place is refused."""
    folder = Path("runs") / study.stem if out is None else given_folder(out)
    there = next((path for path in (folder, *folder.parents) if path.exists()), None)
    if there is not None and not there.is_dir():
        leave(f"{folder} cannot be written ({there} is a file); choose another folder with --out", BAD_INPUT)
    return folder


def given_folder(out: str) -> Path:
    """The folder that --out names; an empty one is refused."""
    if not out.strip():
        leave(
            "--out is empty (an unset variable?) and would mean the current folder; "
            "name a folder, or omit --out to use runs/<study name>",
            BAD_INPUT,
        )
    return Path(out)


def refuse_written(path: Path, force: bool) -> None:
    """Raise ValueError for a file that exists, unless it may be replaced."""
    from lithobrake.files.atomic import refuse_existing

    refuse_existing(() if force else (path,), "choose another name with --out, or replace it with --force")


def scheduler_of(executor: str, scheduler: str | None) -> str | None:
    """The address of the Dask scheduler, or None for runs made here."""
    if executor not in ("local", "dask"):
        leave(f"--executor is {executor!r}; allowed: local, dask", BAD_INPUT)
    if (executor == "dask") != (scheduler is not None):
        leave("--executor dask and --scheduler tcp://HOST:PORT go together; give both or neither", BAD_INPUT)
    return scheduler


def run_of(text: str) -> str | int:
    """A row among the runs, or the key of one or how that begins, from what was written for either."""
    return int(text) if text.isascii() and text.isdigit() and len(text) < 6 else text
