"""A corner plot: what bounces say of each input and of each pair of them, over what was thought before."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter
from numpy.typing import NDArray

from lithobrake.files.atomic import atomic_path
from lithobrake.files.reading import read_json
from lithobrake.report.figures.style import INTERACTIONS, LANDER, QUIET, figure_style
from lithobrake.report.words.labels import input_label

BINS = 20
WORDS = "grey: before; blue: after"
# A law whose median lies below this part of the middle of its ends is drawn by its logarithm.
SKEWED = 0.5
# In inches, about the plots.
LEFT, BELOW, BESIDE = 0.8, 0.55, 0.3
_INPUT = {"unit": str, "prior": [float], "points": [float], "sd_ratio": float}
_FORM = {"statement": str, "inputs": {str: _INPUT}}


def write_corner(posterior: Path, picture: Path) -> None:
    """Draw the posterior.json of an inference as a corner plot, a PNG file: inputs before and after, and each pair.

    Raises ValueError for another file.
    """
    content = read_json(posterior, _FORM, "infer again with: lithobrake infer")
    with figure_style(), atomic_path(picture) as draft:
        corner_figure(content["inputs"]).savefig(draft, format="png", metadata={"Software": None})


def corner_figure(inputs: Mapping[str, Mapping[str, Any]]) -> Figure:
    """Draw each input's law after over that before (grey), and draws of each pair of inputs.

    inputs: of posterior.json, by dotted key: prior and points, draws of the law before and after in unit.
    """
    count, size = len(inputs), 1.75
    width, height = size * count + LEFT + BESIDE, size * count + BELOW + BESIDE
    figure = Figure(figsize=(width, height))
    table = figure.subplots(count, count, squeeze=False, gridspec_kw={"hspace": 0.12, "wspace": 0.12})
    scales = [_Scale(one) for one in inputs.values()]
    labels = [input_label(name, one["unit"].removeprefix("-")) for name, one in inputs.items()]
    for row, below in enumerate(inputs.values()):
        for column, beside in enumerate(inputs.values()):
            axes = table[row, column]
            if column > row:
                axes.set_axis_off()
                continue
            if column == row:
                _law(axes, scales[row], below)
            else:
                axes.plot(beside["points"], below["points"], ".", markersize=1.5, color=LANDER, alpha=0.35)
                scales[row].set_up(axes.yaxis, axes.set_ylim, axes.set_yscale)
            scales[column].set_up(axes.xaxis, axes.set_xlim, axes.set_xscale)
            _label(axes, labels, row, column, is_last=row == count - 1)
    figure.subplots_adjust(LEFT / width, BELOW / height, 1.0 - BESIDE / width, 1.0 - BESIDE / height)
    if count > 1:
        figure.text(1.0 - BESIDE / width, 1.0 - BESIDE / height, WORDS, ha="right", va="top", color=QUIET)
    return figure


class _Scale:
    """The scale of an input: its ends, by number or by logarithm, and bins that are equally wide on it."""

    def __init__(self, one: Mapping[str, Any]) -> None:
        """Take it from the law before."""
        prior: NDArray[np.float64] = np.array(one["prior"])
        self.lower, self.upper = float(prior.min()), float(prior.max())
        middle = 0.5 * (self.lower + self.upper)
        self.is_logarithmic = self.lower > 0.0 and float(np.median(prior)) < SKEWED * middle
        space = np.geomspace if self.is_logarithmic else np.linspace
        self.edges = space(self.lower, self.upper, BINS + 1)

    def set_up(self, axis: Any, set_ends: Any, set_scale: Any) -> None:
        """Give an axis this scale and these ends."""
        set_scale("log" if self.is_logarithmic else "linear")
        set_ends(self.lower, self.upper)
        axis.set_tick_params(labelsize=7)
        axis.set_minor_formatter(NullFormatter())


def _law(axes: Axes, scale: _Scale, one: Mapping[str, Any]) -> None:
    """Draw the law before and after, in steps that are equally wide on the scale."""
    for values, look in ((one["prior"], {"color": INTERACTIONS}), (one["points"], {"color": LANDER, "alpha": 0.7})):
        counts = np.histogram(values, scale.edges)[0] / len(values)
        axes.bar(scale.edges[:-1], counts, np.diff(scale.edges), align="edge", **look)
    axes.set_title(f"{100 * one['sd_ratio']:.0f} % of sd left", fontsize=7.5, loc="right", pad=3, color=QUIET)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)


def _label(axes: Axes, labels: list[str], row: int, column: int, *, is_last: bool) -> None:
    """Write names and numbers at the left and lower edge alone."""
    if is_last:
        axes.set_xlabel(labels[column], fontsize=7.5)
    else:
        axes.tick_params(axis="x", labelbottom=False)
    if column == 0 and row > 0:
        axes.set_ylabel(labels[row], fontsize=7.5)
    elif column < row:
        axes.tick_params(axis="y", labelleft=False)
