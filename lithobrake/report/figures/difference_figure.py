"""The differences between two studies, each with its interval, about the line of no difference."""

from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lithobrake.report.figures.style import INK, LANDER, QUIET, RULE


@dataclass(frozen=True)
class ShownDifference:
    """A difference as it is drawn: its name, value and bounds in the unit of the axis, and its figure in words."""

    name: str
    value: float
    lower: float | None
    upper: float | None
    words: str


def difference_figure(groups: Sequence[tuple[str, Sequence[ShownDifference]]]) -> Figure:
    """Draw groups of differences below each other, each under the label of its axis."""
    shown = [(label, rows) for label, rows in groups if rows]
    heights = [len(rows) + 1.2 for _, rows in shown]
    figure = Figure(figsize=(9.2, 0.34 * sum(heights) + 0.5))
    places = figure.subplots(len(shown), 1, squeeze=False, gridspec_kw={"height_ratios": heights, "hspace": 0.75})
    for axes, (label, rows) in zip(places[:, 0], shown, strict=True):
        _draw(axes, label, rows)
    figure.subplots_adjust(left=0.27, right=0.74, top=0.97, bottom=0.16 if sum(heights) < 8 else 0.1)
    return figure


def _draw(axes: Axes, label: str, rows: Sequence[ShownDifference]) -> None:
    axes.axvline(0.0, color=RULE, linewidth=1.0, zorder=0)
    for y, row in zip(range(len(rows) - 1, -1, -1), rows, strict=True):
        if row.lower is not None and row.upper is not None:
            axes.plot([row.lower, row.upper], [y, y], color=LANDER, linewidth=2.4, solid_capstyle="butt")
        axes.plot(row.value, y, "o", color=INK, markersize=4.5)
        axes.text(1.03, y, row.words, transform=axes.get_yaxis_transform(), va="center_baseline", fontsize=8)
    axes.set_yticks(range(len(rows) - 1, -1, -1), [row.name for row in rows])
    axes.set_ylim(-0.6, len(rows) - 0.4)
    reach = max(max(abs(end) for end in (row.value, row.lower or 0.0, row.upper or 0.0)) for row in rows) or 1.0
    axes.set_xlim(-1.08 * reach, 1.08 * reach)
    axes.set_xlabel(label)
    axes.xaxis.label.set_color(QUIET)
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=True, axis="x")
