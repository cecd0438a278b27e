"""Rows of MASCOT in the table of the experiments: its first contact on a boulder at the surface (validation/mascot)."""

import sys

from table_lines import HERE, Line, Lines

# Behind this folder, which has files of the same names.
sys.path.append(str(HERE.parent / "mascot"))
sys.path.append(str(HERE.parents[1] / "benchmarks"))
from answers import MEASURED, answer, column, rows_of, said

QUANTITIES = {
    "contacts": "contacts from the first to rest",
    "time_s": "time from the first contact to rest [s]",
    "path_m": "distance along the ground [m]",
}


def mascot_part() -> Lines:
    """Return a row for each quantity: it agrees where it lies in the central 80 % of the landers."""
    rows = rows_of("at the surface")
    lines = []
    for name, words in QUANTITIES.items():
        one, measured = answer(column(rows, name), MEASURED[name]), MEASURED[name]
        told = f"{said(one.middle)} (80 % of landers: {said(one.low)} to {said(one.high)})"
        lines.append(Line(words, f"{measured:g}, once", told, len(rows), f"{one.middle / measured:.2f}", one.agrees))
    return lines
