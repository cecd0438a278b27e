"""Figure 4 of a sequence: where the scatter of each output comes from, as bars that add up to the whole."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from lithobrake.report.style import INK, INTERACTIONS, QUIET, input_colours, input_label, output

Share = Mapping[str, float]
Record = Mapping[str, Any]

# The parts beside the soil, in the order of the bar: words, colour, hatching. No soil input has any of these.
PARTS = {
    "arrival": ("arrival", QUIET, ""),
    "bed": ("bed", "#f1e6d0", "////"),
    "place_and_attitude": ("place and attitude", INTERACTIONS, ""),
    "chaos": ("chaos", INK, ""),
}
SOIL = "soil"
WITHOUT_TWINS = "place, attitude, chaos"
# From here on a piece has room for its figure.
ROOM = 0.055
ROW_HEIGHT = 0.92


@dataclass(frozen=True)
class Piece:
    """A piece of a bar: name of the part, its share of the whole (below 0 where scatter outweighs it), and its look."""

    name: str
    share: float
    colour: str
    hatch: str = ""


def part_words(record: Record, part: str) -> str:
    """A part in words; without twins chaos is within place and attitude."""
    if part == SOIL:
        return SOIL
    if part == "place_and_attitude" and record.get("chaos") is None:
        return WITHOUT_TWINS
    return PARTS[part][0]


def known_parts(record: Record) -> dict[str, Share]:
    """The parts that a record has, in the order of the bar."""
    return {part: record[part] for part in (SOIL, *PARTS) if record.get(part) is not None}


def pieces(record: Record, colours: Mapping[str, str]) -> list[Piece]:
    """The pieces of one bar, which add up to the whole; what no soil input does alone is left to their interactions."""
    alone = {name: part["share"] for name, part in record["soil_by_input"].items()}
    found = [Piece(name, share, colours[name]) for name, share in alone.items()]
    if record.get(SOIL) is not None:
        found.append(Piece("interactions", record[SOIL]["share"] - sum(alone.values()), "white", "...."))
    return found + [
        Piece(part, record[part]["share"], *PARTS[part][1:]) for part in PARTS if record.get(part) is not None
    ]


def variance_figure(shares: Mapping[str, Record | None], words: Mapping[str, str]) -> Figure:
    """Draw a bar for each output that adds up to 1, and beside it each part with its interval.

    shares: by output, None where the runs cannot tell; words: title of the row of an output.
    """
    records = [record for record in shares.values() if record]
    names = tuple(dict.fromkeys(name for record in records for name in record["soil_by_input"]))
    colours, handles = input_colours(names), _handles(names, records)
    # In inches from below: the legend, the axis, a row for each output, the title.
    legend, rows = 0.1 + 0.175 * -(-len(handles) // 4), ROW_HEIGHT * len(shares)
    height = legend + 0.55 + rows + 0.3
    figure = Figure(figsize=(9.2, height))
    bottom, share = (legend + 0.55) / height, rows / height
    bars = figure.add_axes((0.13, bottom, 0.38, share))
    whiskers = figure.add_axes((0.655, bottom, 0.2, share))
    for row, record in enumerate(shares.values()):
        if record is None:
            bars.text(0.02, row, "these runs cannot tell", va="center", color=QUIET)
            continue
        _bar(bars, row, pieces(record, colours))
        _intervals(whiskers, row, record)
    bars.set_yticks(range(len(shares)), [words.get(name) or _row(name) for name in shares])
    for axes, title in ((bars, "parts of the variance"), (whiskers, "parts and 90 % intervals")):
        _dress(axes, title, len(shares))
    figure.legend(handles=handles, loc="lower center", ncols=4, handlelength=1.2, handleheight=1.0, columnspacing=1.4)
    return figure


def _row(name: str) -> str:
    shown = output(name)
    return f"{shown.words}\n{shown.symbol}".strip()


def _handles(names: Sequence[str], records: Sequence[Record]) -> list[Patch]:
    """The legend: soil inputs, then the parts that some output has."""
    colours = input_colours(tuple(names))
    handles = [Patch(facecolor=colours[name], label=input_label(name)) for name in names]
    if names:
        handles.append(Patch(facecolor="white", edgecolor=QUIET, hatch="....", label="soil inputs together"))
    for part, (_, colour, hatch) in PARTS.items():
        known = [record for record in records if record.get(part) is not None]
        if known:
            label = part_words(known[0], part)
            handles.append(Patch(facecolor=colour, edgecolor=QUIET if hatch else colour, hatch=hatch, label=label))
    return handles


def _bar(axes: Axes, row: int, parts: Sequence[Piece]) -> None:
    """Stack what is above 0 to the right of it, and what is below to the left: together they are the whole."""
    ends = [0.0, 0.0]
    for part in parts:
        side = int(part.share < 0.0)
        edge = QUIET if part.hatch else "white"
        axes.barh(
            row,
            part.share,
            left=ends[side],
            height=0.52,
            color=part.colour,
            hatch=part.hatch,
            edgecolor=edge,
            linewidth=0.6,
        )
        if part.share >= ROOM:
            light = sum(
                value * weight
                for value, weight in zip(matplotlib.colors.to_rgb(part.colour), (0.3, 0.59, 0.11), strict=True)
            )
            axes.text(
                ends[side] + 0.5 * part.share,
                row,
                f"{100 * part.share:.0f}",
                ha="center",
                va="center_baseline",
                fontsize=8,
                color="white" if light < 0.62 else INK,
                bbox={"facecolor": part.colour, "edgecolor": "none", "pad": 0.8} if part.hatch else None,
            )
        ends[side] += part.share


def _intervals(axes: Axes, row: int, record: Record) -> None:
    """One line a part: its share with its interval, and both as numbers in the margin."""
    parts = known_parts(record)
    step = 0.84 / max(len(parts), 5)
    start = row - 0.5 * step * (len(parts) - 1)
    for index, (part, share) in enumerate(parts.items()):
        y = start + step * index
        axes.plot(
            [share["lower"], share["upper"]], [y, y], color=QUIET, linewidth=1.3, solid_capstyle="butt", clip_on=False
        )
        axes.plot(share["share"], y, "o", color=INK, markersize=3.6, clip_on=False)
        side = axes.get_yaxis_transform()
        axes.text(-0.04, y, part_words(record, part), transform=side, ha="right", va="center_baseline", fontsize=7.5)
        numbers = f"{100 * share['share']:.1f} % ({100 * share['lower']:.0f} to {100 * share['upper']:.0f})"
        axes.text(1.05, y, numbers, transform=side, va="center_baseline", fontsize=7.5)


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
