"""Where landers rest after bounce upon bounce: on the soil, and beside it on hard ground."""

import textwrap
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from lithobrake.report.figures.density import WHOLE, Window, close_window, draw_density, near
from lithobrake.report.figures.ellipse_line import draw_ellipses, fitting, follows_gaussian
from lithobrake.report.figures.map_figure import Share, draw_relief, draw_scale, draw_shares
from lithobrake.report.figures.site_mark import draw_legend, mark_site
from lithobrake.report.figures.style import QUIET

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RestMap:
    """One side of the figure: where landers rest [deg], shape [settled] both, the ellipses of the summary, and shares.

    absent: why there is nothing to show, in place of all else; whole: what the shares are shares of.
    """

    title: str
    latitude: Array
    longitude: Array
    ellipses: Mapping[str, Any] | None
    shares: list[Share]
    absent: str | None = None
    whole: str = "all landers"


def rest_figure(maps: list[RestMap], site: tuple[float, float], vertices: Array | None = None) -> Figure:
    """Draw the maps side by side, over one and the same part of the body, and what became of the landers below them.

    site: latitude and longitude [deg]; vertices: of the body [m], shape [vertex, 3], for the relief; absent: plain.
    """
    # In inches: the legend and the maps, a row for each bar, and the axis below the bars.
    rows, maps_height, row_height, below = max(len(one.shares) for one in maps), 2.8, 0.2, 0.5
    height = maps_height + row_height * rows + below
    figure = Figure(figsize=(9.2, height))
    together = [np.concatenate([getattr(one, name) for one in maps]) for name in ("latitude", "longitude")]
    window = close_window(together[0], together[1], site) or WHOLE
    for side, one in enumerate(maps):
        axes = figure.add_axes((0.06 + 0.5 * side, 1.0 - (maps_height - 0.55) / height, 0.345, 1.7 / height))
        axes.set_title(one.title)
        if one.absent is not None:
            axes.set_axis_off()
            axes.text(0.0, 0.9, textwrap.fill(one.absent, 58), transform=axes.transAxes, va="top", color=QUIET)
            continue
        _map(figure, axes, one, site, window, vertices)
        share = row_height * len(one.shares) / height
        bars = figure.add_axes((0.135 + 0.5 * side, 1.0 - maps_height / height - share, 0.18, share))
        draw_shares(bars, one.shares, one.whole)
    held = {entry["share"]: entry for one in maps for entry in fitting(one.ellipses, window)}
    is_gaussian = all(follows_gaussian(one.ellipses, len(one.latitude)) for one in maps)
    draw_legend(figure, list(held.values()), "landers at rest", (0.06, 1.0 - 0.25 / height), is_gaussian=is_gaussian)
    return figure


def _map(
    figure: Figure, axes: Axes, one: RestMap, site: tuple[float, float], window: Window, vertices: Array | None
) -> None:
    """One map with its density, ellipses and site."""
    if window is WHOLE and vertices is not None:
        draw_relief(axes, vertices)
    axes.set_xlim(window.longitude - window.half_longitude, window.longitude + window.half_longitude)
    axes.set_ylim(window.latitude - window.half, window.latitude + window.half)
    axes.set_aspect(window.half_longitude / window.half if window is not WHOLE else "equal")
    axes.set_xlabel("longitude, east [deg]")
    axes.set_ylabel("latitude [deg]")
    if window is WHOLE:
        axes.set_xticks(range(-180, 181, 90))
        axes.set_yticks(range(-90, 91, 45))
    else:
        axes.locator_params(nbins=5)
    middle = near(np.array([site[1]]), window.longitude)[0]
    mark_site(axes, float(middle), site[0])
    if not len(one.latitude):
        axes.text(0.5, 0.1, "no lander rests", transform=axes.transAxes, ha="center", color=QUIET)
        return
    drawn, words = draw_density(axes, one.latitude, one.longitude, window, 7.0)
    draw_ellipses(axes, one.ellipses, window)
    axes.apply_aspect()
    box = axes.get_position()
    draw_scale(figure, drawn, words.replace("impacts", "landers"), (box.x1 + 0.012, box.y0, 0.01, box.height))
