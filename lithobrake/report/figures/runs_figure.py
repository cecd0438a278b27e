"""All its landings, each of which is a draw, and how they lie on the beds."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from lithobrake.report.figures.style import INK, QUIET, SITE, TRAINING
from lithobrake.report.words.labels import output
from lithobrake.vocabulary.outcomes import TouchdownOutcome

Array = NDArray[np.float64]

# In inches: a bed's row, and what stands above and below the rows.
BED_HEIGHT, MARGINS = 0.115, 1.07
DOT: dict[str, Any] = {"s": 13.0, "color": TRAINING, "alpha": 0.75, "linewidths": 0, "zorder": 3}
RING: dict[str, Any] = {"s": 34.0, "facecolors": "none", "edgecolors": SITE, "linewidths": 1.1, "zorder": 4}
WORDS_OF_QUANTILES = {"0.05": "5 %", "0.5": "median", "0.95": "95 %"}


@dataclass(frozen=True)
class LandingsOfRuns:
    """Landings as they ended, all of shape [run_count].

    speed [m/s] and elevation [rad] after the touchdown, NaN where the lander did not leave; outcome: words; over_rim:
    whether it left over the rim of the bed; bed: its number.
    """

    speed: Array
    elevation: Array
    outcome: NDArray[np.str_]
    over_rim: NDArray[np.bool_]
    bed: NDArray[np.int64]

    @property
    def has_speed(self) -> NDArray[np.bool_]:
        """Which landers left the surface, with outputs."""
        return (self.outcome == TouchdownOutcome.CLEAR) & np.isfinite(self.speed + self.elevation)

    @property
    def is_captured(self) -> NDArray[np.bool_]:
        """Which landers were captured."""
        return np.asarray(self.outcome == TouchdownOutcome.CAPTURED)

    @property
    def has_no_outcome(self) -> NDArray[np.bool_]:
        """Which landings have an unknown outcome."""
        return ~(self.has_speed | self.is_captured)


def runs_figure(landings: LandingsOfRuns, quantiles: Mapping[str, Mapping[str, float]]) -> Figure:
    """Draw speed against elevation of the landers that left, and their speeds bed by bed, over one axis of speed.

    quantiles: of speed_out and elevation_out [SI] by level, as "0.5"; an output that lacks them has no lines.
    """
    bed_count = int(landings.bed.max()) + 1
    height = max(3.7, MARGINS + BED_HEIGHT * bed_count)
    figure = Figure(figsize=(9.2, height))
    left, right = figure.subplots(1, 2)
    figure.subplots_adjust(left=0.07, right=0.985, top=1 - 0.42 / height, bottom=0.65 / height, wspace=0.33)
    draw_rebounds(left, landings, quantiles)
    _bed_by_bed(right, landings, bed_count)
    speed = quantiles.get("speed_out", {})
    for level, value in speed.items():
        for axes in (left, right):
            axes.axvline(value, **_line(level))
        label = WORDS_OF_QUANTILES.get(level, level)
        left.annotate(label, (value, 1.0), (0, 2), **_at(left.get_xaxis_transform()), ha="center", fontsize=7)
    largest = 1.06 * float(np.max(landings.speed, where=landings.has_speed, initial=0.0)) or 1.0
    left.set_xlim(0.0, largest)
    # Room on the left for those without a speed.
    right.set_xlim(-0.4 * largest, largest)
    right.axvline(0.0, color=QUIET, linewidth=0.7, zorder=2)
    right.set_xticks([tick for tick in right.get_xticks() if 0.0 <= tick <= largest])
    _legend(figure, landings)
    return figure


def draw_rebounds(axes: Axes, landings: LandingsOfRuns, quantiles: Mapping[str, Mapping[str, float]]) -> None:
    """Every lander that left, by speed and elevation, with the quantiles of the elevation."""
    shown, left = output("elevation_out"), landings.has_speed
    elevation = shown.factor * landings.elevation
    axes.scatter(landings.speed[left], elevation[left], **DOT)
    rim = left & landings.over_rim
    axes.scatter(landings.speed[rim], elevation[rim], **RING)
    for level, value in quantiles.get("elevation_out", {}).items():
        axes.axhline(shown.factor * value, **_line(level))
        label = WORDS_OF_QUANTILES.get(level, level)
        place = (1.0, shown.factor * value)
        axes.annotate(label, place, (3, 0), **_at(axes.get_yaxis_transform()), va="center", fontsize=7)
    axes.set_xlabel(output("speed_out").label)
    axes.set_ylabel(shown.label)
    axes.set_ylim(0.0, 90.0)
    axes.set_yticks(range(0, 91, 15))


def _bed_by_bed(axes: Axes, landings: LandingsOfRuns, bed_count: int) -> None:
    """The speeds on each bed, and to the left how many of its landers have none."""
    left = landings.has_speed
    for bed in range(0, bed_count, 2):
        axes.axhspan(bed - 0.5, bed + 0.5, color="#f3f5f7", linewidth=0, zorder=0)
    axes.scatter(landings.speed[left], landings.bed[left], **DOT)
    rim = left & landings.over_rim
    axes.scatter(landings.speed[rim], landings.bed[rim], **RING)
    # In parts of the panel's width.
    for words, chosen, place in (
        (TouchdownOutcome.CAPTURED.value, landings.is_captured, 0.07),
        ("unknown outcome", landings.has_no_outcome, 0.2),
    ):
        if not chosen.any():
            continue
        counts = np.bincount(landings.bed[chosen], minlength=bed_count)
        axes.text(place, 1.01, words.replace(" ", "\n"), transform=axes.transAxes, ha="center", va="bottom", fontsize=7)
        for bed in np.flatnonzero(counts).tolist():
            where = axes.get_yaxis_transform()
            axes.text(place, bed, str(counts[bed]), transform=where, ha="center", va="center_baseline", fontsize=7.5)
    axes.set_ylim(bed_count - 0.5, -0.5)
    axes.set_yticks(range(0, bed_count, -(-bed_count // 12)))
    axes.set_xlabel(output("speed_out").label)
    axes.set_ylabel("bed")


def _line(level: str) -> dict[str, Any]:
    return {"color": INK, "linewidth": 0.9, "linestyle": "-" if level == "0.5" else "--", "zorder": 2}


def _at(place: Any) -> dict[str, Any]:
    """Words beside a place of an axis, in points from it."""
    return {"xycoords": place, "textcoords": "offset points", "color": QUIET}


def _legend(figure: Figure, landings: LandingsOfRuns) -> None:
    """Say what the marks are, as far as there are any."""
    handles = [Line2D([], [], marker="o", markersize=4, linestyle="none", color=TRAINING, label="left the surface")]
    if (landings.has_speed & landings.over_rim).any():
        ring = Line2D([], [], marker="o", markersize=6, linestyle="none", markerfacecolor="none", markeredgecolor=SITE)
        ring.set_label("of these: across the edge of the bed")
        handles.append(ring)
    handles.append(
        Line2D([], [], color=INK, linewidth=0.9, linestyle="--", label="5 % and 95 % of the landings, and median")
    )
    figure.legend(handles=handles, loc="lower center", ncols=3, handletextpad=0.5, borderaxespad=0.1)
