"""The ground and the place of rest before and after a first contact that was observed."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter

from lithobrake.files.atomic import atomic_path
from lithobrake.report.figures.style import INK, INTERACTIONS, LANDER, QUIET, TEST_ALL, figure_style
from lithobrake.statements.labels import input_label
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.number_words import percent, unit_of_time

BINS = 18
# Panels of the upper row at most: the kinds of ground, and inputs, those of which most is learnt first.
MOST_PANELS = 4
WORDS = "grey: before the contact; blue: after it"
# A range over which values vary by more than this factor is drawn by its logarithm.
WIDE = 8.0
# Share of the places that the map shows, so that single far ones do not shrink it.
SHOWN = 0.98


def write_nowcast_figure(
    content: Mapping[str, Any], before: Mapping[str, Array], after: Mapping[str, Array], ways: Any, picture: Path
) -> None:
    """Draw nowcast.json as a PNG file.

    before, after: latitude_deg, longitude_deg and time_s of the landers at rest, NaN of the others, [lander_count]
    each. ways: gives metres east and north of the aim point, [count, 2], of latitudes and longitudes.
    """
    with figure_style(), atomic_path(picture) as draft:
        figure = nowcast_figure(content, before, after, ways)
        figure.savefig(draft, format="png", dpi=150, metadata={"Software": None})


def nowcast_figure(
    content: Mapping[str, Any], before: Mapping[str, Array], after: Mapping[str, Array], ways: Any
) -> Figure:  # fmt: skip
    """The same as a figure: kinds of ground and inputs above, map, time and distance below."""
    figure = Figure(figsize=(9.2, 5.6))
    figure.subplots_adjust(left=0.07, right=0.985, top=0.9, bottom=0.1, hspace=0.55)
    grid = figure.add_gridspec(2, 1)
    first = 1 if content["ground"] else 0
    inputs = sorted(content["inputs"].items(), key=lambda item: float(item[1]["sd_ratio"]))[: MOST_PANELS - first]
    above = grid[0].subgridspec(1, max(1, first + len(inputs)), wspace=0.3)
    below = grid[1].subgridspec(1, 3, wspace=0.3)
    if content["ground"]:
        _kinds(figure.add_subplot(above[0]), content["ground"])
    for place, (name, one) in enumerate(inputs, start=first):
        axes = figure.add_subplot(above[place])
        _laws(axes, np.array(one["prior"]), np.array(one["points"]))
        axes.set_xlabel(input_label(name, one["unit"].removeprefix("-")), fontsize=8)
        axes.set_title(f"{percent(one['sd_ratio'])} of sd left", fontsize=8, color=QUIET)
    _map(figure.add_subplot(below[0]), before, after, ways)
    times = [one["time_s"][np.isfinite(one["time_s"])] for one in (before, after)]
    size, unit = unit_of_time(float(np.median(np.concatenate(times)))) if sum(map(len, times)) else (1.0, "s")
    for place, (name, factor, words) in enumerate((
        ("time_s", size, f"time to rest [{unit}]"), ("from_contact", 1.0, "from the first contact [m]"),
    ), start=1):  # fmt: skip
        axes = figure.add_subplot(below[place])
        _laws(axes, *(one[name][np.isfinite(one[name])] / factor for one in (before, after)))
        axes.set_xlabel(words, fontsize=8)
    figure.text(0.985, 0.985, WORDS, ha="right", va="top", color=QUIET, fontsize=8)
    return figure


def _kinds(axes: Axes, kinds: Mapping[str, Mapping[str, Any]]) -> None:
    """The probability of each kind of ground, with its interval after."""
    place = np.arange(len(kinds))
    lower, value, upper = (np.array([one["after"][k] for one in kinds.values()], dtype=float) for k in range(3))
    axes.bar(place - 0.2, [100.0 * one["before"] for one in kinds.values()], 0.4, color=INTERACTIONS)
    axes.bar(place + 0.2, 100.0 * value, 0.4, color=LANDER, alpha=0.8)
    reach = 100.0 * np.nan_to_num(np.abs(np.array([value - lower, upper - value])))
    axes.errorbar(place + 0.2, 100.0 * value, reach, fmt="none", ecolor=INK, elinewidth=1.0, capsize=2.5)
    axes.set_xticks(place, list(kinds), fontsize=8)
    axes.set_ylabel("probability [%]")
    axes.set_title("kind of ground", fontsize=9)


def _laws(axes: Axes, before: Array, after: Array) -> None:
    """Histograms of values before and after, on a scale that suits them."""
    both = np.concatenate([before, after])
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    if not len(both):
        axes.text(0.5, 0.5, "none known", transform=axes.transAxes, ha="center", color=QUIET)
        return
    if not len(after):
        axes.set_title("after the contact: not known", fontsize=8, color=QUIET)
    low, high = np.quantile(both, [0.5 - 0.5 * SHOWN, 0.5 + 0.5 * SHOWN]).tolist()
    is_wide = low > 0.0 and high > WIDE * low
    edges = (np.geomspace if is_wide else np.linspace)(low, max(high, low + 1e-12), BINS + 1)
    for values, look in ((before, {"color": INTERACTIONS}), (after, {"color": LANDER, "alpha": 0.7})):
        if len(values):
            counts = np.histogram(values, edges)[0] / len(values)
            axes.bar(edges[:-1], counts, np.diff(edges), align="edge", **look)
    if is_wide:
        axes.set_xscale("log")
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 3.0)))
        axes.xaxis.set_major_formatter("{x:g}")
        axes.xaxis.set_minor_formatter(NullFormatter())


def _map(axes: Axes, before: Mapping[str, Array], after: Mapping[str, Array], ways: Any) -> None:
    """Places of rest in metres east and north of the aim point."""
    found = []
    for one, colour in ((before, TEST_ALL), (after, LANDER)):
        rests = np.isfinite(one["latitude_deg"])
        places = ways(one["latitude_deg"][rests], one["longitude_deg"][rests])
        axes.plot(*places.T, ".", markersize=3.0, markeredgewidth=0.0, color=colour, alpha=0.6)
        found.append(places)
    axes.plot(0.0, 0.0, "+", color=INK, markersize=8)
    both = np.concatenate(found)
    if len(both):
        low, high = np.quantile(both, [0.5 - 0.5 * SHOWN, 0.5 + 0.5 * SHOWN], axis=0)
        axes.set_xlim(low[0], high[0])
        axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal", adjustable="box", anchor="W")
    axes.set_xlabel("east of the aim point [m]")
    axes.set_ylabel("north [m]")
    axes.set_title("place of rest; cross: aim point", fontsize=9)
