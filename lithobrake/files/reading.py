"""Reading files that anyone may have changed, and hashes of files, JSON values and sources."""

import csv
import hashlib
import io
import json
import math
import os
import re
import reprlib
import stat
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import cache
from os import PathLike
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

# What a form may be: a type; {"key": form}, an object with at least these keys; {str: form}, an object with any keys;
# [form], a list.
Form = Any
NUMBER = int | float
# What readers of text, JSON, CSV and HDF5 raise over a file that is not what they expect, or claims to be huge.
UNREADABLE = (
    OSError, ValueError, TypeError, LookupError, AttributeError, ArithmeticError, RuntimeError, MemoryError, csv.Error,
)  # fmt: skip


# The title of a column: its name, and its unit in brackets where it has one.
TITLE = re.compile(r"\s*(.*?)\s*(?:\[([^\[\]]*)\])?\s*", re.DOTALL)


class CsvTable(NamedTuple):
    """A CSV file: the units that its columns state, by name, and its rows, each an entry by the name of its column."""

    units: dict[str, str]
    rows: list[dict[str, str]]


class DamagedFileError(ValueError):
    """A file that is not what its name says; the message names it and says what to do."""


@contextmanager
def reading(path: str | PathLike[str], remedy: str, *also: type[Exception]) -> Iterator[None]:
    """Turn whatever a damaged file makes its reader raise into DamagedFileError; also: what else the reader raises."""
    kinds: tuple[type[Exception], ...] = (*UNREADABLE, *also)
    try:
        # Reading a pipe waits for whoever writes to it, and some devices have no end.
        if os.path.exists(path) and not os.path.isfile(path):
            raise DamagedFileError(f"{path} cannot be read (it is no regular file); {remedy}")
        yield
    except DamagedFileError:
        raise
    except kinds as error:
        # A KeyError says the bare key, or a sentence in quotation marks.
        said = str(error.args[0]) if type(error) is KeyError and error.args else str(error)
        said = f"it lacks {said}" if type(error) is KeyError and " " not in said else said
        words = " ".join(said.split()) or type(error).__name__
        raise DamagedFileError(f"{path} cannot be read ({words}); {remedy}") from error


@contextmanager
def open_regular(path: str | PathLike[str]) -> Iterator[BinaryIO]:
    """Open a file to read its bytes. Raises ValueError at once for a pipe or a device, OSError as `open` does."""
    with open(path, "rb", opener=lambda path, flags: os.open(path, flags | getattr(os, "O_NONBLOCK", 0))) as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise ValueError("it is no regular file")
        yield file


def read_text(path: str | PathLike[str]) -> str:
    """The text of a file in UTF-8, without a byte order mark. Raises ValueError and OSError as open_regular does."""
    with open_regular(path) as file:
        return io.TextIOWrapper(file, encoding="utf-8-sig").read()


def read_json(path: str | PathLike[str], form: Form, remedy: str) -> Any:
    """Read a JSON file. Raises DamagedFileError, with the remedy, when it is not there or not of the form."""
    with reading(path, remedy):
        return parsed(Path(path).read_text(encoding="utf-8"), form)


def parsed(text: str | bytes, form: Form) -> Any:
    """The value of a JSON text. Raises ValueError or RecursionError when it is none, or not of the form."""
    value = json.loads(text, parse_int=_whole, parse_float=_finite, parse_constant=_finite, object_pairs_hook=unique)
    check(value, form)
    return value


def unique(pairs: Iterable[tuple[Any, Any]]) -> dict[Any, Any]:
    """A table of pairs of a name and a value. Raises ValueError for a name that stands twice."""
    found: dict[Any, Any] = {}
    for name, value in pairs:
        if name in found:
            raise ValueError(f"it has {reprlib.repr(name)} twice; write each name once")
        found[name] = value
    return found


def read_rows(path: str | PathLike[str], columns: Iterable[str], remedy: str) -> list[dict[str, str]]:
    """The rows of a CSV file by column, whose name ends before its unit in brackets.

    Raises DamagedFileError when the file lacks one of these columns, has two of one name, or half a row.
    """
    return read_table(path, columns, remedy).rows


def read_table(path: str | PathLike[str], columns: Iterable[str], remedy: str) -> CsvTable:
    """The same with the units of the columns."""
    with reading(path, remedy), open(path, newline="", encoding="utf-8-sig") as file:
        table = csv.DictReader(file, restkey="", strict=True)
        titles = [TITLE.fullmatch(title) for title in table.fieldnames or ()]
        table.fieldnames = names = [title[1] if title else "" for title in titles]
        lacking = [name for name in columns if name not in names]
        if lacking:
            raise ValueError(f"it lacks the columns {', '.join(lacking)}")
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ValueError(f"it has {names.count(twice[0])} columns {twice[0] or 'without a name'}")
        rows = list(table)
        for number, row in enumerate(rows, start=1):
            if None in row.values() or "" in row:
                raise ValueError(f"row {number} has another number of entries than the first line")
        return CsvTable({title[1]: title[2] for title in titles if title and title[2] is not None}, rows)


def check(value: Any, form: Form, where: str = "") -> None:
    """Raise ValueError, with the dotted key of what is wrong, when a JSON value is not of the form."""
    if isinstance(form, dict):
        check(value, dict, where)
        for key, inner in dict.fromkeys(value, form[str]).items() if str in form else form.items():
            if key not in value:
                raise ValueError(f"{where or 'it'} lacks {key}")
            check(value[key], inner, f"{where}.{key}" if where else str(key))
    elif isinstance(form, list):
        check(value, list, where)
        for number, entry in enumerate(value):
            check(entry, form[0], f"{where}[{number}]")
    elif not isinstance(value, form):
        kind = getattr(form, "__name__", str(form))
        raise ValueError(f"{where or 'it'} is {reprlib.repr(value)}, not of type {kind}")


def _whole(text: str) -> int:
    # No number of a study has more digits than a float can hold, and arithmetic with one that has would end badly.
    _finite(text)
    return int(text)


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{reprlib.repr(text)} is no finite number")
    return value


def file_stamp(path: str | PathLike[str]) -> tuple[int, int, int] | None:
    """What of a file changes when its content does; None where there is none."""
    try:
        found = os.stat(path)
    except OSError:
        return None
    # The inode too, as a file may be replaced by one of the same size within a tick of the clock.
    return found.st_ino, found.st_size, found.st_mtime_ns


def content_hash(path: Path) -> str:
    """Hash of a file's bytes."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def json_hash(value: Any) -> str:
    """Hash of a JSON value; the order of keys does not matter."""
    return hashlib.sha256(json.dumps(value, sort_keys=True, separators=(",", ":")).encode()).hexdigest()


def hashed_seed(*values: Any) -> int:
    """Seed of random numbers from JSON values: another one for any other values."""
    return int(json_hash(list(values))[:12], 16)


@cache
def source_hash(*parts: str) -> str:
    """Hash of the sources of parts or files of the package: results of other code are other results.

    As they are when it is first asked for: what a process has loaded does not change with its file.

    Raises ValueError for a part that there is not: its code would be left out of the hash unseen.
    """
    package = Path(__file__).parents[1]
    roots = [package / part for part in dict.fromkeys(parts)]
    if lacking := [str(root) for root in roots if not root.exists()]:
        raise ValueError(f"{', '.join(lacking)} cannot be hashed; allowed: folders and files of the package")
    digest = hashlib.sha256()
    for source in sorted(path for root in roots for path in ([root] if root.is_file() else root.rglob("*.py"))):
        digest.update(str(source.relative_to(package)).encode() + b"\0" + source.read_bytes())
    return digest.hexdigest()[:16]
