"""How a command ends early: one sentence on standard error, and an exit code."""

import errno
import os
import shlex
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn, TextIO

import typer

from lithobrake.vocabulary.plain_text import plain, wrapped

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
