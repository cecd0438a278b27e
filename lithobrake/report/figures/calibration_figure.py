"""Whether the emulator predicts landings on beds that it has not seen."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from lithobrake.report.figures.style import INK, QUIET, TEST, TRAINING
from lithobrake.report.words.chance import band_luck, luck, unlucky
from lithobrake.report.words.labels import output
from lithobrake.results.emulator_results import OutputScore

LUCK = "#e3e7eb"


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
        words = f"{shown.symbol or shown.words}: {100 * held:.0f} %"
        axes.text(0.0, row - 0.36, words, transform=axes.get_yaxis_transform(), fontsize=8.5)
    axes.axvline(0.9, color=QUIET, linewidth=0.9, zorder=1)
    axes.set_title("in the 90 % band")
    lowest = min([0.75, *(score.band_90 - 0.05 for score in scores.values())])
    axes.set_xlim(lowest, 1.0)
    axes.set_ylim(len(scores) - 0.4, -0.7)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.xaxis.set_major_formatter(lambda value, place: f"{100 * value:.0f}")
    axes.set_xlabel("runs held [%]")
