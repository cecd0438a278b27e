"""The figures of the forecast: shares at rest by branch, and places of rest on maps of equal area."""

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt
import numpy as np
from harness import Row

from lithobrake.report.figures.style import INK, QUIET, RULE, TRAINING, figure_style
from lithobrake.vocabulary.outcomes import END_COLOURS, JourneyEnd

SOIL, HARD = END_COLOURS[JourneyEnd.AT_REST], QUIET
AIMS = (0.0, 180.0)


def draw_shares(landers: dict[str, Any], path: Path) -> None:
    """Shares at rest with their intervals, on soil and on hard ground, in all and by branch."""
    with figure_style():
        figure, axes = plt.subplots(1, len(landers), figsize=(9.6, 3.3), sharex=True, constrained_layout=True)
        for ax, (name, of) in zip(axes, landers.items(), strict=True):
            rows = [("all branches", *(of[ground]["ends"]["at_rest"] for ground in ("soil", "hard")))]
            hard = {one["branch"]: one["at_rest"] for one in of["hard"]["by_branch"]}
            rows += [(one["branch"], one["at_rest"], hard[one["branch"]]) for one in of["soil"]["by_branch"]]
            for place, (_, soil, rock) in enumerate(rows):
                for one, colour, shift in ((soil, SOIL, -0.13), (rock, HARD, 0.13)):
                    ax.plot([100 * one["lower"], 100 * one["upper"]], [place + shift] * 2, color=colour, lw=2.2)
                    ax.plot(100 * one["share"], place + shift, "o", color=colour, ms=5)
            ax.set_yticks(range(len(rows)), [row[0] for row in rows])
            ax.set_ylim(len(rows) - 0.5, -0.5)
            ax.axhline(0.5, color=RULE, lw=0.8)
            ax.set_xlim(0, 100)
            ax.set_xlabel("at rest on Dimorphos [%]")
            ax.set_title(name.capitalize())
        axes[0].plot([], [], "o-", color=SOIL, label="soil")
        axes[0].plot([], [], "o-", color=HARD, label="hard ground, restitution from 0 to 1")
        figure.legend(loc="outside lower center", ncols=2)
        figure.savefig(path)
        plt.close(figure)


def draw_map(rows: list[Row], landers: dict[str, Any], path: Path) -> None:
    """Places of rest on soil, with the smallest region that holds half of them (cylinder of equal area)."""
    with figure_style():
        figure, axes = plt.subplots(len(landers), 1, figsize=(7.6, 7.4), sharex=True, constrained_layout=True)
        for ax, (name, of) in zip(axes, landers.items(), strict=True):
            for line in of["soil"]["regions"][0]["outlines"]:
                latitude, longitude = np.array(line).T
                ax.plot(longitude, np.sin(np.radians(latitude)), color=INK, lw=1.8)
            own = [row for row in rows if (row["lander"], row["ground"], row["end"]) == (name, "soil", "at_rest")]
            for rotation, colour in zip(("small", "large", "rolling"), (SOIL, "#e69f00", "#a8659a"), strict=True):
                here = [row for row in own if row["branch"].startswith(rotation)]
                ax.plot(
                    [row["longitude_deg"] for row in here], np.sin(np.radians([row["latitude_deg"] for row in here])),
                    "o", ms=2.6, color=colour, label=rotation if rotation == "rolling" else f"{rotation} libration",
                )  # fmt: skip
            ax.plot([0.0, 180.0, -180.0], [0.0] * 3, "+", ms=11, mew=1.8, color=TRAINING, label="aims")
            ticks = np.array([-90, -60, -30, 0, 30, 60, 90])
            ax.set_yticks(np.sin(np.radians(ticks)), [str(one) for one in ticks])
            ax.set_xticks(range(-180, 181, 45))
            ax.grid(True)
            ax.set_xlim(-180, 180)
            ax.set_ylim(-1, 1)
            ax.set_ylabel("latitude [deg]")
            ax.set_title(f"{name.capitalize()}: places of rest, and the smallest region with half of them")
        axes[-1].set_xlabel("east longitude [deg]; 0 faces Didymos while Dimorphos turns with its orbit")
        axes[0].legend(loc="lower center", bbox_to_anchor=(0.5, 1.1), ncols=4)
        figure.savefig(path)
        plt.close(figure)
