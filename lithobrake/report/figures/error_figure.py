"""How far the expansion is from the soft-surface model, on runs it has seen and on runs it has not."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from lithobrake.report.figures.style import INK, QUIET, TEST, TEST_ALL, TRAINING
from lithobrake.report.words.labels import PAPER_OUTPUTS, Output, output
from lithobrake.report.words.numbers import number, q2_words
from lithobrake.results.expansions import OutputErrors

Array = NDArray[np.float64]
ErrorsByOutput = Mapping[str, OutputErrors]

# Words and lines need more contrast with white than bars do.
TEXT = {TRAINING: TRAINING, TEST: "#a8690a", TEST_ALL: "#5f656d"}


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
            f"{len(_errors(score))} runs: MAPE {mape}, $Q^2$ {q2_words(score)}\n"
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
