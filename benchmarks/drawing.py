"""Figures of pages, all in the style of the reports."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt

from lithobrake.report.figures.style import STYLE


@contextmanager
def figure(
    path: Path, rows: int, columns: int, size: tuple[float, float], dpi: float | None = None, **shared: Any
) -> Iterator[tuple[Any, Any]]:
    """A figure and its panels to draw in, written to a path [size in inch]; shared: what panels share, as `sharey`."""
    with plt.rc_context(STYLE):
        drawn, axes = plt.subplots(rows, columns, figsize=size, layout="constrained", **shared)
        yield drawn, axes
        drawn.savefig(path, dpi=dpi)
        plt.close(drawn)
