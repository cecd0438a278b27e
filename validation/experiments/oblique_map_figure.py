"""The figure of the map of outcomes: shares with their intervals over speed and angle, a column for each lander."""

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np

from lithobrake.report.figures.style import STYLE

PANELS = {
    "stop": "stops on the bed",
    "along": "goes along the ground farther than its length",
    "bounce": "bounces off where it came down",
    "speed": "rebound / impact speed (median, quartiles)",
}


def value_and_text(entry: dict[str, Any], panel: str) -> tuple[float, str]:
    """Return what colours a cell, and what is written in it."""
    if panel == "speed" and entry["speed_ratio_quartiles"] is None:
        return float("nan"), "none\nleft"
    if panel == "speed":
        low, middle, high = entry["speed_ratio_quartiles"]
        return middle, f"{middle:.2f}\n{low:.2f}-{high:.2f}"
    share = entry["shares"][panel]
    low, high = share["interval"]
    return share["share"], f"{share['count']} of {entry['landings']}\n{low:.2f}-{high:.2f}"


def draw(cells: list[dict[str, Any]], path: Path) -> None:
    """Draw the map."""
    shapes = list(dict.fromkeys(entry["shape"] for entry in cells))
    speeds = sorted({entry["speed"] for entry in cells})
    angles = sorted({entry["incidence_deg"] for entry in cells})
    plt.rcParams.update(STYLE)
    figure, axes = plt.subplots(
        len(PANELS), len(shapes), figsize=(4.6 * len(shapes), 9.4), squeeze=False, layout="constrained",
        sharex=True, sharey=True,
    )  # fmt: skip
    for column, shape in enumerate(shapes):
        for axis, (panel, title) in zip(axes[:, column], PANELS.items(), strict=True):
            shown = np.full((len(speeds), len(angles)), np.nan)
            for entry in (entry for entry in cells if entry["shape"] == shape):
                place = speeds.index(entry["speed"]), angles.index(entry["incidence_deg"])
                shown[place], text = value_and_text(entry, panel)
                colour = "white" if shown[place] > 0.55 else "black"
                axis.text(place[1], place[0], text, ha="center", va="center", fontsize=8, color=colour)
            axis.imshow(shown, origin="lower", aspect="auto", cmap="Blues", vmin=0.0, vmax=1.0)
            axis.set_xticks(range(len(angles)), [f"{angle:g}" for angle in angles])
            axis.set_yticks(range(len(speeds)), [f"{speed:g}" for speed in speeds])
            axis.set_title(f"{shape}: {title}", fontsize=8.5)
    figure.supxlabel("angle from the normal [deg]", fontsize=9)
    figure.supylabel("speed [m/s]", fontsize=9)
    figure.savefig(path)
    plt.close(figure)
