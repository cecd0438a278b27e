"""How well emulator and expansion predict, and what bounces say of the inputs."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullFormatter
from numpy.typing import NDArray

from lithobrake.files.atomic import atomic_path
from lithobrake.files.reading import read_json
from lithobrake.report.figures.style import INK, INTERACTIONS, LANDER, QUIET, TEST, TEST_ALL, TRAINING, figure_style
from lithobrake.results.model_results import OutputErrors, OutputScore
from lithobrake.statements.expansion import q2
from lithobrake.statements.labels import PAPER_OUTPUTS, Output, input_label, output
from lithobrake.statements.touchdowns import BAND, band_luck, luck, unlucky
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.number_words import number, percent

LUCK = "#e3e7eb"
BINS = 20
WORDS = "grey: before; blue: after"
# A law whose median lies below this part of the middle of its ends is drawn by its logarithm.
SKEWED = 0.5
# In inches, about the plots.
LEFT, BELOW, BESIDE = 0.8, 0.55, 0.3
_INPUT = {"unit": str, "prior": [float], "points": [float], "sd_ratio": float}
_FORM = {"statement": str, "inputs": {str: _INPUT}}
ErrorsByOutput = Mapping[str, OutputErrors]
# Words and lines need more contrast with white than bars do.
TEXT = {TRAINING: TRAINING, TEST: "#a8690a", TEST_ALL: "#5f656d"}


def calibration_figure(scores: Mapping[str, OutputScore]) -> Figure:
    """Draw a histogram for each output of the PIT values of its runs, and how many the 90 % bands held."""
    figure = Figure(figsize=(9.2, 3.1))
    grid = figure.subplots(1, len(scores) + 1, width_ratios=[*[1.0] * len(scores), 0.8])
    figure.subplots_adjust(left=0.06, right=0.985, top=0.89, bottom=0.17, wspace=0.32)
    for axes, (name, score) in zip(grid, scores.items(), strict=False):
        _histogram(axes, name, score.pit)
    grid[0].set_ylabel("runs")
    _bands(grid[-1], scores)
    return figure


def _histogram(axes: Axes, name: str, counts: Sequence[int]) -> None:
    shown = output(name)
    edges = np.linspace(0.0, 1.0, len(counts) + 1)
    low, high = luck(counts)
    # Before and behind the bars, so that where a bar ends can be seen against it.
    axes.axhspan(max(low, 0.0), high, color=LUCK, linewidth=0, zorder=0)
    axes.axhspan(max(low, 0.0), high, facecolor="none", edgecolor=QUIET, linestyle=":", linewidth=0.9, zorder=3)
    axes.axhline(sum(counts) / len(counts), color=INK, linewidth=0.9, zorder=3)
    colours = [TEST if beyond else TRAINING for beyond in unlucky(counts)]
    axes.bar(
        edges[:-1], counts, np.diff(edges), align="edge", color=colours, edgecolor="white", linewidth=0.6, alpha=0.75
    )
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=6))
    axes.set_title(f"{shown.words} {shown.symbol}".strip())
    axes.set_xlim(0.0, 1.0)
    axes.set_xticks([0.0, 0.5, 1.0], ["0", "0.5", "1"])
    axes.set_xlabel("PIT value")


def _bands(axes: Axes, scores: Mapping[str, OutputScore]) -> None:
    """The share of runs that the bands held, beside what luck alone does to it."""
    for row, (name, score) in enumerate(scores.items()):
        shown, held, (low, high) = output(name), score.band_90, band_luck(sum(score.pit))
        axes.barh(row, high - low, left=low, height=0.5, color=LUCK, zorder=0)
        colour = TRAINING if low <= held <= high else TEST
        axes.plot(held, row, "o", color=colour, markersize=6, zorder=3)
        words = f"{shown.symbol or shown.words}: {percent(held)}"
        axes.text(0.0, row - 0.36, words, transform=axes.get_yaxis_transform(), fontsize=8.5)
    axes.axvline(BAND, color=QUIET, linewidth=0.9, zorder=1)
    axes.set_title(f"in the {percent(BAND)} band")
    lowest = min([0.75, *(score.band_90 - 0.05 for score in scores.values())])
    axes.set_xlim(lowest, 1.0)
    axes.set_ylim(len(scores) - 0.4, -0.7)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.xaxis.set_major_formatter(lambda value, place: f"{100 * value:.0f}")
    axes.set_xlabel("runs held [%]")


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
    axes.set_title(f"{percent(one['sd_ratio'])} of sd left", fontsize=7.5, loc="right", pad=3, color=QUIET)
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


def error_figure(training: ErrorsByOutput, test_kept: ErrorsByOutput, test_all: ErrorsByOutput) -> Figure:
    """Draw histograms of the absolute percentage error; dashed lines stand at the means.

    Above: the kept inputs vary, training and test. Below: all inputs vary, which is what the real landing will see.
    """
    names = [name for name in PAPER_OUTPUTS if name in training]
    figure = Figure(figsize=(9.2, 6.6))
    grid = figure.subplots(2, len(names), squeeze=False)
    figure.subplots_adjust(left=0.065, right=0.98, top=0.80, bottom=0.07, wspace=0.2, hspace=0.85)
    rows = (
        ((("training", training, TRAINING), ("test, kept inputs vary", test_kept, TEST))),
        ((("test, all inputs vary", test_all, TEST_ALL),)),
    )
    for row, sets in enumerate(rows):
        for column, name in enumerate(names):
            series = [(words, scores[name], colour) for words, scores, colour in sets]
            _panel(grid[row, column], name, series)
            if column == 0:
                grid[row, column].set_ylabel("share of runs per bin")
    return figure


def _errors(score: OutputErrors) -> Array:
    """Absolute percentage errors of the runs [%]; one whose true value is zero has none, and counts in other scores."""
    return np.array([error for error in score.ape or () if error is not None], dtype=float)


def _panel(axes: Axes, name: str, series: Sequence[tuple[str, OutputErrors, str]]) -> None:
    """One output: shares of runs over the error in per cent, and the figures that keep a MAPE honest."""
    shown = output(name)
    limit, beyond = _limit([_errors(score) for _, score, _ in series])
    bins = np.linspace(0.0, limit, 17).tolist()
    for words, score, colour in series:
        errors = _errors(score)
        weights = np.full(len(errors), 1.0 / max(len(errors), 1))
        axes.hist(
            np.minimum(errors, limit),
            bins=bins,
            weights=weights,
            color=colour,
            alpha=0.62,
            label=words,
            edgecolor="white",
            linewidth=0.4,
        )
        if score.mape is not None:
            axes.axvline(min(score.mape, limit), color=TEXT[colour], linestyle="--", linewidth=1.5)
    axes.set_xlim(0, limit)
    axes.set_xlabel("absolute percentage error [%]", labelpad=2)
    axes.tick_params(axis="y", colors=QUIET)
    if beyond:
        axes.annotate(
            f"{beyond} beyond", (1.0, 1.0), xycoords="axes fraction", ha="right", va="top", fontsize=7, color=QUIET
        )
    _write_figures(axes, shown, series)


def _write_figures(axes: Axes, shown: Output, series: Sequence[tuple[str, OutputErrors, str]]) -> None:
    """Write the figures of each series above the panel, where no bar can run into them; the last is the lowest."""
    y = 1.03
    for words, score, colour in reversed(series):
        mape = "undefined" if score.mape is None else f"{score.mape:.3g} %"
        lines = (
            f"{len(_errors(score))} runs: MAPE {mape}, $Q^2$ {q2(score)}\n"
            f"RMSE {number(score.rmse * shown.factor, 2)} at a spread of "
            f"{number(score.std * shown.factor, 2)} {shown.unit}"
        )
        axes.text(0, y, lines, transform=axes.transAxes, va="bottom", fontsize=7.4, color=INK, linespacing=1.3)
        axes.text(
            0,
            y + 0.165,
            words,
            transform=axes.transAxes,
            va="bottom",
            fontsize=7.8,
            fontweight="bold",
            color=TEXT[colour],
        )
        y += 0.285
    axes.text(
        0,
        y + 0.01,
        f"{shown.words} {shown.symbol}",
        transform=axes.transAxes,
        va="bottom",
        fontsize=9.5,
        fontweight="bold",
    )


def _limit(errors: Sequence[Array]) -> tuple[float, int]:
    """End of the axis [%] and how many runs lie beyond it: a few wild ones must not squeeze the rest into one bin."""
    together = np.concatenate(list(errors))
    largest, usual = float(together.max()), float(np.quantile(together, 0.95))
    limit = largest if largest <= 2.0 * usual else 1.25 * usual
    limit = max(limit, 1e-12)
    return limit, int(np.sum(together > limit * (1 + 1e-12)))
