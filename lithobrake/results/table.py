"""A table of results that says of each column what it is, in which unit and which frame."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from lithobrake.vocabulary.extra_library import extra_library
from lithobrake.vocabulary.plain_text import names_in_lines, short_repr
from lithobrake.vocabulary.quantities import Quantity

if TYPE_CHECKING:
    import pandas
    import xarray

# Rows that a notebook shows.
SHOWN = 10


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
    """Columns by name, all of the same length; `table["speed_out"]` gives the values, `table.columns` what they are."""

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
