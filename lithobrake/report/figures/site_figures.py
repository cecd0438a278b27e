"""A map of sites: what becomes of landers at each, and how emulator and landings agree."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from lithobrake.report.figures.map_frames import degrees
from lithobrake.report.figures.style import INK, QUIET, RULE, SITE, TRAINING
from lithobrake.results.site_results import SiteAgreement, SiteCell, SiteEnds, SiteMap
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.constants import HOUR
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import at_level

COLUMNS = 2
# Points on each side of a site, which the projection bends.
SIDE = 12
GOOD, BAD, GROUND, SUNLIGHT = "viridis", "magma_r", "cividis", "cividis"
# Numbers of all sites within this part of each other make no map.
LEAST_CONTRAST = 0.01
# In inches: a map with its title, its colour bar, what stands between them, and the margins.
WIDE, HIGH, GAP, FOOT = 4.55, 2.1, 0.12, 0.5
# Of the map beside the answer, which the page shows at this width; letters of degrees [points].
ALONE, DEGREES = 4.6, 8.0


@dataclass(frozen=True)
class SiteSheet:
    """A map: title, the number of a site (NaN where it has none), colours, the ends of the scale if they are set."""

    title: str
    read: Callable[[SiteCell], float]
    colours: str
    scale: tuple[float, float] | None = None
    is_marked: bool = False


def sheets(site_map: SiteMap) -> list[SiteSheet]:
    """The maps of a body, each with its unit."""
    rests = [site.ends.at_rest for site in site_map.cells if site.ends is not None]
    lowest = min((one.value if one.lower is None else one.lower for one in rests), default=0.0)
    whole = (10.0 * math.floor(10.0 * lowest), 100.0)
    found = [SiteSheet("at rest [%]", _of_ends(lambda ends: 100.0 * ends.at_rest.value), GOOD, whole, is_marked=True)]
    if site_map.why is None:
        least = _of_ends(lambda ends: 100.0 * (ends.at_rest.lower or 0.0))
        found += [SiteSheet(f"at rest, at least ({at_level(site_map.level)}) [%]", least, GOOD, whole)]
    states = next((tuple(site.ends.limit_states) for site in site_map.cells if site.ends is not None), ())
    found += [SiteSheet(f"limit state {name} [%]", _of_state(name), GOOD, (0.0, 100.0)) for name in states]
    found += [
        SiteSheet("median time to rest [h]", _median("time_s", HOUR), BAD),
        SiteSheet("median distance from the aim point [m]", _median("distance_m", 1.0), BAD),
        SiteSheet("escaped or on the partner [%]", _of_ends(lambda e: 100 * (e.escaped.value + e.partner.value)), BAD),
        SiteSheet("slope against gravity [deg]", lambda site: site.slope_deg.mean, GROUND),
    ]
    names = site_map.cells[0].light
    words = {"sun": "sunlight", "earth": "Earth in sight"}
    return found + [
        SiteSheet(f"{words.get(name, name)} [% of a day]", _light(name), SUNLIGHT, (0.0, 100.0)) for name in names
    ]


def drawn_and_flat(site_map: SiteMap) -> tuple[list[SiteSheet], list[tuple[str, float]]]:
    """The maps that show something, and title and value of those that have one number everywhere.

    The first one, the fraction at rest, is always drawn.
    """
    drawn, flat = [], []
    for number, sheet in enumerate(sheets(site_map)):
        values = np.array([sheet.read(site) for site in site_map.cells])
        values = values[np.isfinite(values)]
        if number > 0 and len(values) > 0 and np.ptp(values) < LEAST_CONTRAST * max(np.abs(values).max(), 1.0):
            flat.append((sheet.title, float(values.mean())))
        else:
            drawn.append(sheet)
    return drawn, flat


def _of_ends(read: Callable[[SiteEnds], float]) -> Callable[[SiteCell], float]:
    return lambda site: math.nan if site.ends is None else read(site.ends)


def _of_state(name: str) -> Callable[[SiteCell], float]:
    return _of_ends(lambda ends: 100.0 * ends.limit_states[name].value)


def _median(name: str, unit: float) -> Callable[[SiteCell], float]:
    def read(site: SiteCell) -> float:
        found = None if site.ends is None else getattr(site.ends, name)
        return math.nan if found is None else float(found.value) / unit

    return read


def _light(name: str) -> Callable[[SiteCell], float]:
    return lambda site: 100.0 * site.light[name].mean


def rest_figure(site_map: SiteMap) -> Figure:
    """Draw the fraction at rest alone, for the narrow place beside the answer."""
    width, height = ALONE + 0.1, HIGH * ALONE / WIDE + FOOT
    figure = Figure(figsize=(width, height))
    _put(figure, site_map, sheets(site_map)[0], (0.1, FOOT), ALONE)
    _legend(figure, site_map, 0.1 / height)
    return figure


def sites_figure(site_map: SiteMap) -> Figure:
    """Draw every number of a map of sites over the whole body, in Hammer's equal-area projection.

    Sites that cannot be told from the best are framed, those that are not answered hatched.
    """
    drawn, _ = drawn_and_flat(site_map)
    rows = -(-len(drawn) // COLUMNS)
    height = rows * (HIGH + GAP) + FOOT
    figure = Figure(figsize=(COLUMNS * WIDE + 0.1, height))
    for number, sheet in enumerate(drawn):
        row, column = divmod(number, COLUMNS)
        _put(figure, site_map, sheet, (0.1 + column * WIDE, height - (row + 1) * (HIGH + GAP) + GAP), WIDE)
    _legend(figure, site_map, 0.1 / height)
    return figure


def _put(figure: Figure, site_map: SiteMap, sheet: SiteSheet, corner: tuple[float, float], wide: float) -> None:
    """A map and its colour bar, from a corner (left, bottom) on and so wide, all in inches."""
    (width, height), (left, bottom), high = figure.get_size_inches(), corner, HIGH * wide / WIDE
    polygons = [hammer(*_border(*site.bounds_deg)) for site in site_map.cells]
    axes = figure.add_axes((left / width, bottom / height, (wide - 0.65) / width, (high - 0.28) / height))
    colours = _draw(axes, site_map, sheet, polygons)
    bar = figure.add_axes(((left + wide - 0.6) / width, (bottom + 0.3) / height, 0.1 / width, (high - 0.75) / height))
    scale: Any = figure.colorbar(colours, cax=bar)
    scale.outline.set_visible(False)
    bar.tick_params(length=2.0)


def hammer(latitude_deg: Array, longitude_deg: Array) -> Array:
    """Places on Hammer's equal-area projection about longitude 0, [count, 2]: 4 wide and 2 high.

    Source: [Snyder-1987], chapter 24.
    """
    latitude, half = np.radians(latitude_deg), 0.5 * np.radians(longitude_deg)
    size = np.sqrt(1.0 + np.cos(latitude) * np.cos(half))
    flat: Array = np.stack([2.0 * np.cos(latitude) * np.sin(half), np.sin(latitude)], axis=-1) / size[..., None]
    return flat


def _border(south: float, north: float, west: float, east: float) -> tuple[Array, Array]:
    """Latitudes and longitudes along the border of a site [deg], [count]."""
    up, along = np.linspace(south, north, SIDE), np.linspace(west, east, SIDE)
    latitude = [up, np.full(SIDE, north), up[::-1], np.full(SIDE, south)]
    longitude = [np.full(SIDE, west), along, np.full(SIDE, east), along[::-1]]
    return np.concatenate(latitude), np.concatenate(longitude)


def _draw(axes: Axes, site_map: SiteMap, sheet: SiteSheet, polygons: Sequence[Array]) -> PolyCollection:
    """Colour the sites that have a number, hatch the others, and frame the best."""
    values = np.array([sheet.read(site) for site in site_map.cells])
    known = np.isfinite(values)
    coloured = [polygons[one] for one in np.flatnonzero(known).tolist()]
    cells = PolyCollection(coloured, array=values[known], cmap=sheet.colours)
    cells.set_clim(*(sheet.scale or _ends(values[known])))
    cells.set_edgecolor("face")
    cells.set_linewidth(0.3)
    axes.add_collection(cells)
    lacking = [polygons[one] for one in np.flatnonzero(~known).tolist()]
    axes.add_collection(PolyCollection(lacking, facecolor="white", edgecolor=QUIET, hatch="////", linewidth=0.2))
    if sheet.is_marked and _some_are_best(site_map):
        best = [polygons[one] for one, site in enumerate(site_map.cells) if site.not_worse]
        axes.add_collection(PolyCollection(best, facecolor="none", edgecolor=SITE, linewidth=0.9, zorder=4))
    axes.set_title(sheet.title)
    _graticule(axes)
    return cells


def _some_are_best(site_map: SiteMap) -> bool:
    """Whether some of the sites that are answered cannot be told from the best, and others can."""
    return 0 < sum(site.not_worse for site in site_map.cells) < site_map.answered


def _graticule(axes: Axes) -> None:
    """Parallels and meridians with their degrees, and the edge of the map."""
    turn = np.linspace(-180.0, 180.0, 181)
    for latitude in range(-60, 61, 30):
        axes.plot(*hammer(np.full(181, latitude), turn).T, color=RULE, linewidth=0.4, alpha=0.8, zorder=3)
        x, y = hammer(np.array([latitude]), np.array([-180.0]))[0]
        words = degrees(latitude, "N", "S")
        # Beside the edge, which runs away from the equator to the right.
        off = (-3.0, 0.06 * latitude)
        axes.annotate(words, (x, y), off, textcoords="offset points", ha="right", va="center", fontsize=DEGREES)
    for longitude in range(-120, 121, 60):
        line = hammer(0.5 * turn, np.full(181, longitude))
        axes.plot(*line.T, color=RULE, linewidth=0.4, alpha=0.8, zorder=3)
        words = degrees(longitude, "E", "W")
        axes.annotate(
            words, tuple(line[90]), (1.5, 1.5), textcoords="offset points", fontsize=DEGREES, color="white",
            path_effects=_rim(), zorder=5,
        )  # fmt: skip
    edge = [hammer(0.5 * turn[:: 1 if side > 0 else -1], np.full(181, side * 180.0)) for side in (-1.0, 1.0)]
    axes.plot(*np.concatenate([*edge, edge[0][:1]]).T, color=INK, linewidth=0.7, zorder=4)
    axes.set_xlim(-2.4, 2.02)
    axes.set_ylim(-1.02, 1.02)
    axes.set_aspect("equal", anchor="W")
    axes.set_axis_off()


def _rim() -> list[Any]:
    """A dark rim that keeps white letters readable on any colour."""
    from matplotlib import patheffects

    return [patheffects.withStroke(linewidth=1.4, foreground=INK)]


def _ends(values: Array) -> tuple[float, float]:
    """The ends of a scale that holds all values; a unit wide where they are one."""
    if not len(values):
        return 0.0, 1.0
    low, high = float(values.min()), float(values.max())
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _legend(figure: Figure, site_map: SiteMap, bottom: float) -> None:
    """What frames and hatching are, and where the map's middle is."""
    marks = []
    if _some_are_best(site_map):
        marks += [Patch(facecolor="none", edgecolor=SITE, label="indistinguishable from the best")]
    if site_map.answered < len(site_map.cells):
        marks += [Patch(facecolor="none", edgecolor=QUIET, hatch="////", label="outside the training range")]
    axes = figure.add_axes((0.02, bottom, 0.96, 0.01))
    axes.set_axis_off()
    words = "Every site has the same area."
    axes.legend(handles=marks, ncol=2, loc="lower left", title=words, title_fontsize=8.0, alignment="left")


def agreement_figure(regions: Sequence[SiteAgreement], level: float) -> Figure:
    """Draw landers at rest by landings against those by the emulator, with intervals; the whole body is filled."""
    figure = Figure(figsize=(9.2, 3.7))
    axes = figure.add_axes((0.32, 0.13, 0.34, 0.845))
    axes.plot([0.0, 100.0], [0.0, 100.0], color=RULE, linewidth=1.0, zorder=1)
    lowest = 100.0
    for one in regions:
        lowest = min([lowest, 100.0 * one.landings.value, 100.0 * one.emulator.value, *_lower(one)])
        is_whole = one.latitude_deg is None
        axes.errorbar(
            [100.0 * one.emulator.value],
            [100.0 * one.landings.value],
            xerr=_bars(one.emulator),
            yerr=_bars(one.landings),
            fmt="o",
            color=SITE if is_whole else TRAINING,
            markerfacecolor=(SITE if is_whole else "white"),
            elinewidth=0.9,
            zorder=3 if is_whole else 2,
        )
    low = max(10.0 * math.floor(0.1 * lowest) - 5.0, -2.0)
    axes.set_xlim(low, 102.0)
    axes.set_ylim(low, 102.0)
    axes.set_xlabel(f"at rest by the emulator, {at_level(level)} [%]")
    axes.set_ylabel(f"at rest by landings, {at_level(level)} [%]")
    return figure


def _bars(share: Estimate) -> list[list[float]] | None:
    """Lengths of the bars below and above a share, in per cent; None where it has no interval."""
    if share.bounds is None:
        return None
    return [[100.0 * abs(end - share.value)] for end in share.bounds]


def _lower(one: SiteAgreement) -> list[float]:
    return [100.0 * end for end in (one.landings.lower, one.emulator.lower) if end is not None]
