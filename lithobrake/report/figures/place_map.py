"""Where landers end: their places and the smallest regions that hold them, about the aim point and all around."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from lithobrake.report.figures import ground_map, limit_areas
from lithobrake.report.figures.map_frames import draw_bar, frame_half, frame_local
from lithobrake.report.figures.share_figures import ShareBar, draw_shares, row_count
from lithobrake.report.figures.style import QUIET
from lithobrake.results.dispersion import RestRegion
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.limit_state import LimitState
from lithobrake.vocabulary.number_words import percent
from lithobrake.vocabulary.plain_text import one_line

# Inches of the figure beside the answer: its width, the map, what stands left of it and below it, a row of the legend.
WIDTH, MAP, LEFT, BELOW, ROW = 4.7, 3.95, 0.68, 0.42, 0.17
# Of the halves of the body beside the outcomes: their height [inch].
DISCS = 2.75
# Letters of a condition in the legend.
LONGEST_TEXT = 56


@dataclass(frozen=True)
class Places:
    """Landers that ended in one way: words of the outcome, its colour, latitude and longitude [deg]."""

    words: str
    colour: str
    latitude: Array
    longitude: Array

    @property
    def are_many(self) -> bool:
        """Whether they are drawn as counts in cells, not as dots."""
        return len(self.latitude) >= ground_map.MANY


@dataclass(frozen=True)
class Regions:
    """Smallest regions that hold shares of landers, in words and in their colour."""

    of: str
    colour: str
    found: Sequence[RestRegion]


@dataclass(frozen=True)
class PlaceMap:
    """What a map shows: places and regions by outcome, the aim point [deg], and the radius of the body there [m].

    The first regions are filled, of the others the edges are drawn. soils: latitude and longitude [deg] along the edges
    of regions with a soil of their own, by name. has_aim: false of the other body of a binary, whose map is about its
    longitude 0 instead. areas: limit states of journeys that depend on the place of rest, by name.
    """

    places: Sequence[Places]
    regions: Sequence[Regions]
    aim: tuple[float, float]
    radius: float
    soils: Mapping[str, ground_map.Outlines] = field(default_factory=dict)
    has_aim: bool = True
    areas: Mapping[str, LimitState] = field(default_factory=dict)

    @property
    def ground(self) -> ground_map.GroundMap:
        """The map about the aim point."""
        return ground_map.GroundMap(*self.aim, self.radius)

    def panel(self) -> ground_map.MapPanel | None:
        """The part of it that holds the regions, or the landers where there are none; None where they lie apart."""
        lines = [np.array(line).T for one in self.regions for region in one.found for line in region.outlines]
        if not (self.regions and self.regions[0].found):
            lines += [np.array([one.latitude, one.longitude]) for one in self.places]
        panel = ground_map.panel_around(self.ground, [(latitude, longitude) for latitude, longitude in lines])
        lines += [] if panel is None else limit_areas.circles(self.areas.values(), self.ground, panel)
        return ground_map.panel_around(self.ground, [(latitude, longitude) for latitude, longitude in lines])

    @property
    def leaves_out(self) -> bool:
        """Whether places lie outside of the map about the aim point; never where that is of the whole body."""
        panel = self.panel()
        return panel is not None and any(_outside(one, self.ground, panel) for one in self.places)


def local_figure(shown: PlaceMap) -> Figure:
    """Draw the map about the aim point in metres; both halves of the body where places lie too far apart."""
    panel, handles = shown.panel(), _handles(shown)
    many = next((one for one in shown.places if one.are_many), None)
    rows = ROW * len(handles) + 0.06 + (0.62 if many else 0.0)
    height = (0.05 + MAP + BELOW if panel else 0.5 * WIDTH) + rows
    figure = Figure(figsize=(WIDTH, height))
    grounds = (shown.ground,) if panel else (shown.ground, shown.ground.opposite)
    norm = _norm(shown, grounds, panel)
    if panel is None:
        _halves(figure, shown, norm, (0.01, rows / height, 0.98, 1.0 - rows / height))
    else:
        axes = figure.add_axes((LEFT / WIDTH, (rows + BELOW) / height, MAP / WIDTH, MAP / height))
        draw_local(axes, shown, panel, norm)
    if many:
        width = ground_map.cell_counts(shown.ground, (many.latitude, many.longitude), panel)[2]
        bar = figure.add_axes((LEFT / WIDTH, (rows - 0.14) / height, 0.7, 0.1 / height))
        scale = draw_scale(figure, many, norm, width, cax=bar, orientation="horizontal")
        scale.ax.xaxis.label.set_fontsize(8)
        scale.outline.set_visible(False)
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.03, 0.01), borderpad=0.0, borderaxespad=0.0)
    return figure


def whole_figure(shown: PlaceMap) -> Figure:
    """Draw both halves of the body."""
    handles = _handles(shown)
    height = 0.5 * WIDTH + ROW * len(handles) + 0.06
    figure = Figure(figsize=(WIDTH, height))
    norm = _norm(shown, (shown.ground, shown.ground.opposite), None)
    _halves(figure, shown, norm, (0.01, 1.0 - 0.5 * WIDTH / height, 0.98, 0.5 * WIDTH / height))
    figure.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.03, 0.01), borderpad=0.0, borderaxespad=0.0)
    return figure


def outcomes_figure(shown: PlaceMap, shares: list[ShareBar], whole: str) -> Figure:
    """Draw the share of each outcome, and both halves of the body where the map about the aim point leaves places out.

    whole: what the shares are of.
    """
    rows = 0.2 * row_count(shares)
    if not shown.leaves_out:
        height = rows + 0.75
        figure = Figure(figsize=(9.2, height))
        draw_shares(figure.add_axes((0.2, 0.6 / height, 0.6, rows / height)), shares, whole)
        return figure
    height = max(DISCS, rows + 0.8)
    figure = Figure(figsize=(9.2, height))
    norm = _norm(shown, (shown.ground, shown.ground.opposite), None)
    _halves(figure, shown, norm, (0.0, 0.0, 0.51, 1.0))
    draw_shares(
        figure.add_axes((0.735, 0.5 * (1.0 - rows / height) + 0.1 / height, 0.13, rows / height)), shares, whole
    )
    return figure


def draw_local(axes: Axes, shown: PlaceMap, panel: ground_map.MapPanel, norm: LogNorm) -> None:
    """Draw a part of the map about the aim point with its frame."""
    ground, outside = shown.ground, 0
    for place, one in enumerate(shown.regions):
        if place == 0 and not any(places.are_many for places in shown.places):
            ground_map.fill_regions(axes, one.found, ground, one.colour)
        ground_map.draw_edges(axes, one.found, ground, one.colour)
    ground_map.draw_soils(axes, shown.soils, ground)
    limit_areas.draw_areas(axes, shown.areas, shown.aim, ground, panel)
    for places in shown.places:
        _draw_places(axes, places, ground, panel, norm)
        outside += _outside(places, ground, panel)
    ground_map.mark_site(axes, 0.0, 0.0)
    frame_local(axes, ground, panel)
    if outside:
        style: dict[str, Any] = {"ha": "right", "va": "bottom", "fontsize": 8, "color": QUIET, "zorder": 7}
        axes.text(0.975, 0.03, f"{outside} outside", transform=axes.transAxes, **style)


def draw_scale(figure: Any, many: Places, norm: LogNorm, width: float, **place: Any) -> Any:
    """The colour bar of counts in cells of a width [m], at a place as of Figure.colorbar."""
    words = f"{many.words} in a cell {width:.2g} m wide"
    bar: Any = figure.colorbar(
        ScalarMappable(norm, ground_map.density_colours(many.colour)), format="%g", label=words, **place
    )
    return bar


def _norm(shown: PlaceMap, grounds: Sequence[ground_map.GroundMap], panel: ground_map.MapPanel | None) -> LogNorm:
    """One scale for the counts of all maps of a figure."""
    places = [(ground, (one.latitude, one.longitude)) for ground in grounds for one in shown.places]
    return ground_map.density_norm([ground_map.cell_counts(ground, place, panel)[0] for ground, place in places])


def _outside(places: Places, ground: ground_map.GroundMap, panel: ground_map.MapPanel) -> int:
    """How many places lie outside of a panel."""
    return len(places.latitude) - int(panel.holds(*_seen(places, ground)).sum())


def _seen(places: Places, ground: ground_map.GroundMap) -> tuple[Array, Array]:
    """Metres east and north of those on the half of the body around the middle of the map."""
    seen = ground.facing(places.latitude, places.longitude) >= 0.0
    return ground.places(places.latitude[seen], places.longitude[seen])


def _draw_places(
    axes: Axes, places: Places, ground: ground_map.GroundMap, panel: ground_map.MapPanel | None, norm: LogNorm
) -> None:
    """Draw places as dots, or many of them as counts in cells."""
    if places.are_many:
        ground_map.draw_cells(axes, ground, (places.latitude, places.longitude), panel, norm, places.colour)
    else:
        size = 16.0 if panel else 9.0
        axes.scatter(*_seen(places, ground), s=size, color=places.colour, linewidths=0.4, edgecolors="white", zorder=5)


def _halves(figure: Figure, shown: PlaceMap, norm: LogNorm, place: tuple[float, float, float, float]) -> None:
    """Both halves of the body side by side at a place in parts of the figure: left, bottom, width, height."""
    left, bottom, width, height = place
    middle = "the aim point" if shown.has_aim else "longitude 0"
    for side, (ground, title) in enumerate(
        ((shown.ground, f"the half around {middle}"), (shown.ground.opposite, "the other half"))
    ):
        axes = figure.add_axes((left + 0.5 * width * side, bottom, 0.5 * width, 0.91 * height))
        _draw_half(axes, shown, ground, norm, title)
        if side == 0:
            draw_bar(axes, 2.12 * ground.edge)
        if side == 0 and shown.has_aim:
            ground_map.mark_site(axes, 0.0, 0.0)


def _draw_half(axes: Axes, shown: PlaceMap, ground: ground_map.GroundMap, norm: LogNorm, title: str) -> None:
    disc = frame_half(axes, ground, title)
    for one in shown.regions:
        ground_map.draw_edges(axes, one.found, ground, one.colour)
    ground_map.draw_soils(axes, shown.soils, ground)
    limit_areas.draw_areas(axes, shown.areas, shown.aim, ground, None)
    for places in shown.places:
        _draw_places(axes, places, ground, None, norm)
    for line in axes.lines:
        line.set_clip_path(disc)


def draw_map(axes: Axes, shown: PlaceMap) -> None:
    """The map about the aim point on axes of the caller; where places lie too far apart, the half of the body there."""
    panel = shown.panel()
    norm = _norm(shown, (shown.ground,), panel)
    if panel is None:
        _draw_half(axes, shown, shown.ground, norm, "the half around the aim point")
        ground_map.mark_site(axes, 0.0, 0.0)
        draw_bar(axes, 2.12 * shown.ground.edge)
    else:
        draw_local(axes, shown, panel, norm)
    many = next((one for one in shown.places if one.are_many), None)
    if many:
        width = ground_map.cell_counts(shown.ground, (many.latitude, many.longitude), panel)[2]
        draw_scale(axes.figure, many, norm, width, ax=axes, shrink=0.7)
    axes.legend(handles=_handles(shown), loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=2)


def _handles(shown: PlaceMap) -> list[Line2D]:
    """Say what dots, lines and mark are."""
    handles = [
        Line2D([], [], linestyle="none", marker="o", markersize=5, color=one.colour, label=f"{one.words} ({count})")
        for one in shown.places
        for count in [len(one.latitude)]
        if count and not one.are_many
    ]
    for one in shown.regions:
        for region in one.found:
            words, style = f"smallest region with {percent(region.share)} of {one.of}", ground_map.region_style(region)
            handles.append(Line2D([], [], linestyle=style, color=one.colour, linewidth=1.3, label=words))
    if any(shown.soils.values()):
        named = ", ".join(name for name, lines in shown.soils.items() if lines)
        handles.append(Line2D([], [], label=f"edges of soils ({named})", **ground_map.SOIL_STYLE))
    handles += [
        Line2D([], [], label=f"limit state {name} ({one_line(one.text, LONGEST_TEXT)})", **style)
        for (name, one), style in zip(shown.areas.items(), limit_areas.area_styles(shown.areas), strict=True)
    ]
    aim = Line2D([], [], linestyle="none", label="aim point", **{**ground_map.SITE_STYLE, "markersize": 11})
    return [*handles, aim] if shown.has_aim else handles


def places_by_end(
    words: Mapping[str, str], colours: Mapping[str, str], end: NDArray[np.str_], latitude: Array, longitude: Array
) -> list[Places]:
    """The landers that have a place on the ground, by how they ended."""
    has_place = np.isfinite(latitude + longitude)
    return [
        Places(label, colours[name], latitude[chosen], longitude[chosen])
        for name, label in words.items()
        for chosen in [has_place & (end == name)]
    ]


@dataclass(frozen=True)
class RestMap:
    """One side of the figure: where landers rest, the regions that hold them, and shares.

    whole: what the shares are shares of.
    """

    title: str
    places: Places
    regions: Regions
    shares: list[ShareBar]
    whole: str


def rest_figure(maps: Sequence[RestMap], aim: tuple[float, float], radius: float) -> Figure:
    """Draw the maps side by side, over one and the same part of the body, and what became of the landers below them.

    aim: latitude and longitude [deg]; radius: of the body there [m]. Where no lander rests, or places lie all around
    the body, the shares alone are drawn.
    """
    together = PlaceMap([one.places for one in maps], [one.regions for one in maps], aim, radius)
    panel = together.panel() if any(len(one.places.latitude) for one in maps) else None
    # In inches: the maps, a row for each bar, and the axis below the bars.
    rows, maps_height, row_height, below = max(len(one.shares) for one in maps), 4.5 if panel else 0.35, 0.2, 0.5
    height = maps_height + row_height * rows + below
    figure = Figure(figsize=(9.2, height))
    for side, one in enumerate(maps):
        figure.text(0.07 + 0.5 * side, 1.0 - 0.16 / height, one.title, weight="bold", fontsize=9.5, va="center")
        if panel:
            axes = figure.add_axes((0.07 + 0.5 * side, 1.0 - 3.85 / height, 0.38, 3.5 / height))
            places = (one.places.latitude, one.places.longitude)
            norm = ground_map.density_norm([ground_map.cell_counts(together.ground, places, panel)[0]])
            draw_local(axes, replace(together, places=[one.places], regions=[one.regions]), panel, norm)
        share = row_height * len(one.shares) / height
        bars = figure.add_axes((0.135 + 0.5 * side, 1.0 - maps_height / height - share, 0.18, share))
        draw_shares(bars, one.shares, one.whole)
    return figure
