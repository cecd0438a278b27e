"""What a design costs, which inputs matter, and what may come out of a touchdown."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from lithobrake.report.figures.ground_map import density_colours
from lithobrake.report.figures.style import INK, INTERACTIONS, QUIET, SITE, TRAINING, input_colours
from lithobrake.statements.labels import PAPER_OUTPUTS, input_label, output
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.number_words import number, percent

Counts = NDArray[np.float64]

# Two sizes, so that two equal designs are both seen.
MARKERS = (("o", 11.0), ("D", 6.0))
# Of a name at a curve, in parts of the panel's height.
LINE_HEIGHT = 0.043
RING: dict[str, Any] = {"markerfacecolor": "none", "markeredgecolor": SITE, "markeredgewidth": 1.7}
# Cells along each axis: a hundred samples to each in the mean would show all there is, within these bounds.
FEWEST_CELLS, MOST_CELLS, TO_A_CELL = 12, 50, 20.0
COLOURS = density_colours(TRAINING)


@dataclass(frozen=True)
class Design:
    """A design of this study, to be marked in the figure; measure: whether it has a level or only a degree."""

    name: str
    input_count: int
    level: int
    node_count: int
    measure: str = "level"


def count_figure(
    input_counts: Sequence[int], levels: Sequence[int], tensor: Array, smolyak: Array, designs: Sequence[Design]
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


def _name_curves(axes: Axes, x: float, ends: Array, words: Sequence[str], shades: NDArray[np.float64]) -> None:
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


def sobol_figure(
    input_names: tuple[str, ...],
    sobol_first: dict[str, Array],
    spread: Mapping[str, float],
    scatter: dict[str, float | None],
) -> Figure:
    """Draw one ring an output; what is left of the whole belongs to interactions.

    sobol_first: output name to indices, shape [input]; spread: output name to standard deviation of the expansion [SI];
    scatter: output name to the share of the runs' variance that is scatter, None where that is not known.
    """
    names = [name for name in PAPER_OUTPUTS if name in sobol_first]
    colours = input_colours(input_names)
    handles = [Patch(color=colours[key], label=input_label(key)) for key in input_names]
    handles.append(Patch(color=INTERACTIONS, label="interactions"))
    columns = 3 if len(handles) > 4 else len(handles)
    # In inches: the rings with their titles, and a row of the legend for every three inputs.
    legend = 0.16 + 0.172 * -(-len(handles) // columns)
    height = 3.34 + legend
    figure = Figure(figsize=(9.2, height))
    for column, name in enumerate(names):
        place = (0.01 + column / len(names), legend / height, 0.98 / len(names), 3.0 / height)
        axes = figure.add_axes(place)
        _ring(axes, name, sobol_first[name], [colours[key] for key in input_names], spread[name])
        share = scatter[name]
        if share is not None:
            words = f"scatter: {percent(share)} of\nthe runs' variance"
            axes.text(0, -0.27, words, ha="center", va="top", fontsize=7, color=QUIET)
    figure.legend(handles=handles, loc="lower center", ncols=columns, handlelength=1.0, handleheight=1.0)
    return figure


def _ring(axes: Axes, name: str, first: Array, colours: list[str], spread: float) -> None:
    """One ring with the share in per cent on every piece that has room for it."""
    shown = output(name)
    axes.set_title(f"{shown.words} {shown.symbol}".strip(), loc="center")
    if spread == 0.0:
        axes.set(aspect="equal", xlim=(-1.05, 1.05), ylim=(-1.05, 1.05))
        axes.axis("off")
        axes.text(0, 0, "no significant\ninput", ha="center", va="center", color=QUIET)
        return
    shares = np.append(np.clip(first, 0.0, None), max(0.0, 1.0 - float(np.sum(first))))
    wedges, *_ = axes.pie(
        shares,
        colors=[*colours, INTERACTIONS],
        startangle=90,
        counterclock=False,
        radius=1.0,
        wedgeprops={"width": 0.40, "edgecolor": "white", "linewidth": 1.2},
    )
    for wedge, share in zip(wedges, shares / shares.sum(), strict=True):
        if share < 0.035:
            continue
        angle = np.radians(0.5 * (wedge.theta1 + wedge.theta2))
        dark = sum(wedge.get_facecolor()[k] * weight for k, weight in enumerate((0.3, 0.59, 0.11))) < 0.62
        axes.text(
            0.8 * np.cos(angle),
            0.8 * np.sin(angle),
            percent(share),
            ha="center",
            va="center",
            fontsize=8,
            fontweight="bold",
            color="white" if dark else "#1c2733",
        )
    axes.text(0, 0.06, number(spread * shown.factor, 2), ha="center", va="center", fontsize=12, fontweight="bold")
    axes.text(0, -0.16, f"{shown.unit} spread", ha="center", va="center", fontsize=7.5, color=QUIET)
    # A pie sets limits of its own.
    axes.set(xlim=(-1.05, 1.05), ylim=(-1.05, 1.05))


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
