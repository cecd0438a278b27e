"""A study with where it comes from: a file, or tables that a program has made."""

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lithobrake.study.reader import StudyError, check_tables, parse_tables, read_bytes
from lithobrake.study.shipped import study_path
from lithobrake.study.study import Study
from lithobrake.vocabulary.plain_text import show

# What a study of tables is called in messages, and the stem of its folder.
TABLES = "study"
# No key takes more levels of tables and lists.
DEEPEST = 10


@dataclass(frozen=True)
class StudySource:
    """A study that was read and checked; tables: as written; content: of its file; path: of that, None for tables."""

    study: Study
    tables: Mapping[str, Any]
    content: bytes
    path: Path | None

    @classmethod
    def read(cls, path: Path, function: str | None = None) -> "StudySource":
        """Read a study file, or the shipped study of a name.

        function: identity of a Python function that makes the touchdowns in place of the soil.

        Raises StudyError with one sentence for each problem.
        """
        path = study_path(path)
        content = read_bytes(path)
        tables = parse_tables(path, content)
        return cls(check_tables(tables, path.resolve().parent, path.name, function), tables, content, path)

    @classmethod
    def of_tables(cls, tables: Mapping[str, Any], function: str | None = None) -> "StudySource":
        """Check the tables of a study; relative paths in them count from the current folder.

        Values may also be paths, and scalars and arrays of NumPy. Raises StudyError.
        """
        import tomli_w

        plain = plain_tables(tables, f"{TABLES}.toml")
        study = check_tables(plain, Path.cwd(), function=function)
        return cls(study, plain, tomli_w.dumps(plain).encode(), None)

    @property
    def name(self) -> str:
        """The name that messages use."""
        return f"{TABLES}.toml" if self.path is None else self.path.name

    @property
    def stem(self) -> str:
        """The name without its suffix."""
        return TABLES if self.path is None else self.path.stem


def plain_tables(tables: Mapping[str, Any], name: str) -> dict[str, Any]:
    """The same in dicts, lists, text and Python's own numbers; those of NumPy and paths are turned into these.

    name: that messages use. Raises StudyError that names the first key with a value of another type.
    """
    plain = _plain(tables, "", name, DEEPEST)
    assert isinstance(plain, dict)
    return plain


def _plain(value: Any, key: str, name: str, levels: int) -> Any:
    """One value, at a dotted key, in so many more levels."""
    # A study file is refused without a wait for it.
    import numpy as np

    if isinstance(value, np.ndarray | np.generic):
        # Those of long doubles give themselves.
        value = float(value) if isinstance(value, np.longdouble) else value.tolist()
    elif isinstance(value, os.PathLike):
        value = os.fspath(value)
    if levels == 0:
        raise StudyError([f"{name}: {key} is nested too deeply; no key takes more than a few levels"])
    if isinstance(value, Mapping):
        for inner in value:
            if not isinstance(inner, str):
                raise StudyError([f"{name}: {key or 'the study'} has the key {inner!r}; allowed: names in text"])
            _text(inner, f"a key of {key or 'the study'}", name)
        return {inner: _plain(entry, _dotted(key, inner), name, levels - 1) for inner, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry, _dotted(key, str(place)), name, levels - 1) for place, entry in enumerate(value)]
    if isinstance(value, str):
        return _text(value, key, name)
    if isinstance(value, bool | int | float):
        return value
    raise StudyError(
        [
            f"{name}: {key} is {show(value)}, of the type {type(value).__name__}; allowed: numbers, text, true or "
            "false, and lists and tables of these; convert it, say by float() or str()"
        ]
    )


def _text(value: str, key: str, name: str) -> str:
    """A text that a file can hold."""
    if any("\ud800" <= letter <= "\udfff" for letter in value):
        raise StudyError([f"{name}: {key} is {show(value)}, which UTF-8 cannot hold; leave out lone surrogates"])
    return value


def _dotted(key: str, inner: str) -> str:
    return f"{key}.{inner}" if key else inner
