"""Shares of outcomes as bars, and numbers of the landers at rest as distributions."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from textwrap import fill

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from lithobrake.report.figures.style import INK, QUIET, TRAINING
from lithobrake.results.journey_results import RestQuantiles
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import at_level, percent, with_interval
from lithobrake.vocabulary.outcomes import END_COLOURS, JourneyEnd

# Letters of a line below the axis: it is narrow, and stands at the edge of some figures; of one beside a bar.
LONGEST, LONGEST_NAME = 56, 26
# With a largest value of so many medians an axis is one of equal factors.
LONG_TAIL = 30.0
# More whole numbers than these are counted in classes.
MOST_BARS = 20
AT_REST = END_COLOURS[JourneyEnd.AT_REST]


@dataclass(frozen=True)
class ShareBar:
    """A bar of the figure: a share of the samples within [0, 1]; with an upper bound alone no run had it.

    colour: of its bar; digits: of its figure in per cent where it has no interval.
    """

    name: str
    share: Estimate
    colour: str = TRAINING
    digits: int = 0

    @property
    def words(self) -> str:
        """The share in per cent, with its interval or its limit."""
        if self.share.lower is None and self.share.upper is not None:
            return f"at most {percent(self.share.upper, 1)}"
        return with_interval(self.share, self.digits)


def folded(bars: list[ShareBar]) -> list[ShareBar]:
    """The bars with those that are empty and have one and the same figure as one, at the end."""
    empty: dict[str, list[ShareBar]] = {}
    for one in bars:
        if one.share.value == 0.0:
            empty.setdefault(one.words, []).append(one)
    several = [one for one in empty.values() if len(one) > 1]
    gone = {id(bar) for one in several for bar in one}
    lines = [fill(f"each of {', '.join(bar.name for bar in one)}", LONGEST_NAME) for one in several]
    return [
        *(bar for bar in bars if id(bar) not in gone),
        *(replace(one[0], name=line) for one, line in zip(several, lines, strict=True)),
    ]


def row_count(bars: list[ShareBar]) -> float:
    """How many rows of one line the bars take."""
    return float(_heights(bars).sum())


def _heights(bars: list[ShareBar]) -> Array:
    """The height of each bar's row, in rows of one line."""
    return np.array([1.0 + 0.75 * bar.name.count("\n") for bar in bars])


def draw_shares(axes: Axes, bars: list[ShareBar], whole: str) -> None:
    """One bar an outcome, the interval of a share that has one, and in the margin to the right its figure in per cent.

    whole: what they are shares of, "all samples".
    """
    heights = _heights(bars)
    place = heights.sum() - np.cumsum(heights) + 0.5 * heights - 0.5
    words = f"share of {whole} [%]"
    for y, bar in zip(place, bars, strict=True):
        share = bar.share
        axes.barh(y, 100 * share.value, color=bar.colour, height=0.68)
        if share.upper is not None:
            ends = [100 * (share.lower or 0.0), 100 * share.upper]
            # At the very ends of the axis a clipped line would look as if there were no interval.
            axes.plot(ends, [y, y], color=INK, linewidth=1.4, solid_capstyle="butt", clip_on=False)
        if share.lower is not None:
            words = f"share of {whole} [%], with {at_level(share.level)}"
        axes.text(1.025, y, bar.words, transform=axes.get_yaxis_transform(), va="center_baseline", fontsize=8)
    axes.set_yticks(place, [bar.name for bar in bars])
    axes.set_ylim(-0.5, heights.sum() - 0.5)
    axes.set_xlim(0, 100)
    axes.set_xticks(range(0, 101, 20))
    axes.set_xlabel(fill(words, LONGEST))
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)


@dataclass(frozen=True)
class RestSpread:
    """A number of the landers at rest: label, values [lander], and quantiles, which times factor are in their unit."""

    label: str
    values: Array
    quantiles: RestQuantiles
    factor: float = 1.0


def spreads_figure(spreads: Sequence[RestSpread]) -> Figure:
    """Draw the distribution functions side by side, with the median and the 95th percentile of each."""
    figure = Figure(figsize=(9.2, 3.1))
    for place, one in enumerate(spreads):
        axes = figure.add_axes((0.075 + 0.5 * place, 0.17, 0.4, 0.76))
        draw_spread(axes, one)
        axes.set_ylabel("share of those at rest [%]" if place == 0 else "")
    return figure


def draw_spread(axes: Axes, one: RestSpread) -> None:
    """One distribution function; bars: the intervals of its quantiles, to the edge of the axis where one has no end."""
    values = np.sort(one.values)
    median = float(np.median(values))
    is_long = median > 0.0 and values[-1] > LONG_TAIL * median and values[0] > 0.0
    axes.set_xscale("log" if is_long else "linear")
    axes.xaxis.set_major_formatter("{x:g}")
    low = values[0] if is_long else 0.0
    axes.step(np.append(low, values), 100.0 * np.arange(len(values) + 1) / len(values), where="post", color=AT_REST)
    quantiles = {50.0: one.quantiles.median, 95.0: one.quantiles.q95}
    ends = [end for found in quantiles.values() for end in (found.upper,) if end is not None]
    right = 1.06 * max([values[-1], *(end * one.factor for end in ends)])
    axes.set_xlim(low, right or 1.0)
    axes.set_ylim(0.0, 104.0)
    axes.set_yticks([0, 25, 50, 75, 95])
    for share, found in quantiles.items():
        if not found.is_known:
            continue
        axes.plot(found.value * one.factor, share, "o", color=INK, markersize=4.5, clip_on=False, zorder=4)
        if found.lower is not None or found.upper is not None:
            left = low if found.lower is None else found.lower * one.factor
            end = right if found.upper is None else found.upper * one.factor
            style = "-" if None not in (found.lower, found.upper) else ":"
            axes.plot([left, end], [share, share], style, color=INK, linewidth=1.4, solid_capstyle="butt", zorder=4)
    axes.grid(visible=True)
    axes.set_xlabel(one.label)


def counts_figure(counts: Mapping[str, Array], end: NDArray[np.str_], words: Mapping[str, str]) -> Figure:
    """Draw how many journeys have so many of something, by label of the axis, in parts by how they ended."""
    figure = Figure(figsize=(9.2, 2.9))
    for place, (label, values) in enumerate(counts.items()):
        axes = figure.add_axes((0.075 + 0.5 * place, 0.18, 0.4, 0.68))
        draw_counts(axes, values, end, words)
        axes.set_xlabel(label)
        axes.set_ylabel("journeys" if place == 0 else "")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper left", bbox_to_anchor=(0.065, 1.0), ncols=5, borderpad=0.0)
    return figure


def draw_counts(axes: Axes, values: Array, end: NDArray[np.str_], words: Mapping[str, str]) -> None:
    """Bars of how many journeys have a number, in parts by how they ended; words: of the ends."""
    most, least = int(values.max()), int(values.min())
    step = max(1, int(np.ceil((most - least + 1) / MOST_BARS)))
    edges = np.arange(least, most + step + 1, step) - 0.5
    base = np.zeros(len(edges) - 1)
    for name, label in words.items():
        chosen = values[end == name]
        if not len(chosen):
            continue
        height = np.histogram(chosen, edges)[0].astype(float)
        middle = edges[:-1] + 0.5 * step
        axes.bar(middle, height, 0.86 * step, bottom=base, color=END_COLOURS[name], label=label)
        base += height
    axes.set_xlim(least - 0.5 - 0.5 * step, most + 0.5 + 0.5 * step)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))
    axes.yaxis.set_major_locator(MaxNLocator(integer=True, nbins=5))


def attitude_figure(faces: list[ShareBar], whole: str, tilt: RestSpread) -> Figure:
    """Draw the share of each side that is down, and the distribution function of its tilt."""
    rows = 0.24 * len(faces)
    height = max(2.9, rows + 0.9)
    figure = Figure(figsize=(9.2, height))
    axes = figure.add_axes((0.1, 1.0 - (0.4 + rows) / height, 0.22, rows / height))
    draw_shares(axes, faces, whole)
    axes.set_xticks(range(0, 101, 25))
    figure.text(0.1, 1.0 - 0.22 / height, "side down, by the lander's own axes", fontsize=8, color=QUIET)
    right = figure.add_axes((0.575, 0.5 / height, 0.4, 1.0 - 0.75 / height))
    draw_spread(right, tilt)
    right.set_ylabel("share of those at rest [%]")
    return figure
