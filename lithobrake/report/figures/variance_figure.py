"""Where the scatter of each output comes from, as bars that add up to the whole."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from lithobrake.report.figures.style import INK, INTERACTIONS, QUIET, input_colours
from lithobrake.report.words.labels import input_label, long_part_words, output, part_words
from lithobrake.results.run_results import VarianceParts
from lithobrake.vocabulary.percentages import percent

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
    alone = {name: max(one.share, 0.0) for name, one in record.soil_by_input.items()}
    soil, total = record.soil.share, sum(alone.values())
    scale = min(1.0, soil / total) if total > 0.0 else 0.0
    found = [Piece(name, scale * share, colours[name]) for name, share in alone.items()]
    found.append(Piece("interactions", soil - scale * total, "white", "...."))
    return found + [Piece(name, one.share, *LOOKS[name]) for name, one in record.parts.items() if name in LOOKS]


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
    _dress(whiskers, f"parts and {percent(level)} intervals", len(shares))
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
    for part, (colour, hatch) in LOOKS.items():
        known = [record for record in records if part in record.parts]
        if known:
            label = long_part_words(known[0], part)
            handles.append(Patch(facecolor=colour, edgecolor=QUIET if hatch else colour, hatch=hatch, label=label))
    return handles


def _bar(axes: Axes, row: int, parts: Sequence[Piece]) -> None:
    """Stack the pieces."""
    end = 0.0
    for part in parts:
        edge = QUIET if part.hatch else "white"
        axes.barh(
            row, part.share, left=end, height=0.52, color=part.colour, hatch=part.hatch, edgecolor=edge, linewidth=0.6
        )
        if part.share >= ROOM:
            light = sum(
                value * weight
                for value, weight in zip(matplotlib.colors.to_rgb(part.colour), (0.3, 0.59, 0.11), strict=True)
            )
            axes.text(
                end + 0.5 * part.share,
                row,
                f"{100 * part.share:.0f}",
                ha="center",
                va="center_baseline",
                fontsize=8,
                color="white" if light < 0.62 else INK,
                bbox={"facecolor": part.colour, "edgecolor": "none", "pad": 0.8} if part.hatch else None,
            )
        end += part.share


def _intervals(axes: Axes, row: int, record: VarianceParts) -> None:
    """One line a part: its share with its interval, and both as numbers in the margin."""
    parts = record.parts
    step = 0.84 / max(len(parts), 5)
    start = row - 0.5 * step * (len(parts) - 1)
    for index, (part, share) in enumerate(parts.items()):
        y = start + step * index
        axes.plot([share.lower, share.upper], [y, y], color=QUIET, linewidth=1.3, solid_capstyle="butt", clip_on=False)
        axes.plot(share.share, y, "o", color=INK, markersize=3.6, clip_on=False)
        side = axes.get_yaxis_transform()
        axes.text(-0.04, y, part_words(record, part), transform=side, ha="right", va="center_baseline", fontsize=7.5)
        axes.text(1.05, y, share.words(), transform=side, va="center_baseline", fontsize=7.5)


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
