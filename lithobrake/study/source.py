"""A study with where it comes from: a file, or tables that a program has made."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lithobrake.study.reader import check_tables, parse_tables, read_bytes
from lithobrake.study.study import Study

# What a study of tables is called in messages, and the stem of its folder.
TABLES = "study"


@dataclass(frozen=True)
class StudySource:
    """A study that was read and checked; tables: as written; content: of its file; path: of that, None for tables."""

    study: Study
    tables: Mapping[str, Any]
    content: bytes
    path: Path | None

    @classmethod
    def read(cls, path: Path, function: str | None = None) -> "StudySource":
        """Read a study file; function: identity of a Python function that makes the touchdowns in place of the soil.

        Raises StudyError with one sentence for each problem.
        """
        content = read_bytes(path)
        tables = parse_tables(path, content)
        return cls(check_tables(tables, path.resolve().parent, path.name, function), tables, content, path)

    @classmethod
    def of_tables(cls, tables: Mapping[str, Any], function: str | None = None) -> "StudySource":
        """Check the tables of a study; relative paths in them count from the current folder.

        Values may also be paths, and scalars and arrays of NumPy. Raises StudyError.
        """
        import tomli_w

        # It takes NumPy, and a study file is refused without a wait for that.
        from lithobrake.study.given_tables import plain_tables

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
