"""Where journeys end: the landers on the ground, the smallest regions that hold them, and the share of each end."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from numpy.typing import NDArray

from lithobrake.report.figures.close_view import draw_bar, frame_view, view_around, whole_body
from lithobrake.report.figures.density import WHOLE, Window, near
from lithobrake.report.figures.map_figure import Share, draw_relief, draw_shares
from lithobrake.report.figures.map_marks import (
    SITE_STYLE,
    draw_ellipses,
    ellipse_style,
    fitting,
    mark_site,
    outline,
)
from lithobrake.report.figures.style import DELIVERY, SITE
from lithobrake.results.dispersion import EllipseShare, LandingEllipses
from lithobrake.results.journey_results import RestRegion
from lithobrake.vocabulary.percentages import percent

Array = NDArray[np.float64]
# Beyond this a region is dashed.
LARGE_SHARE = 0.9


@dataclass(frozen=True)
class EndPlaces:
    """Landers that ended on the ground in one way: words of the end, its colour, latitude and longitude [deg]."""

    words: str
    colour: str
    latitude: Array
    longitude: Array


def journey_map(
    places: Sequence[EndPlaces],
    regions: Sequence[RestRegion],
    aim: tuple[float, float],
    radius: float,
    shares: list[Share],
    whole: str,
    vertices: Array,
    delivery: LandingEllipses | None = None,
) -> Figure:
    """Draw the places of the landers over a close view, on the whole body beside it, and the share of each end.

    aim: latitude and longitude [deg]; radius: of the body there [m]; whole: what the shares are shares of; vertices: of
    the body [m], shape [vertex, 3]; delivery: ellipses of the first impacts.
    """
    # In inches from below: the axis of the bars, a row for each bar, the axis of the map, the map.
    window = map_window(places, regions, aim, delivery)
    bars, map_height, gap = 0.2 * len(shares), 4.4, 0.75 if window else 1.35
    height = 0.5 + bars + gap + map_height + 0.1
    figure = Figure(figsize=(9.2, height))
    bottom = (0.5 + bars + gap) / height
    if window is None:
        axes = figure.add_axes((0.07, bottom, 0.9, map_height / height))
        draw_relief(axes, vertices)
    else:
        axes = figure.add_axes((0.07, bottom, map_height / 9.2, map_height / height))
        side = figure.add_axes((0.625, bottom + 1.9 / height, 0.355, 1.65 / height))
        whole_body(side, window, vertices)
    draw_places(axes, places, regions, aim, window or WHOLE)
    draw_ellipses(axes, delivery, window or WHOLE, DELIVERY)
    if window is not None:
        draw_bar(axes, window, radius)
    corner = (0.625, bottom) if window else (0.07, bottom - 1.0 / height)
    _draw_legend(figure, places, regions, corner, fitting(delivery, window or WHOLE))
    draw_shares(figure.add_axes((0.2, 0.5 / height, 0.52, bars / height)), shares, whole)
    return figure


def map_window(
    places: Sequence[EndPlaces],
    regions: Sequence[RestRegion],
    aim: tuple[float, float],
    delivery: LandingEllipses | None,
) -> Window | None:
    """The part of the map that holds the landers, their regions, the delivery and the aim point, square on the ground.

    None where they lie too far apart or too near a pole for one.
    """
    landers = [np.column_stack([one.latitude, one.longitude]) for one in places]
    outlines = [np.array(line) for one in regions for line in one.outlines]
    if delivery is not None:
        middle = (delivery.latitude_deg, delivery.longitude_deg, delivery.heading_deg)
        outlines += [np.column_stack(outline(*middle, one.semi_axes_deg)) for one in delivery.shares]
    latitude, longitude = np.concatenate([np.empty((0, 2)), *landers, *outlines]).T
    return view_around(latitude, longitude, aim)


def draw_places(
    axes: Axes, places: Sequence[EndPlaces], regions: Sequence[RestRegion], aim: tuple[float, float], window: Window
) -> None:
    """Landers as dots over their regions, and the aim point."""
    for region in reversed(regions):
        _draw_region(axes, region, window)
    for one in places:
        x = near(one.longitude, window.longitude)
        axes.scatter(x, one.latitude, s=20, color=one.colour, linewidths=0.6, edgecolors="white", zorder=5)
    mark_site(axes, float(near(np.array([aim[1]]), window.longitude)[0]), aim[0])
    frame_view(axes, window)


def _draw_region(axes: Axes, region: RestRegion, window: Window) -> None:
    """A region with its edge; on the whole map, where one may go round the back, the edge alone."""
    pieces, is_whole = [], window is not WHOLE
    for line in region.outlines:
        outline = np.array(line)
        x = near(outline[:, 1], window.longitude)
        jumps = np.abs(np.diff(x)) > 180.0
        is_whole = is_whole and not jumps.any()
        x[1:][jumps] = np.nan
        axes.plot(x, outline[:, 0], region_style(region), color=SITE, linewidth=1.3, zorder=4)
        pieces.append(Path(np.column_stack([x, outline[:, 0]]), closed=False))
    if is_whole and pieces:
        filled = PathPatch(Path.make_compound_path(*pieces), facecolor=SITE, alpha=0.1, linewidth=0.0, zorder=3)
        axes.add_patch(filled)


def region_style(region: RestRegion) -> Literal["-", "--"]:
    """Style of the edge of a region."""
    return "-" if region.share < LARGE_SHARE else "--"


def _draw_legend(
    figure: Figure,
    places: Sequence[EndPlaces],
    regions: Sequence[RestRegion],
    corner: tuple[float, float],
    delivery: Sequence[EllipseShare],
) -> None:
    """Say what dots, lines and mark are."""
    columns = 1 if corner[0] > 0.5 else 3
    figure.legend(
        handles=map_handles(places, regions, delivery), loc="lower left", bbox_to_anchor=corner, ncols=columns,
        borderpad=0.0, labelspacing=0.7,
    )  # fmt: skip


def map_handles(
    places: Sequence[EndPlaces], regions: Sequence[RestRegion], delivery: Sequence[EllipseShare]
) -> list[Line2D]:
    """The legend: landers, regions, ellipses of the delivery that are drawn, and the aim point."""
    handles = [
        Line2D([], [], linestyle="none", marker="o", markersize=5, color=one.colour, label=f"{one.words} ({count})")
        for one in places
        for count in [len(one.latitude)]
        if count
    ]
    for region in regions:
        words = f"smallest region with {percent(region.share)} of those at rest"
        handles.append(Line2D([], [], linestyle=region_style(region), color=SITE, linewidth=1.3, label=words))
    for one in delivery:
        words, style = f"ellipse with {percent(one.share)} of the first impacts", ellipse_style(one.share)
        handles.append(Line2D([], [], linestyle=style, color=DELIVERY, linewidth=1.2, label=words))
    handles.append(Line2D([], [], linestyle="none", label="aim point", **SITE_STYLE))
    return handles


def places_by_end(
    words: Mapping[str, str], colours: Mapping[str, str], end: NDArray[np.str_], latitude: Array, longitude: Array
) -> list[EndPlaces]:
    """The landers that have a place on the ground, by how they ended."""
    has_place = np.isfinite(latitude + longitude)
    return [
        EndPlaces(label, colours[name], latitude[chosen], longitude[chosen])
        for name, label in words.items()
        for chosen in [has_place & (end == name)]
    ]
