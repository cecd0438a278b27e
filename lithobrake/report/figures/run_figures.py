"""All landings of a study, and where the scatter of each output comes from."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from lithobrake.report.figures.style import INK, INTERACTIONS, QUIET, SITE, TRAINING, input_colours
from lithobrake.results.run_results import VarianceParts
from lithobrake.statements.labels import input_label, long_part_words, output, part_words
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.number_words import QUANTILE_WORDS, intervals, part
from lithobrake.vocabulary.outcomes import TouchdownOutcome

# In inches: a bed's row, and what stands above and below the rows.
BED_HEIGHT, MARGINS = 0.115, 1.07
DOT: dict[str, Any] = {"s": 13.0, "color": TRAINING, "alpha": 0.75, "linewidths": 0, "zorder": 3}
RING: dict[str, Any] = {"s": 34.0, "facecolors": "none", "edgecolors": SITE, "linewidths": 1.1, "zorder": 4}
# The parts beside the soil, in the order of the bar: colour, hatching. No soil input has any of these.
LOOKS = {
    "arrival": (QUIET, ""),
    "attitude": ("#e8d5e2", "\\\\\\\\"),
    "bed": ("#f1e6d0", "////"),
    "place": (INTERACTIONS, ""),
    "chaos": (INK, ""),
}
# From here on a piece has room for its figure.
ROOM = 0.055
ROW_HEIGHT = 0.92


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
        label = QUANTILE_WORDS.get(level, level)
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
        label = QUANTILE_WORDS.get(level, level)
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


@dataclass(frozen=True)
class Piece:
    """A piece of a bar: name of the part, its share of the whole, and its look."""

    name: str
    share: float
    colour: str
    hatch: str = ""


def pieces(record: VarianceParts, colours: Mapping[str, str]) -> list[Piece]:
    """The pieces of one bar: of the soil each input alone, and what they do together.

    What inputs do alone is estimated with scatter, and drawn smaller where together it is more than the soil does.
    """
    alone = {name: max(one.value, 0.0) for name, one in record.soil_by_input.items()}
    soil, total = record.soil.value, sum(alone.values())
    scale = min(1.0, soil / total) if total > 0.0 else 0.0
    found = [Piece(name, scale * share, colours[name]) for name, share in alone.items()]
    found.append(Piece("interactions", soil - scale * total, "white", "...."))
    return found + [Piece(name, one.value, *LOOKS[name]) for name, one in record.parts.items() if name in LOOKS]


def variance_figure(shares: Mapping[str, VarianceParts | None], words: Mapping[str, str], level: float) -> Figure:
    """Draw a bar for each output, and beside it each part with its interval.

    shares: by output, None where the runs cannot tell; words: title of the row of an output; level: of the intervals.
    """
    records = [record for record in shares.values() if record]
    handles = part_handles(records)
    # In inches from below: the legend, the axis, a row for each output, the title.
    legend, rows = 0.1 + 0.175 * -(-len(handles) // 4), ROW_HEIGHT * len(shares)
    height = legend + 0.55 + rows + 0.3
    figure = Figure(figsize=(9.2, height))
    bottom, share = (legend + 0.55) / height, rows / height
    bars = figure.add_axes((0.13, bottom, 0.38, share))
    whiskers = figure.add_axes((0.655, bottom, 0.2, share))
    draw_parts(bars, shares, words)
    for row, record in enumerate(shares.values()):
        if record is not None:
            _intervals(whiskers, row, record)
    _dress(whiskers, f"parts and {intervals(level)}", len(shares))
    figure.legend(handles=handles, loc="lower center", ncols=4, handlelength=1.2, handleheight=1.0, columnspacing=1.4)
    return figure


def draw_parts(axes: Axes, shares: Mapping[str, VarianceParts | None], words: Mapping[str, str]) -> None:
    """Draw a bar for each output, stacked of the parts of its variance; see variance_figure."""
    colours = input_colours(_soil_inputs([record for record in shares.values() if record]))
    for row, record in enumerate(shares.values()):
        if record is None:
            axes.text(0.02, row, "not separable from these runs", va="center", color=QUIET)
        else:
            _bar(axes, row, pieces(record, colours))
    axes.set_yticks(range(len(shares)), [words.get(name) or _row(name) for name in shares])
    _dress(axes, "parts of the variance", len(shares))


def _soil_inputs(records: Sequence[VarianceParts]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(name for record in records for name in record.soil_by_input))


def _row(name: str) -> str:
    shown = output(name)
    return f"{shown.words}\n{shown.symbol}".strip()


def part_handles(records: Sequence[VarianceParts]) -> list[Patch]:
    """The legend: soil inputs, then the parts that some output has."""
    names = _soil_inputs(records)
    colours = input_colours(names)
    handles = [Patch(facecolor=colours[name], label=input_label(name)) for name in names]
    if names:
        handles.append(Patch(facecolor="white", edgecolor=QUIET, hatch="....", label="soil inputs together"))
    for name, (colour, hatch) in LOOKS.items():
        known = [record for record in records if name in record.parts]
        if known:
            label = long_part_words(known[0], name)
            handles.append(Patch(facecolor=colour, edgecolor=QUIET if hatch else colour, hatch=hatch, label=label))
    return handles


def _bar(axes: Axes, row: int, parts: Sequence[Piece]) -> None:
    """Stack the pieces."""
    end = 0.0
    for piece in parts:
        edge = QUIET if piece.hatch else "white"
        axes.barh(
            row,
            piece.share,
            left=end,
            height=0.52,
            color=piece.colour,
            hatch=piece.hatch,
            edgecolor=edge,
            linewidth=0.6,
        )
        if piece.share >= ROOM:
            light = sum(
                value * weight
                for value, weight in zip(matplotlib.colors.to_rgb(piece.colour), (0.3, 0.59, 0.11), strict=True)
            )
            axes.text(
                end + 0.5 * piece.share,
                row,
                f"{100 * piece.share:.0f}",
                ha="center",
                va="center_baseline",
                fontsize=8,
                color="white" if light < 0.62 else INK,
                bbox={"facecolor": piece.colour, "edgecolor": "none", "pad": 0.8} if piece.hatch else None,
            )
        end += piece.share


def _intervals(axes: Axes, row: int, record: VarianceParts) -> None:
    """One line a part: its share with its interval, and both as numbers in the margin."""
    parts = record.parts
    step = 0.84 / max(len(parts), 5)
    start = row - 0.5 * step * (len(parts) - 1)
    for index, (name, share) in enumerate(parts.items()):
        y = start + step * index
        axes.plot(share.bounds or (), [y, y], color=QUIET, linewidth=1.3, solid_capstyle="butt", clip_on=False)
        axes.plot(share.value, y, "o", color=INK, markersize=3.6, clip_on=False)
        side = axes.get_yaxis_transform()
        axes.text(-0.04, y, part_words(record, name), transform=side, ha="right", va="center_baseline", fontsize=7.5)
        axes.text(1.05, y, part(share), transform=side, va="center_baseline", fontsize=7.5)


def _dress(axes: Axes, title: str, row_count: int) -> None:
    axes.set_title(title)
    axes.set_ylim(row_count - 0.5, -0.5)
    low, high = axes.get_xlim()
    axes.set_xlim(min(low, -0.02), max(high, 1.02))
    axes.axvline(0.0, color=QUIET, linewidth=0.8)
    axes.axvline(1.0, color=QUIET, linewidth=0.8, linestyle=":")
    axes.set_xticks([0.0, 0.25, 0.5, 0.75, 1.0], ["0", "25", "50", "75", "100"])
    axes.set_xlabel("share of the variance [%]")
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
    if axes.get_title(loc="left").startswith("parts and"):
        axes.set_yticks([])
