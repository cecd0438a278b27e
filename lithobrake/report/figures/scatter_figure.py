"""Figure 6: the outputs of the Monte Carlo on the expansion, coloured by one input."""

from collections.abc import Mapping
from itertools import combinations

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from lithobrake.report.figures.style import PAPER_OUTPUTS, QUIET, output

Array = NDArray[np.float64]

# More dots than this only cover each other, and a picture of ten million takes minutes.
DRAWN_COUNT = 200_000


def scatter_figure(outputs: Mapping[str, Array], colour: tuple[str, Array], leaves: NDArray[np.bool_]) -> Figure:
    """Draw every pair of outputs of the samples that leave the surface, of the first `DRAWN_COUNT` of them.

    outputs: name to values [SI], shape [sample]; colour: label and values of an input; leaves: shape [sample].
    """
    names = [name for name in PAPER_OUTPUTS if name in outputs]
    pairs = list(combinations(names, 2))
    figure = Figure(figsize=(9.2, 3.45))
    grid = figure.subplots(1, len(pairs), squeeze=False)[0]
    figure.subplots_adjust(left=0.07, right=0.9, top=0.96, bottom=0.15, wspace=0.3)
    drawn = np.flatnonzero(leaves)[:DRAWN_COUNT]
    size = float(np.clip(2e4 / max(len(drawn), 1), 0.25, 6.0))
    for axes, (first, second) in zip(grid, pairs, strict=True):
        x, y = (outputs[name][drawn] * output(name).factor for name in (first, second))
        points = axes.scatter(
            x, y, c=colour[1][drawn], s=size, cmap="viridis", linewidths=0, alpha=0.55, rasterized=True
        )
        axes.set_xlabel(output(first).label)
        axes.set_ylabel(output(second).label)
        axes.set_xlim(*_window(x))
        axes.set_ylim(*_window(y))
        axes.grid(visible=True)
        axes.locator_params(nbins=6)
    bar_axes = figure.add_axes((0.92, 0.15, 0.014, 0.81))
    norm = points.norm
    bar = figure.colorbar(matplotlib.cm.ScalarMappable(norm=norm, cmap="viridis"), cax=bar_axes)
    bar.set_label(colour[0])
    bar.outline.set_visible(False)
    bar_axes.tick_params(colors=QUIET)
    return figure


def _window(values: Array) -> tuple[float, float]:
    """All values, with a margin."""
    low, high = float(np.min(values)), float(np.max(values))
    margin = 0.04 * (high - low) or 1e-9
    return low - margin, high + margin
