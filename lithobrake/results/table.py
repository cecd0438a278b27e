"""Tables of results whose columns have a unit and a frame, and the tables that an explorer evaluates."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.files.reading import reading
from lithobrake.vocabulary.extra_library import extra_library
from lithobrake.vocabulary.plain_text import names_in_lines, short_repr
from lithobrake.vocabulary.quantities import Quantity

if TYPE_CHECKING:
    import pandas
    import xarray
    from numpy.typing import NDArray

# Rows that a notebook shows.
SHOWN = 10
FORMAT_VERSION = 5
NAMES = ("input_names", "output_names", "outcome_names")


@dataclass(frozen=True, eq=False)
class Column:
    """Values of one quantity, shape [row_count], with what they are.

    units: as in the study file ("" for a pure number or a word); long_name: in words; frame: in which directions are
    measured, "" where there are none.
    """

    values: np.ndarray
    units: str = ""
    long_name: str = ""
    frame: str = ""
    __repr__ = short_repr

    @property
    def attributes(self) -> dict[str, str]:
        """What the column is, as other programs keep it beside the values."""
        return Quantity(self.units, self.long_name, self.frame).attributes


class Table(Mapping[str, np.ndarray]):
    """Columns by name, of equal length; `table["speed_out"]` gives values, `table.columns` units and meanings."""

    def __init__(self, row: str, columns: Mapping[str, Column]) -> None:
        """Keep the columns; row: what one row is, in a word. Raises ValueError for columns of different lengths."""
        lengths = {len(column.values) for column in columns.values()}
        if len(lengths) > 1:
            raise ValueError(f"columns have {sorted(lengths)} rows; all columns of a table must have the same")
        self.row, self.columns = row, dict(columns)
        self.row_count = lengths.pop() if lengths else 0

    @classmethod
    def of(cls, row: str, columns: Mapping[str, tuple[Quantity, Any]]) -> "Table":
        """A table of values by name, each with what it is."""
        return cls(row, {name: Column(np.asarray(values), *what[:3]) for name, (what, values) in columns.items()})

    def __getitem__(self, name: str) -> np.ndarray:
        """Values of a column, shape [row_count]. Raises KeyError with the names that there are."""
        if name not in self.columns:
            raise KeyError(f"{name} is no column; there are: {', '.join(self.columns)}")
        return self.columns[name].values

    def __iter__(self) -> Iterator[str]:
        """Go through the names of the columns."""
        return iter(self.columns)

    def __len__(self) -> int:
        """Count the columns."""
        return len(self.columns)

    def where(self, chosen: np.ndarray) -> "Table":
        """The chosen rows: booleans [row_count], or numbers of rows."""
        columns = {name: Column(column.values[chosen], **column.attributes) for name, column in self.columns.items()}
        return Table(self.row, columns)

    def to_pandas(self) -> "pandas.DataFrame":
        """A data frame; `frame.attrs[name]` says what a column is. Raises ImportError where pandas is absent."""
        frame = extra_library("pandas", "pandas", "data").DataFrame(
            {name: column.values for name, column in self.columns.items()}
        )
        frame.index.name = self.row
        frame.attrs = {name: column.attributes for name, column in self.columns.items()}
        return frame

    def to_xarray(self) -> "xarray.Dataset":
        """A data set over one dimension, the row, each variable with its attributes.

        Raises ImportError where xarray is absent.
        """
        return extra_library("xarray", "xarray", "data").Dataset(
            {name: (self.row, column.values, column.attributes) for name, column in self.columns.items()}
        )

    def __repr__(self) -> str:
        """Say how large the table is and what its columns are."""
        titles = (_title(name, column) for name, column in self.columns.items())
        return names_in_lines(f"Table of {self.row_count} rows ({self.row}): ", titles)

    def _repr_html_(self) -> str:
        """The first rows, for a notebook."""
        shown = min(self.row_count, SHOWN)
        head = "".join(
            f'<th title="{escape(column.long_name, quote=True)}">{escape(_title(name, column))}</th>'
            for name, column in self.columns.items()
        )
        cells = [[escape(_cell(value)) for value in column.values[:shown]] for column in self.columns.values()]
        rows = "".join(f"<tr>{''.join(f'<td>{cell}</td>' for cell in row)}</tr>" for row in zip(*cells, strict=True))
        more = f"<caption>{shown} of {self.row_count} rows ({escape(self.row)})</caption>"
        return f"<table>{more}<thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"


def _title(name: str, column: Column) -> str:
    return f"{name} [{column.units}]" if column.units else name


def _cell(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float | np.floating) else str(value)


@dataclass(frozen=True)
class ExplorerAttitude:
    """What draws the attitudes of a touchdown, as `lithobrake.geometry.attitude` has them.

    input_names: of the terms; axes [axis_count][3] of the lander; sides: in words, with the directions of the lander
    that are toward the ground. drawn: terms of attitudes, [row_count][term_count], each as likely as the others; None
    where all attitudes are.
    """

    input_names: tuple[str, ...]
    axes: list[list[float]]
    has_sides: bool
    is_cube: bool
    sides: dict[str, list[list[float]]]
    drawn: list[list[float]] | None = None


@dataclass(frozen=True, eq=False)
class ExplorerTables:
    """tables by name, as `lithobrake.emulator.law_tables` says, and azimuth [row_count] of each row [rad].

    Those of an expansion have velocities among their outputs and no azimuth, scatter that grows [output_count] with the
    impact's speed from the runs' scatter_speed [m/s], and chances of outcomes that follow its first terms.
    group_count: groups of runs that refits draw; interval_reach: standard errors that an interval over them reaches to;
    unseen_limit: share that an event may have which no run has met. bound: numbers of the energy bound, and by dotted
    key the medians of what it depends on. attitude: None where the law reads none.
    """

    tables: "dict[str, NDArray[np.float64]]"
    input_names: tuple[str, ...]
    output_names: tuple[str, ...]
    outcome_names: tuple[str, ...]
    output_outcome: str
    group_count: int
    interval_reach: float
    unseen_limit: float
    bound: dict[str, float]
    attitude: ExplorerAttitude | None = None
    __repr__ = short_repr

    @property
    def attitude_inputs(self) -> tuple[str, ...]:
        """Inputs that are terms of the attitude; none where the law reads no attitude."""
        return () if self.attitude is None else self.attitude.input_names

    @classmethod
    def read(cls, path: Path, remedy: str) -> "ExplorerTables":
        """Read explorer.h5. Raises DamagedFileError, with the remedy, for another file."""
        import h5py

        with reading(path, remedy), h5py.File(path, "r") as file:
            if file.attrs["format_version"] != FORMAT_VERSION:
                raise ValueError(
                    f"it has format {file.attrs['format_version']}, and this version reads {FORMAT_VERSION}"
                )
            names = {key: tuple(map(str, file.attrs[key])) for key in NAMES}
            bound = {
                key.removeprefix("bound."): float(file.attrs[key]) for key in file.attrs if key.startswith("bound.")
            }
            attitude = json.loads(str(file.attrs["attitude"]))
            if attitude is not None:
                attitude = ExplorerAttitude(**attitude | {"input_names": tuple(attitude["input_names"])})
            tables = {name: data[()] for name, data in file.items()}
            return cls(
                tables,
                **names,
                output_outcome=str(file.attrs["output_outcome"]),
                group_count=int(file.attrs["group_count"]),
                interval_reach=float(file.attrs["interval_reach"]),
                unseen_limit=float(file.attrs["unseen_limit"]),
                bound=bound,
                attitude=attitude,
            )
