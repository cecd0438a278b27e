"""Rows of the table in which the page of the experiments holds ours against what was measured."""

import math
from pathlib import Path

from fits import Estimate

HERE = Path(__file__).parent
PAGES = HERE.parents[1] / "docs" / "validation"
FIGURES = PAGES / "experiments"
# Rows as text, and whether each agrees.
Lines = list[tuple[str, bool]]


def said(estimate: Estimate) -> str:
    """Return a value with its interval."""
    return f"{estimate.value:.3f} +- {estimate.half:.3f}" if math.isfinite(estimate.half) else f"{estimate.value:.3f}"


def line(quantity: str, measured: float, ours: Estimate, bar: float, text: str = "") -> tuple[str, bool]:
    """Return a row of the table: it agrees where our value is within a bar of the measured one."""
    agrees = abs(ours.value - measured) <= bar
    ratio = f"{ours.value / measured:.2f}" if measured else "-"
    return (
        f"| {quantity} | {text or f'{measured:.3g}'} | {said(ours)} | {ours.rows} | {ratio} | "
        f"{'yes' if agrees else 'no'} |",
        agrees,
    )
