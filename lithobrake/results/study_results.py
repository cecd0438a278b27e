"""The results of a study, read from its folder as they are asked for."""

import os
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.outputs import DESIGNS
from lithobrake.reading import read_json, read_rows, reading
from lithobrake.results.columns import described
from lithobrake.results.table import Table

if TYPE_CHECKING:
    from lithobrake.results.named_surrogate import NamedSurrogate

REMEDY = "have it made again with: lithobrake run STUDY.toml --out DIR"
_TABLE = dict


class StudyResults:
    """What came out of a study; every table says of its columns what they are.

    Nothing is written and nothing computed: it works on a folder that may only be read, on an archived copy, and beside
    a study that runs, as far as that has come.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        """Look at a study's folder. Raises ValueError when it is none."""
        self.folder = Path(folder)
        if not any((self.folder / name).is_file() for name in ("summary.json", "keys.json", "runs.sqlite")):
            raise ValueError(f"{self.folder} holds no results of a study; name the folder of one that ran")

    @cached_property
    def summary(self) -> dict[str, Any]:
        """summary.json: the tables "study", "results" and "provenance" (docs/summary.md has every key)."""
        content: dict[str, Any] = read_json(
            self.folder / "summary.json", {"study": _TABLE, "results": _TABLE, "provenance": _TABLE}, REMEDY
        )
        return content

    @property
    def study(self) -> dict[str, Any]:
        """The study as it was understood, with all defaults, as the tables of its file."""
        tables: dict[str, Any] = self.summary["study"]
        return tables

    @cached_property
    def runs(self) -> Table:
        """Every touchdown of the study once: outcome, inputs in the file's units, outputs [SI]."""
        rows: dict[str, dict[str, str]] = {}
        for design in DESIGNS:
            path = self.folder / "designs" / f"{design}.csv"
            for row in read_rows(path, ("key", "outcome"), REMEDY) if path.is_file() else ():
                rows.setdefault(row["key"], {"design": design, **row})
        return self._table("run", list(rows.values()), ("design", "key", "outcome", "reason"))

    @cached_property
    def samples(self) -> Table:
        """The samples of the Monte Carlo: inputs in the file's units, outcome, and outputs [SI] of those that leave."""
        import h5py

        path = self.folder / "samples.h5"
        with reading(path, REMEDY), h5py.File(path, "r") as file:
            names = [str(name) for name in file.attrs["outcomes"]]
            outcome = np.array(names)[file["outcome"][:]]
            parts = [
                dict(zip(map(str, file.attrs[f"{part}_names"]), file[f"{part}s"][:].T, strict=True))
                for part in ("input", "output")
            ]
        columns = {**parts[0], "outcome": outcome, **parts[1]}
        return Table("sample", {name: described(name, values, self._units) for name, values in columns.items()})

    @cached_property
    def flights(self) -> Table:
        """The flights of the samples that leave, to the next impact (docs/flights.md)."""
        return self._table("flight", self._rows("flights.csv"), ("status",))

    @cached_property
    def rest(self) -> Table:
        """Where samples end after all bounces, on each ground (docs/flights.md)."""
        return self._table("journey", self._rows("rest.csv"), ("ground", "status"))

    @cached_property
    def beds(self) -> Table:
        """Numbers of each bed; a study whose touchdowns are made by its own program has none."""
        beds: list[dict[str, Any]] = self.summary["results"]["beds"]
        names = list(beds[0]) if beds else []
        columns = {name: np.array([bed[name] for bed in beds]) for name in names}
        return Table("bed", {name: described(name, values, {}) for name, values in columns.items()})

    @cached_property
    def surrogate(self) -> "NamedSurrogate":
        """The refined expansion, called by the names of its inputs."""
        from lithobrake.results.named_surrogate import NamedSurrogate

        return NamedSurrogate.read(self.folder / "refined.json")

    @cached_property
    def _units(self) -> dict[str, str]:
        from lithobrake.study.units import input_units

        return input_units()

    def _rows(self, name: str) -> list[dict[str, str]]:
        return read_rows(self.folder / name, ("sample",), REMEDY)

    def _table(self, row: str, rows: Sequence[Mapping[str, str]], words: Sequence[str]) -> Table:
        """A table of the rows of a CSV file; words: columns that are no numbers."""
        titles = dict.fromkeys(title for one in rows for title in one)
        columns = {}
        for title in titles:
            name = title.removeprefix("input:").removeprefix("output:")
            cells = [one.get(title, "") for one in rows]
            values: Any = cells if name in words else [float(cell) if cell else np.nan for cell in cells]
            columns[name] = described(name, values, self._units)
        return Table(row, columns)

    def __repr__(self) -> str:
        """Say where they are, and the answer."""
        answer = self.summary["results"]["answer"][0] if (self.folder / "summary.json").is_file() else "not at its end"
        return f"StudyResults of {self.folder}: {answer}"


def open_study(folder: str | os.PathLike[str]) -> StudyResults:
    """The results of a study's folder, for reading only. Raises ValueError when it is none."""
    return StudyResults(folder)
