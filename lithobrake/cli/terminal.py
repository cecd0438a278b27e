"""What a command writes to the terminal: lines and JSON, or one sentence and an exit code where it ends early."""

import errno
import os
import shlex
import shutil
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NoReturn, TextIO

import typer

from lithobrake.vocabulary.plain_text import plain, wrapped
from lithobrake.vocabulary.progress import Progress

BAD_INPUT, INTERRUPTED = 2, 130


@contextmanager
def one_sentence() -> Iterator[None]:
    """Turn an error that a user can fix into its sentence and exit code 2, and Ctrl-C into exit code 130."""
    try:
        yield
    except (ValueError, FloatingPointError, ImportError, OSError) as error:
        full = isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT)
        remedy = "; all finished work is kept: make room on the disk and run the same command again"
        if isinstance(error, FileNotFoundError) and not _has_current_folder():
            leave("the current folder was removed; change to one that exists", BAD_INPUT)
        leave(f"{error}{remedy if full else ''}", BAD_INPUT)
    except KeyboardInterrupt:
        command = command_line(*sys.argv[1:])
        leave(f"Stopped. Every finished run is kept; to continue, run the same command: {command}", INTERRUPTED)


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


@contextmanager
def reader_may_leave() -> Iterator[None]:
    """Write to standard output for as long as it is read; a reader that stops early (`| head`) is no error.

    Ends the command with a sentence where standard output takes nothing, as a file on a full disk.
    """
    try:
        yield
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
        begun = False

        def tell_progress(done: float, what: str) -> None:
            nonlocal begun
            if not begun:
                shown.begin(title, 1, 1)
            begun = True
            shown.progress(done, 1.0, what)

        yield tell_progress


def study_headline(folder: Path) -> list[str]:
    """The headline of the summary and the path of the report, in lines."""
    with one_sentence():
        from lithobrake.results import open_study

        headline = open_study(folder).headline
    page = (folder / "report" / "index.html").resolve()
    return [*(f"  {sentence}" for sentence in headline), f"Report: {page}"]
