"""Delivery options as maps, differences between studies, and the way down to rare limit states."""

import math
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import AxesImage
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from lithobrake.report.figures.style import INK, INPUT_COLOURS, LANDER, QUIET, RULE, SITE
from lithobrake.results.questions import AimResult, AimResults, RareLimitState
from lithobrake.statements.labels import input_label
from lithobrake.vocabulary.constants import HOUR
from lithobrake.vocabulary.estimate import Estimate

# One for all maps; colours darker than this part of their scale have white figures.
COLOURS, DARK = "Blues", 0.55
_NONE = Estimate(math.nan, None, None)
# Maps in per cent share one scale, from nothing to all: colours differ as much as the shares do.
WHOLE = (0.0, 100.0)


@dataclass(frozen=True)
class AimRow:
    """A row of maps: words, ground, and the number of an aim with its bounds, in the unit that is drawn.

    scale: its ends, None for those of the numbers.
    """

    title: str
    ground: str
    scale: tuple[float, float] | None
    read: Callable[[AimResult], Estimate]


def _percentages(share: Estimate) -> Estimate:
    return share.on_scale(lambda one: 100 * one)


def _on_hard_ground(aim: AimResult) -> Estimate:
    return _NONE if aim.hard is None else _percentages(aim.hard.settled)


def _within(found: Estimate | None, unit: float) -> Estimate:
    return _NONE if found is None else found.on_scale(lambda one: one / unit)


ROWS = (
    AimRow("at rest on soil [%]", "soil", WHOLE, lambda aim: _percentages(aim.soil.settled)),
    AimRow("unknown outcome on soil [%]", "soil", WHOLE, lambda aim: Estimate(100 * aim.soil.missing, None, None)),
    AimRow("95 % rest within [m]", "soil", None, lambda aim: _within(aim.soil.distance_p95, 1.0)),
    AimRow("95 % rest within [h]", "soil", None, lambda aim: _within(aim.soil.time_p95, HOUR)),
    AimRow("at rest on hard ground [%]", "hard", WHOLE, _on_hard_ground),
)


def _state_row(name: str) -> AimRow:
    """The probability of a limit state on soil."""
    return AimRow(f"{name} on soil [%]", "soil", WHOLE, lambda aim: _percentages(aim.soil.limit_states[name]))


def aim_figure(table: AimResults) -> Figure:
    """Draw results.aim: a row of maps for each number, a map for each value of the third name.

    What limits rule out is crossed; a frame marks the best on each ground, a dotted one what cannot be told from it.
    """
    values = np.array([aim.values for aim in table.aims])
    labels = [input_label(name, unit) for name, unit in zip(table.names, table.units, strict=True)]
    # What is not chosen is the same everywhere.
    places = np.column_stack([values, np.zeros((len(values), 3 - values.shape[1]))])
    across, up, panels = (np.unique(column) for column in places.T)
    room = (_Layout.least - _Layout.left - _Layout.right) / len(panels) - 0.2
    # Journeys are followed on the soil alone.
    rows = [row for row in ROWS if row.ground == "soil" or table.aims[0].hard is not None]
    rows[1:1] = [_state_row(name) for name in table.aims[0].soil.limit_states]
    layout = _Layout(max(room, 0.62 * len(across)), max(0.36 * len(up), 0.5), len(panels), len(rows))
    figure = Figure(figsize=layout.size)
    for number, row in enumerate(rows):
        read = [row.read(aim) for aim in table.aims]
        scale = row.scale or _ends(np.array([one.value for one in read]))
        for column, panel in enumerate(panels.tolist()):
            axes = figure.add_axes(layout.place(number, column))
            shown = np.flatnonzero(places[:, 2] == panel)
            cells = _Cells(places[shown, 0], places[shown, 1], across, up)
            drawn = _draw(axes, cells, [read[one] for one in shown], scale)
            _mark(axes, cells, table, shown, row.ground)
            third = ""
            if len(labels) > 2 and number == 0:
                third = f"{labels[2].partition(' [')[0]} = {table.value_words(table.names[2], panel)}"
            axes.set_title("\n".join(filter(None, [third, row.title if column == 0 else ""])))
            _label(axes, cells, table, labels, is_last=number == len(rows) - 1, is_first=column == 0)
        bar = figure.colorbar(drawn, cax=figure.add_axes(layout.bar(number)))
        bar.ax.tick_params(labelsize=7.5)
        outline: Any = bar.outline
        outline.set_visible(False)
    return figure


def _ends(known: NDArray[np.float64]) -> tuple[float, float]:
    """The ends of a scale from nothing to the largest of some numbers."""
    return 0.0, float(np.nanmax(known)) if np.isfinite(known).any() else 1.0


@dataclass(frozen=True)
class _Layout:
    """Where the maps stand, in inches: width and height of one, how many stand beside and above each other.

    The figure is as wide as every other, so that its letters are as large on the page.
    """

    width: float
    height: float
    count: int
    rows: int
    left: ClassVar[float] = 0.85
    right: ClassVar[float] = 0.7
    top: ClassVar[float] = 0.5
    gap: ClassVar[float] = 0.42
    least: ClassVar[float] = 9.2

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the figure."""
        across = max(self.left + self.count * (self.width + 0.2) + self.right, self.least)
        return across, self.top + self.rows * (self.height + self.gap) + 0.2

    def place(self, row: int, column: int) -> tuple[float, float, float, float]:
        """Left, bottom, width and height of a map, in parts of the figure."""
        whole, high = self.size
        bottom = high - self.top - (row + 1) * self.height - row * self.gap
        left = self.left + column * (self.width + 0.2)
        return left / whole, bottom / high, self.width / whole, self.height / high

    def bar(self, row: int) -> tuple[float, float, float, float]:
        """The place of the colour bar of a row, to the right of its maps."""
        _, bottom, _, height = self.place(row, 0)
        whole, _ = self.size
        right = self.left + self.count * (self.width + 0.2)
        return right / whole, bottom, 0.12 / whole, height


@dataclass(frozen=True)
class _Cells:
    """The cells of a map: values of each along both axes [cell_count], and the values that there are."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    across: NDArray[np.float64]
    up: NDArray[np.float64]

    @property
    def places(self) -> list[tuple[int, int]]:
        """Column and row of each cell."""
        found = zip(np.searchsorted(self.across, self.x), np.searchsorted(self.up, self.y), strict=True)
        return [(int(column), int(row)) for column, row in found]


def _draw(axes: Axes, cells: _Cells, read: Sequence[Estimate], scale: tuple[float, float]) -> AxesImage:
    """Colour the cells by their number, and write it there with its bounds."""
    table = np.full((len(cells.up), len(cells.across)), np.nan)
    for (column, row), one in zip(cells.places, read, strict=True):
        table[row, column] = one.value
    span = scale[1] - scale[0] or 1.0
    drawn = axes.imshow(table, origin="lower", aspect="auto", cmap=COLOURS, vmin=scale[0], vmax=scale[0] + span)
    for (column, row), one in zip(cells.places, read, strict=True):
        value, low, high = one.value, one.lower, one.upper
        ink = "white" if (value - scale[0]) / span > DARK else "black"
        text = "none" if np.isnan(value) else f"{value:.0f}" if scale == WHOLE else f"{value:.3g}"
        axes.text(column, row + 0.16, text, ha="center", va="center", fontsize=9, color=ink)
        bounds = " to ".join("?" if end is None else f"{end:.2g}" if end < 1 else f"{end:.0f}" for end in (low, high))
        if (low, high) != (None, None):
            axes.text(column, row - 0.24, bounds, ha="center", va="center", fontsize=7, color=ink)
    return drawn


def _mark(axes: Axes, cells: _Cells, table: AimResults, shown: NDArray[np.int64], ground: str) -> None:
    """Cross out what limits rule out, and frame the best and what cannot be told from it."""
    best = table.best_on_soil if ground == "soil" else table.best_on_hard
    for (column, row), aim in zip(cells.places, shown.tolist(), strict=True):
        part = table.aims[aim].soil if ground == "soil" else table.aims[aim].hard
        if part is None or not part.allowed:
            axes.plot([column - 0.5, column + 0.5], [row - 0.5, row + 0.5], color=QUIET, linewidth=0.8)
        if best is not None and best.aim == aim:
            # Inside of the cell, where no neighbour covers it.
            frame = Rectangle((column - 0.47, row - 0.45), 0.94, 0.9, fill=False, edgecolor=SITE, linewidth=1.8)
            axes.add_patch(frame)
        elif best is not None and aim in (best.not_worse or ()):
            frame = Rectangle((column - 0.47, row - 0.45), 0.94, 0.9, fill=False, edgecolor=SITE, linestyle=":")
            axes.add_patch(frame)


def _label(
    axes: Axes, cells: _Cells, table: AimResults, labels: Sequence[str], *, is_last: bool, is_first: bool
) -> None:
    """Write the values along the axes, and their names where a row or column of maps ends."""
    for side in axes.spines.values():
        side.set_visible(False)
    axes.tick_params(length=0)
    is_shown = is_first and len(labels) > 1
    for axis, values, name, has_words in (
        (axes.xaxis, cells.across, table.names[0], is_last),
        (axes.yaxis, cells.up, table.names[min(1, len(labels) - 1)], is_shown),
    ):
        axis.set_ticks(range(len(values)), [table.value_words(name, one) for one in values] if has_words else [])
    if is_last:
        axes.set_xlabel(labels[0])
    if is_shown:
        axes.set_ylabel(labels[1])


@dataclass(frozen=True)
class DifferenceRow:
    """A row of the figure: its name, the difference in the unit of the axis, and its figure in words."""

    name: str
    difference: Estimate
    words: str


def difference_figure(groups: Sequence[tuple[str, Sequence[DifferenceRow]]]) -> Figure:
    """Draw groups of differences below each other, each under the label of its axis."""
    shown = [(label, rows) for label, rows in groups if rows]
    heights = [len(rows) + 1.2 for _, rows in shown]
    figure = Figure(figsize=(9.2, 0.34 * sum(heights) + 0.5))
    places = figure.subplots(len(shown), 1, squeeze=False, gridspec_kw={"height_ratios": heights, "hspace": 0.75})
    for axes, (label, rows) in zip(places[:, 0], shown, strict=True):
        _draw_difference(axes, label, rows)
    figure.subplots_adjust(left=0.27, right=0.74, top=0.97, bottom=0.16 if sum(heights) < 8 else 0.1)
    return figure


def _draw_difference(axes: Axes, label: str, rows: Sequence[DifferenceRow]) -> None:
    axes.axvline(0.0, color=RULE, linewidth=1.0, zorder=0)
    for y, row in zip(range(len(rows) - 1, -1, -1), rows, strict=True):
        if row.difference.bounds is not None:
            axes.plot(row.difference.bounds, [y, y], color=LANDER, linewidth=2.4, solid_capstyle="butt")
        axes.plot(row.difference.value, y, "o", color=INK, markersize=4.5)
        axes.text(1.03, y, row.words, transform=axes.get_yaxis_transform(), va="center_baseline", fontsize=8)
    axes.set_yticks(range(len(rows) - 1, -1, -1), [textwrap.fill(row.name, 34) for row in rows])
    axes.set_ylim(-0.6, len(rows) - 0.4)
    found = [row.difference for row in rows]
    reach = max(abs(end or 0.0) for one in found for end in (one.value, one.lower, one.upper)) or 1.0
    axes.set_xlim(-1.08 * reach, 1.08 * reach)
    axes.set_xlabel(label)
    axes.xaxis.label.set_color(QUIET)
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=True, axis="x")


def rare_figure(rare: Mapping[str, RareLimitState]) -> Figure:
    """Draw the probability that is left against the distance from the limit, a line a limit state, falling to 0."""
    figure = Figure(figsize=(9.2, 3.9))
    axes = figure.subplots()
    figure.subplots_adjust(left=0.08, right=0.985, top=0.97, bottom=0.14)
    for (name, found), colour in zip(rare.items(), _colours(len(rare)), strict=True):
        left = np.cumprod(found.shares)
        axes.plot(found.thresholds, left, "-o", color=colour, linewidth=1.4, markersize=5.0, label=name)
        bounds = found.probability.bounds
        if found.reached and bounds is not None:
            bars = [[left[-1] - bounds[0]], [bounds[1] - left[-1]]]
            axes.errorbar(0.0, left[-1], bars, color=colour, capsize=4.0, linewidth=1.4)
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
