"""Rows of MASCOT in the table of the experiments: its first contact on a boulder at the surface (validation/mascot)."""

import sys

from table_lines import HERE, Line, Lines

# Behind this folder, which has files of the same names.
sys.path.append(str(HERE.parent / "mascot"))
sys.path.append(str(HERE.parents[1] / "benchmarks"))
from answers import MEASURED, answer, column, rows_of, said

QUANTITIES = {
    "contacts": "MASCOT: contacts from the first to rest",
    "time_s": "MASCOT: time from the first contact to rest [s]",
    "path_m": "MASCOT: way along the ground [m]",
}


def mascot_part() -> Lines:
    """A row for each quantity: it agrees where it lies within eight tenths of the landers."""
    rows = rows_of("at the surface")
    lines = []
    for name, words in QUANTITIES.items():
        one, measured = answer(column(rows, name), MEASURED[name]), MEASURED[name]
        told = f"{said(one.middle)} (eight in ten: {said(one.low)} to {said(one.high)})"
        lines.append(Line(words, f"{measured:g}, once", told, len(rows), f"{one.middle / measured:.2f}", one.agrees))
    return lines
