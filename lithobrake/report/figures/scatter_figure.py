"""What may come out of a touchdown: the density of the samples of a model, and the runs on top."""

from collections.abc import Mapping
from itertools import combinations
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from lithobrake.report.figures.density import density_colours
from lithobrake.report.figures.style import INK, TRAINING
from lithobrake.report.words.labels import PAPER_OUTPUTS, output

Array = NDArray[np.float64]
# Cells along each axis: a hundred samples to each in the mean would show all there is, within these bounds.
FEWEST_CELLS, MOST_CELLS, TO_A_CELL = 12, 50, 20.0
COLOURS = density_colours(TRAINING)


def scatter_figure(samples: Mapping[str, Array], runs: Mapping[str, Array]) -> Figure:
    """Draw every pair of outputs: samples that leave the surface as counts in cells, runs as dots.

    samples and runs: name to values [SI], shape [count]; a run without outputs is NaN.
    """
    names = [name for name in PAPER_OUTPUTS if name in samples]
    pairs = list(combinations(names, 2))
    figure = Figure(figsize=(9.2, 3.6))
    grid = figure.subplots(1, len(pairs), squeeze=False)[0]
    figure.subplots_adjust(left=0.07, right=0.9, top=0.92, bottom=0.15, wspace=0.3)
    shown = {name: _shown(samples[name], name) for name in names}
    dots = {name: _shown(runs[name], name) for name in names if name in runs}
    bins = int(np.clip(np.sqrt(len(shown[names[0]]) / TO_A_CELL), FEWEST_CELLS, MOST_CELLS))
    counts = {pair: _counts(shown[pair[0]], shown[pair[1]], bins) for pair in pairs}
    norm = LogNorm(1.0, max(10.0, *(float(one[0].max()) for one in counts.values())))
    for axes, pair in zip(grid, pairs, strict=True):
        _draw_pair(axes, pair, counts[pair], norm)
        if all(name in dots for name in pair):
            axes.plot(*(dots[name] for name in pair), "o", color=INK, markersize=1.8, markeredgewidth=0.0)
    bar: Any = figure.colorbar(
        ScalarMappable(norm, COLOURS), cax=figure.add_axes((0.92, 0.15, 0.014, 0.77)), format="%g"
    )
    bar.set_label("samples in a cell")
    bar.outline.set_visible(False)
    dot = Line2D([], [], linestyle="none", marker="o", markersize=3, color=INK, label="runs")
    figure.legend(handles=[dot], loc="upper left", bbox_to_anchor=(0.06, 1.0), borderpad=0.0)
    return figure


def _shown(values: Array, name: str) -> Array:
    return np.asarray(values, dtype=float) * output(name).factor


def _counts(x: Array, y: Array, bins: int) -> tuple[Array, Array, Array]:
    """Counts in cells [bins, bins], and their edges along both axes."""
    counts, edges_x, edges_y = np.histogram2d(x, y, bins)
    return counts, edges_x, edges_y


def _draw_pair(axes: Axes, pair: tuple[str, str], found: tuple[Array, Array, Array], norm: LogNorm) -> None:
    counts, x, y = found
    axes.pcolormesh(x, y, np.ma.masked_equal(counts.T, 0), norm=norm, cmap=COLOURS, rasterized=True)
    axes.set_xlabel(output(pair[0]).label)
    axes.set_ylabel(output(pair[1]).label)
    axes.grid(visible=True)
    axes.locator_params(nbins=6)
