"""Figure of the landers: time, contacts and path until they rest, by what the first contact was on."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from answers import MEASURED, TAILS, column
from harness import Row

INKS = ("#1b6ca8", "#d1495b", "#6a8d3a", "#8a6bbe")
WORDS = {
    "time_s": "time from the first contact to rest [s]", "contacts": "contacts, the first included",
    "path_m": "path [m]",
}  # fmt: skip


def of_landers(settings: dict[str, list[Row]], to: Path) -> None:
    """Distribution functions of the three quantities, with the central 80 % of each marked, and MASCOT."""
    figure, axes = plt.subplots(1, 3, figsize=(12, 4.0), layout="constrained", sharey=True)
    for axis, (name, measured) in zip(axes, MEASURED.items(), strict=True):
        axis.axhspan(*TAILS, color="0.93", zorder=0)
        for ink, (setting, rows) in zip(INKS, settings.items(), strict=False):
            values = np.sort(column(rows, name))
            axis.step(values, (np.arange(len(values)) + 1.0) / len(values), where="post", color=ink,
                      label=f"{setting} ({len(values)})")  # fmt: skip
        axis.axvline(measured, color="black", ls="--", label="MASCOT")
        most = max(float(np.quantile(column(rows, name), 0.98)) for rows in settings.values())
        axis.set(xlabel=WORDS[name], xlim=(0.0, max(most, 1.2 * measured)), ylim=(0.0, 1.0))
    axes[0].set(ylabel="part of the landers")
    axes[2].legend(fontsize=8, loc="lower right", title="first contact (landers)")
    figure.savefig(to, dpi=110)
    plt.close(figure)
