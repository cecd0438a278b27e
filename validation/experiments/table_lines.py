"""Rows of the table in which the page of the experiments holds ours against what was measured."""

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from fits import Estimate

HERE = Path(__file__).parent
PAGES = HERE.parents[1] / "docs" / "validation"
FIGURES = PAGES / "experiments"
NOT_SHOWN = "not shown"
SHARE = 0.25  # of a measured value: the tolerance of prefactors, coefficients, times, depths, speeds and densities


class Line(NamedTuple):
    """One quantity, as it was measured and as ours has it; cause: the row that shows why the two disagree."""

    quantity: str
    measured: str
    ours: str
    rows: int
    ratio: str
    agrees: bool
    cause: str = NOT_SHOWN

    def cells(self) -> list[str]:
        """Return the cells of its row of the table."""
        cells = [self.quantity, self.measured, self.ours, str(self.rows), self.ratio, "yes" if self.agrees else "no"]
        return [*cells, "" if self.agrees else self.cause]


Lines = list[Line]


def said(estimate: Estimate) -> str:
    """Return a value with its interval, to a thousandth, or to three digits where it is 10 or more."""
    digits = max(0, 3 - len(f"{abs(estimate.value):.0f}")) if abs(estimate.value) >= 10.0 else 3
    value = f"{estimate.value:.{digits}f}"
    return f"{value} +- {estimate.half:.{digits}f}" if math.isfinite(estimate.half) else value


def line(
    quantity: str, measured: float, ours: Estimate, bar: float, text: str = "", cause: str = NOT_SHOWN
) -> Line:  # fmt: skip
    """Return a row of the table: it agrees where our value is within a bar of the measured one."""
    ratio = f"{ours.value / measured:.2f}" if measured else "-"
    agrees = abs(ours.value - measured) <= bar
    return Line(quantity, text or f"{measured:.3g}", said(ours), ours.rows, ratio, agrees, cause)


def table_row(cells: Iterable[str]) -> str:
    """Return a line of a table."""
    return "| " + " | ".join(cells) + " |"


def table(heads: Sequence[str], rows: Iterable[Iterable[str]]) -> str:
    """Return a table."""
    return "\n".join([table_row(heads), "|---" * len(heads) + "|", *(table_row(row) for row in rows)])
