"""Lines and JSON on standard output."""

import os
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from lithobrake.cli.refusals import BAD_INPUT, fitted, leave, one_sentence
from lithobrake.vocabulary.plain_text import plain


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


def study_headline(folder: Path) -> list[str]:
    """The headline of the summary and the path of the report, in lines."""
    with one_sentence():
        from lithobrake.results import open_study

        headline = open_study(folder).headline
    page = (folder / "report" / "index.html").resolve()
    return [*(f"  {sentence}" for sentence in headline), f"Report: {page}"]
