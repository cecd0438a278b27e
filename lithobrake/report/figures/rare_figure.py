"""What `lithobrake rare` found, as a figure: the way down to each rare limit state, level by level."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from lithobrake.report.figures.style import INPUT_COLOURS, RULE
from lithobrake.results.limit_state_results import RareLimitState


def rare_figure(rare: Mapping[str, RareLimitState]) -> Figure:
    """Draw the probability that is left against the distance from the limit, a line a limit state, falling to 0."""
    figure = Figure(figsize=(9.2, 3.9))
    axes = figure.subplots()
    figure.subplots_adjust(left=0.08, right=0.985, top=0.97, bottom=0.14)
    for (name, found), colour in zip(rare.items(), _colours(len(rare)), strict=True):
        left = np.cumprod(found.shares)
        axes.plot(found.thresholds, left, "-o", color=colour, linewidth=1.4, markersize=5.0, label=name)
        if found.reached and found.lower is not None and found.upper is not None:
            bounds = [[left[-1] - found.lower], [found.upper - left[-1]]]
            axes.errorbar(0.0, left[-1], bounds, color=colour, capsize=4.0, linewidth=1.4)
    axes.axvline(0.0, color=RULE, linewidth=0.8, zorder=0)
    axes.set_yscale("log")
    axes.invert_xaxis()
    axes.set_xlabel("distance from the limit [standard deviations of the first level]")
    axes.set_ylabel("probability of a smaller distance")
    axes.grid(visible=True, axis="y")
    axes.legend(frameon=False, loc="lower left")
    return figure


def _colours(count: int) -> list[str]:
    """A colour for each line, the same again after all."""
    return [INPUT_COLOURS[index % len(INPUT_COLOURS)] for index in range(count)]
