"""A predictive distribution of landings: a table with a row for each sampled landing, of any code."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lithobrake.files.reading import CsvTable, read_table
from lithobrake.geometry.attitude import directions
from lithobrake.scoring.observed_landing import ENDS, NUMBERS
from lithobrake.vocabulary.array_types import Floats
from lithobrake.vocabulary.file_names import JOURNEYS_FILE
from lithobrake.vocabulary.outcomes import JourneyEnd
from lithobrake.vocabulary.plain_text import show
from lithobrake.vocabulary.quantities import SIDES

REMEDY = "give a study folder, or a table (CSV) with a row for each predicted landing and its end"
# Ends of landings of which nothing is known, as those that failed.
UNKNOWN = ("", JourneyEnd.FAILED.value)


@dataclass(frozen=True, eq=False)
class PredictedLandings:
    """A sample of predicted landings, each array of shape [count].

    name: of the prediction; end: one of ENDS, or one of UNKNOWN; weight: of each landing; group: landings of one number
    (those on one bed) are not independent; numbers: by the names of NUMBERS, NaN where there is none; face: side down,
    "" where there is none; direction: of the place of rest, unit vectors [count, 3], NaN where there is none.
    """

    name: str
    end: np.ndarray
    weight: Floats
    group: np.ndarray
    numbers: Mapping[str, Floats]
    face: np.ndarray
    direction: Floats

    def __len__(self) -> int:
        """Count the landings, those of unknown end among them."""
        return len(self.end)

    def where(self, chosen: np.ndarray) -> "PredictedLandings":
        """The chosen landings: booleans or numbers of rows."""
        numbers = {name: values[chosen] for name, values in self.numbers.items()}
        return PredictedLandings(
            self.name, self.end[chosen], self.weight[chosen], self.group[chosen], numbers, self.face[chosen],
            self.direction[chosen],
        )  # fmt: skip


def read_prediction(path: Path) -> PredictedLandings:
    """Read a prediction: the folder of a study, or a table (CSV) with the columns of its journeys.csv.

    Needed: `end`. Optional: `weight`, `bed`, `latitude_deg` and `longitude_deg`, `face`, and the names of NUMBERS, in
    SI; others are ignored. An empty cell is unknown. Raises ValueError for anything else.
    """
    file = path / JOURNEYS_FILE if path.is_dir() else path
    table = read_table(file, ("end",), REMEDY)
    if not table.rows:
        raise ValueError(f"{file} has no landings; {REMEDY}")
    end, weight = _words(file, table, "end", (*ENDS, *UNKNOWN)), _weights(file, table)
    if set(end[weight > 0.0]) <= set(UNKNOWN):
        raise ValueError(f"{file}: the end of none of the {len(end)} landings is known; {REMEDY}")
    numbers = {name: _column(file, table, name, 0.0) for name in NUMBERS}
    group = [row["bed"] for row in table.rows] if "bed" in table.rows[0] else range(len(table.rows))
    found = PredictedLandings(
        str(path), end, weight, np.unique(np.asarray(group), return_inverse=True)[1], numbers,
        _words(file, table, "face", ("", *SIDES, "x", "y", "z")), _directions(file, table),
    )  # fmt: skip
    # Landings of no weight are none.
    return found.where(weight > 0.0)


def _weights(file: Path, table: CsvTable) -> Floats:
    if "weight" not in table.rows[0]:
        return np.ones(len(table.rows))
    weight = _column(file, table, "weight", 0.0)
    if not np.isfinite(weight).all() or weight.sum() <= 0.0:
        raise ValueError(f"{file}: weight is empty in a row, or 0 in all; allowed: at least 0, with a sum above 0")
    return weight


def _directions(file: Path, table: CsvTable) -> Floats:
    """Unit vectors of the places, body-fixed, shape [count, 3]."""
    latitude = _column(file, table, "latitude_deg", -90.0, 90.0)
    return directions(latitude, _column(file, table, "longitude_deg", -360.0, 360.0))


def _column(file: Path, table: CsvTable, name: str, least: float, most: float = math.inf) -> Floats:
    """Numbers of a column, NaN for empty cells and where there is no such column."""
    if name not in table.rows[0]:
        return np.full(len(table.rows), np.nan)
    values = []
    for number, row in enumerate(table.rows, start=1):
        try:
            value = float(row[name]) if row[name].strip() else math.nan
        except ValueError:
            value = -math.inf
        if value < least or value > most or math.isinf(value):
            upper = "" if most == math.inf else f" to {most:g}"
            allowed = f"a number from {least:g}{upper}, or nothing where it is unknown"
            raise ValueError(f"{file}, row {number}: {name} is {show(row[name])}; allowed: {allowed}; change it")
        values.append(value)
    return np.array(values)


def _words(file: Path, table: CsvTable, name: str, allowed: Sequence[str]) -> np.ndarray:
    """Words of a column, "" where there is no such column."""
    words = [row.get(name, "").strip() for row in table.rows]
    for number, word in enumerate(words, start=1):
        if word not in allowed:
            known = ", ".join(one for one in allowed if one)
            raise ValueError(f"{file}, row {number}: {name} is {show(word)}; allowed: {known}; change it")
    return np.array(words)
