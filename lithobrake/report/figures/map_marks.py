"""The mark of a place on a map, and the edges of regions of highest density."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.patheffects import Normal, Stroke

from lithobrake.report.figures.ground_map import GroundMap
from lithobrake.report.figures.style import INK
from lithobrake.results.regions import RestRegion

# Four strokes that point at the place and leave it open: a site is where impacts may be densest.
CROSSHAIR = Path(
    [(0.4, 0.0), (1.0, 0.0), (-0.4, 0.0), (-1.0, 0.0), (0.0, 0.4), (0.0, 1.0), (0.0, -0.4), (0.0, -1.0)],
    [Path.MOVETO, Path.LINETO] * 4,
)
# The white rim keeps the thin strokes readable on dark and on bright places alike.
SITE_STYLE: dict[str, Any] = {
    "marker": CROSSHAIR,
    "markersize": 17,
    "fillstyle": "none",
    "markeredgecolor": INK,
    "markeredgewidth": 1.6,
    "path_effects": [Stroke(linewidth=3.4, foreground="white"), Normal()],
}
# Of the edges of regions with a soil of their own.
SOIL_STYLE: dict[str, Any] = {"color": INK, "linewidth": 1.1, "linestyle": (0, (1.0, 1.6))}
Outlines = Sequence[Sequence[tuple[float, float]]]
# Beyond this a region is dashed.
LARGE_SHARE = 0.9


def mark_site(axes: Axes, x: float, y: float) -> None:
    """Mark the landing site; what lies there stays in sight."""
    axes.plot(x, y, zorder=6, **SITE_STYLE)


def region_style(region: RestRegion) -> Literal["-", "--"]:
    """Style of the edge of a region."""
    return "-" if region.share < LARGE_SHARE else "--"


def fill_regions(axes: Axes, regions: Sequence[RestRegion], ground: GroundMap, colour: str) -> None:
    """Fill regions on a map that holds them whole; the smaller lies in the larger, and the ground is darker there."""
    for region in regions:
        pieces = [Path(np.column_stack(ground.places(*np.array(line).T)), closed=False) for line in region.outlines]
        if pieces:
            path = Path.make_compound_path(*pieces)
            axes.add_patch(PathPatch(path, facecolor=colour, alpha=0.16, linewidth=0.0, zorder=1.5))


def draw_edges(axes: Axes, regions: Sequence[RestRegion], ground: GroundMap, colour: str) -> None:
    """The edges of regions, as far as they lie on this half of the body."""
    for region in regions:
        for line in region.outlines:
            x, y = ground.line(*np.array(line).T)
            axes.plot(x, y, color="white", linewidth=2.4, zorder=3.5, alpha=0.8)
            axes.plot(x, y, region_style(region), color=colour, linewidth=1.3, zorder=4)


def draw_soils(axes: Axes, soils: Mapping[str, Outlines], ground: GroundMap) -> None:
    """The edges of regions with a soil of their own, latitude and longitude [deg], on this half of the body."""
    for lines in soils.values():
        for line in lines:
            axes.plot(*ground.line(*np.array(line).T), zorder=2.5, **SOIL_STYLE)
