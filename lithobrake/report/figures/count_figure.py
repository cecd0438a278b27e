"""What a design costs, as the number of inputs and the level grow."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from lithobrake.report.figures.style import INK, QUIET, SITE

Counts = NDArray[np.float64]

# Two sizes, so that two equal designs are both seen.
MARKERS = (("o", 11.0), ("D", 6.0))
# Of a name at a curve, in parts of the panel's height.
LINE_HEIGHT = 0.043
RING: dict[str, Any] = {"markerfacecolor": "none", "markeredgecolor": SITE, "markeredgewidth": 1.7}


@dataclass(frozen=True)
class Design:
    """A design of this study, to be marked in the figure; measure: whether it has a level or only a degree."""

    name: str
    input_count: int
    level: int
    node_count: int
    measure: str = "level"


def count_figure(
    input_counts: Sequence[int], levels: Sequence[int], tensor: Counts, smolyak: Counts, designs: Sequence[Design]
) -> Figure:
    """Draw node counts, shape [input count, level], against the number of inputs (left) and the level (right)."""
    figure = Figure(figsize=(9.2, 3.7))
    left, right = figure.subplots(1, 2, sharey=True)
    figure.subplots_adjust(left=0.08, right=0.985, top=0.97, bottom=0.225, wspace=0.06)
    shades = matplotlib.colormaps["viridis"](np.linspace(0.05, 0.85, len(levels)))
    for index, level in enumerate(levels):
        left.plot(input_counts, tensor[:, index], "--", color=shades[index], linewidth=1.0)
        left.plot(input_counts, smolyak[:, index], "-", color=shades[index], linewidth=1.7, label=f"level {level}")
    input_shades = matplotlib.colormaps["viridis"](np.linspace(0.05, 0.85, len(input_counts)))
    for index in range(len(input_counts)):
        right.plot(levels, tensor[index], "--", color=input_shades[index], linewidth=1.0)
        right.plot(levels, smolyak[index], "-", color=input_shades[index], linewidth=1.7)
    for axes, label, ticks in ((left, "number of uncertain inputs", input_counts), (right, "level (degree)", levels)):
        axes.set_yscale("log")
        axes.set_xlabel(label)
        axes.set_xticks(list(ticks))
        axes.grid(visible=True, axis="y")
        span = ticks[-1] - ticks[0]
        axes.set_xlim(ticks[0] - 0.04 * span, ticks[-1] + 0.17 * span)
    left.set_ylim(0.8, 3.0 * float(np.max(smolyak)) * 10)
    left.set_ylabel("runs")
    _name_curves(left, input_counts[-1], smolyak[-1], [f"level {level}" for level in levels], shades)
    words = [f"{count} inputs" if count > 1 else "1 input" for count in input_counts]
    _name_curves(right, levels[-1], smolyak[:, -1], words, input_shades)
    _mark(left, right, designs)
    _legend(figure, designs)
    return figure


def _name_curves(axes: Axes, x: float, ends: Counts, words: Sequence[str], shades: NDArray[np.float64]) -> None:
    """Name curves at their right ends, from the highest down; one too close below a name stays without."""
    places = (axes.transData + axes.transAxes.inverted()).transform([(x, end) for end in ends])[:, 1]
    free = np.inf
    for index in reversed(range(len(ends))):
        if places[index] > free:
            continue
        free = places[index] - LINE_HEIGHT
        axes.annotate(
            words[index],
            (x, ends[index]),
            xytext=(9, 0),
            textcoords="offset points",
            va="center",
            fontsize=7.5,
            color=shades[index],
        )


def _mark(left: Axes, right: Axes, designs: Sequence[Design]) -> None:
    """Ring the designs of this study in both panels."""
    for design, (marker, size) in zip(designs, MARKERS, strict=False):
        for axes, x in ((left, design.input_count), (right, design.level)):
            axes.plot(x, design.node_count, marker, markersize=size, zorder=5, **RING)


def _legend(figure: Figure, designs: Sequence[Design]) -> None:
    """Say what the lines are and what the designs of this study cost, under both panels."""
    handles = [
        Line2D([], [], color=QUIET, linestyle="--", linewidth=1.0, label="full tensor grid"),
        Line2D([], [], color=INK, linewidth=1.7, label="Smolyak sparse grid"),
    ]
    for design, (marker, size) in zip(designs, MARKERS, strict=False):
        plural = "s" if design.input_count > 1 else ""
        place = f"{design.measure} {design.level}"
        words = f"{design.name}: {design.input_count} input{plural}, {place}, {design.node_count} runs"
        handles.append(Line2D([], [], marker=marker, markersize=size, linestyle="none", label=words, **RING))
    figure.legend(handles=handles, loc="lower center", ncols=4, columnspacing=1.6)
