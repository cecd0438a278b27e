"""Figure of the landers: time, contacts and path until they rest, by what the first contact was on."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from answers import MEASURED, TAILS, column
from harness import Row

from lithobrake.report.figures.style import INK, INPUT_COLOURS, WASH, figure_style

LINES = ("-", "--", "-.", ":")
WORDS = {
    "time_s": "time from the first contact to rest [s]", "contacts": "contacts, the first included",
    "path_m": "path [m]",
}  # fmt: skip


def of_landers(settings: dict[str, list[Row]], to: Path) -> None:
    """Distribution functions of the three quantities, with the central 80 % of each marked, and MASCOT."""
    with figure_style():
        figure, axes = plt.subplots(1, 3, figsize=(9.2, 3.7), layout="constrained", sharey=True)
        for axis, (name, measured) in zip(axes, MEASURED.items(), strict=True):
            axis.axhspan(*TAILS, color=WASH, zorder=0)
            for ink, line, (setting, rows) in zip(INPUT_COLOURS, LINES, settings.items(), strict=False):
                values = np.sort(column(rows, name))
                part = (np.arange(len(values)) + 1.0) / len(values)
                axis.step(values, part, line, where="post", color=ink, label=f"{setting} ({len(values)})")
            axis.axvline(measured, color=INK, lw=1.0, label="MASCOT")
            most = max(float(np.quantile(column(rows, name), 0.98)) for rows in settings.values())
            axis.set(xlabel=WORDS[name], xlim=(0.0, max(most, 1.2 * measured)), ylim=(0.0, 1.0))
        axes[0].set(ylabel="share of the landers")
        handles, labels = axes[0].get_legend_handles_labels()
        title = {"title": "first contact (landers)", "title_fontsize": 8}
        figure.legend(handles, labels, loc="outside lower center", ncols=5, **title)
        figure.savefig(to)
    plt.close(figure)
