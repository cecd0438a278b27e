"""Observed bounces in a CSV file."""

import os
from collections.abc import Mapping

from lithobrake.analysis import Observation
from lithobrake.files.reading import DamagedFileError, read_table
from lithobrake.study.units import conversion, run_units
from lithobrake.vocabulary.outcomes import TouchdownOutcome
from lithobrake.vocabulary.quantities import PURE

# Columns of standard deviations begin so; those of words.
ERROR, OUTCOME, BED = "error:", "outcome", "bed"


def read_bounces(path: str | os.PathLike[str]) -> list[Observation]:
    """Read bounces, one a row, from a CSV file; an empty cell was not observed.

    Columns: outputs of the touchdown, `error:` and the name of one for its standard deviation, uncertain numbers of
    [impact] by dotted key where they are known, outcome, and bed, a word that bounces on one bed share. A unit in
    brackets behind a name is turned into that of the study; without one numbers are in that unit. Raises ValueError for
    what is no number, a unit of another quantity, two columns of one name, and no bounce.
    """
    table = read_table(path, (), "write a line of names, and a line for each bounce")
    factors = {name: _factor(path, name, unit) for name, unit in table.units.items()}
    found = [_bounce(path, number, row, factors) for number, row in enumerate(table.rows, start=1)]
    if not found:
        raise ValueError(f"{path} has no bounce; write one a line below the line of names")
    return found


def _factor(path: str | os.PathLike[str], name: str, unit: str) -> float:
    """What the numbers of a column are multiplied by, to be in the unit of the study."""
    own = (run_units() | {OUTCOME: PURE, BED: PURE}).get(name.removeprefix(ERROR))
    if own is None:
        # The emulator refuses the name.
        return 1.0
    try:
        return conversion(unit, own)
    except ValueError as error:
        raise ValueError(f"{path} has {name} in the {error}; convert the column") from error


def _bounce(
    path: str | os.PathLike[str], number: int, row: Mapping[str, str], factors: Mapping[str, float]
) -> Observation:
    given: dict[str, float] = {}
    for name, text in row.items():
        if name not in (OUTCOME, BED) and text.strip():
            try:
                given[name] = float(text) * factors.get(name, 1.0)
            except ValueError as error:
                raise DamagedFileError(
                    f'{path} has "{text}" for {name} in row {number}; write a number, or nothing'
                ) from error
    outcome = (row.get(OUTCOME) or "").strip() or None
    if outcome not in (None, *TouchdownOutcome):
        raise ValueError(f'{path} has the outcome "{outcome}" in row {number}; allowed: {", ".join(TouchdownOutcome)}')
    errors = {name.removeprefix(ERROR): value for name, value in given.items() if name.startswith(ERROR)}
    known = {name: value for name, value in given.items() if "." in name and not name.startswith(ERROR)}
    outputs = {name: value for name, value in given.items() if name not in known and not name.startswith(ERROR)}
    return Observation(outputs, errors, known, outcome, (row.get(BED) or "").strip() or None)
