"""A study with where it comes from: a file, or tables that a program has made."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from lithobrake.study.reader import check_tables, load_tables, read_study
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
    def read(cls, path: Path) -> "StudySource":
        """Read a study file. Raises StudyError with one sentence for each problem."""
        return cls(read_study(path), load_tables(path), path.read_bytes(), path)

    @classmethod
    def of_tables(cls, tables: Mapping[str, Any]) -> "StudySource":
        """Check the tables of a study; relative paths in them count from the current folder. Raises StudyError."""
        import tomli_w

        return cls(check_tables(tables, Path.cwd()), tables, tomli_w.dumps(dict(tables)).encode(), None)

    @property
    def name(self) -> str:
        """The name that messages use."""
        return f"{TABLES}.toml" if self.path is None else self.path.name

    @property
    def stem(self) -> str:
        """The name without its suffix."""
        return TABLES if self.path is None else self.path.stem

    def with_function(self, identity: str) -> "StudySource":
        """The study whose touchdowns a function makes. Raises ValueError where the study names a program for that."""
        if self.study.solver.command is not None:
            raise ValueError(
                f"{self.name}: solver.command names a program, and a model is given too; keep one of the two"
            )
        solver = self.study.solver.model_copy(update={"function": identity})
        return StudySource(self.study.model_copy(update={"solver": solver}), self.tables, self.content, self.path)
