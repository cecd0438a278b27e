"""Arguments that several commands take, and what a command writes to the terminal."""

import errno
import functools
import math
import os
import shlex
import shutil
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any, NoReturn, TextIO

import typer

from lithobrake import __version__
from lithobrake.vocabulary.callbacks import Progress
from lithobrake.vocabulary.plain_text import plain, wrapped

# 2 is the exit code of Click for wrong arguments; those of shells for a command ended by a signal are 128 + its number.
BAD_INPUT, INTERRUPTED, ENDED = 2, 128 + signal.SIGINT, 128 + signal.SIGTERM
# Groups of commands in the help, in this order.
START, RUN, LOOK = "Start", "Run a study", "Look at results"
EXPORT, EXPERT = "Pass results on", "Expert: single stages and special questions"
app = typer.Typer(
    no_args_is_help=True,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
)
REPLACE = "choose another name with --out, or replace it with --force"
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
Scheduler = Annotated[
    str | None,
    typer.Option("--scheduler", metavar="tcp://HOST:PORT", help="Run on the Dask cluster of this scheduler."),
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


class _Terminated(KeyboardInterrupt):
    """SIGTERM, which `kill` and the schedulers of clusters send, ends a command in the same order as Ctrl-C."""


@contextmanager
def _ended_in_order() -> Iterator[None]:
    def end(*_: object) -> NoReturn:
        raise _Terminated

    # Signals of a process belong to its main thread.
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGTERM, end)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


@contextmanager
def one_sentence() -> Iterator[None]:
    """Turn an error that a user can fix into its sentence and exit code 2, Ctrl-C into 130 and SIGTERM into 143."""
    try:
        with _ended_in_order():
            yield
    # Any other exception is a fault of this program, and keeps its traceback.
    except (ValueError, FloatingPointError, ImportError, OSError) as error:
        full = isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT)
        remedy = "; all finished work is kept: make room on the disk and run the same command again"
        # Every relative path fails in a folder that is gone, and the error names the path alone.
        if isinstance(error, FileNotFoundError) and not _has_current_folder():
            leave("the current folder was removed; change to one that exists", BAD_INPUT)
        leave(f"{error}{remedy if full else ''}", BAD_INPUT)
    except KeyboardInterrupt as stop:
        command = command_line(*sys.argv[1:])
        code = ENDED if isinstance(stop, _Terminated) else INTERRUPTED
        leave(f"Stopped. Every finished run is kept; to continue, run the same command: {command}", code)


def command(panel: str, example: str) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Add a function to the application as the command of its name, in a group of the help and with an example."""
    added = app.command(rich_help_panel=panel, epilog=f"Example: lithobrake {example}")
    return lambda function: added(one_sentence()(_finite(function)))


def _finite(function: Callable[..., None]) -> Callable[..., None]:
    """The same command, which refuses a number that is not finite, also where it would not be read."""

    @functools.wraps(function)
    def checked(*words: Any, **options: Any) -> None:
        for name, value in options.items():
            if isinstance(value, float) and not math.isfinite(value):
                raise ValueError(f"--{name.replace('_', '-')} is {value}; allowed: a finite number; write one")
        function(*words, **options)

    return checked


def _has_current_folder() -> bool:
    try:
        return bool(os.getcwd())
    except FileNotFoundError:
        return False


def command_line(*words: str | Path) -> str:
    """A command line that a shell takes as it stands, blanks in paths included."""
    return shlex.join(["lithobrake", *map(str, words)])


def leave(sentence: str, code: int) -> NoReturn:
    print(fitted(plain(sentence), sys.stderr), file=sys.stderr)
    raise typer.Exit(code)


def fitted(text: str, stream: TextIO) -> str:
    """A text as wide as the terminal that a stream writes to; as it is for any other stream."""
    return wrapped(text, shutil.get_terminal_size().columns) if stream.isatty() else text


def tell(lines: Iterable[str]) -> None:
    """Print lines without escape sequences; those that a terminal would break within a word are broken at blanks."""
    with reader_may_leave():
        for line in lines:
            print(fitted(plain(line), sys.stdout))


def tell_json(content: Any) -> None:
    """Print JSON; it has no word for what is not a number, and neither has the content."""
    from json import dumps

    with reader_may_leave():
        print(plain(dumps(content, indent=2, allow_nan=False)))


def tell_result(is_json: bool, content: Any, lines: Iterable[str]) -> None:
    """Print a result as JSON or in lines, as the user chose."""
    if is_json:
        tell_json(content)
    else:
        tell(lines)


@contextmanager
def reader_may_leave() -> Iterator[None]:
    """Write to standard output for as long as it is read; a reader that stops early (`| head`) is no error.

    Ends the command with a sentence where standard output takes nothing, as a file on a full disk.
    """
    try:
        yield
        # A closed pipe or a full disk shows when the buffer is written, which would otherwise be after the command has
        # ended.
        print(end="", flush=True)
    except OSError as error:
        # What is still buffered would be tried again at the end, and fail again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not isinstance(error, BrokenPipeError):
            leave(f"standard output cannot be written ({error.strerror}); make room, or write elsewhere", BAD_INPUT)


@contextmanager
def shown_progress(title: str) -> Iterator[Progress]:
    """How far something is that takes its time, as a landing made again; nothing is shown before it begins."""
    from lithobrake.progress import study_progress

    with study_progress() as shown:
        # Without a bar for what ends at once or is refused.
        begun = False

        def tell_progress(done: float, what: str) -> None:
            nonlocal begun
            if not begun:
                shown.begin(title, 1, 1)
            begun = True
            shown.progress(done, 1.0, what)

        yield tell_progress


def study_headline(folder: Path) -> list[str]:
    from lithobrake.results import open_study

    headline = open_study(folder).headline
    page = (folder / "report" / "index.html").resolve()
    return [*(f"  {sentence}" for sentence in headline), f"Report: {page}"]


def _show_version(asked: bool) -> None:
    if asked:
        print(f"lithobrake {__version__}")
        raise typer.Exit


@app.callback()
def main(
    version: Annotated[
        # Eager, so that it is answered before a missing command is complained of.
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """Predict where a lander comes to rest on a small body whose soil is unknown, with confidence intervals."""


def study_folder(study: Path, out: str | None) -> Path:
    """The folder of a study: the one that is given, or runs/<study name>; a file in its place is refused."""
    folder = Path("runs") / study.stem if out is None else given_folder(out, "runs/<study name>")
    # The nearest path that exists decides: below a file no folder can be made.
    there = next((path for path in (folder, *folder.parents) if path.exists()), None)
    if there is not None and not there.is_dir():
        raise ValueError(f"{folder} cannot be written ({there} is a file); choose another folder with --out")
    return folder


def given_folder(out: str, default: str) -> Path:
    """The folder that --out names; an empty one is refused. default: in words, what is used where it is omitted."""
    if not out.strip():
        raise ValueError(
            "--out is empty (an unset variable?) and would mean the current folder; "
            f"name a folder, or omit --out to use {default}"
        )
    return Path(out)


def refuse_written(path: Path, force: bool) -> None:
    """Refuse a file that exists, and one that no folder is there for, before it is made."""
    from lithobrake.files.atomic import refuse_existing, refuse_no_folder

    refuse_existing(() if force else (path,), REPLACE)
    refuse_no_folder(path)


def run_of(text: str) -> str | int:
    """A row among the runs, or the key of one or how that begins, from what was written for either."""
    # A key may begin with digits alone; the keys that are listed have twelve characters, so a short number is a row.
    return int(text) if text.isascii() and text.isdigit() and len(text) < 6 else text
