"""How densely places lie on a map: cells of one area, and how many of them lie in each."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap, LogNorm, to_rgb
from numpy.typing import NDArray

from lithobrake.report.figures.ground_map import GroundMap, MapPanel

Array = NDArray[np.float64]
# Below this cells would be mostly empty, and each place is a dot.
MANY = 1000
# Cells along the width of a map.
CELLS = 60


def density_colours(colour: str) -> LinearSegmentedColormap:
    """From a pale tint of a colour over itself to a dark shade, ever darker."""
    own = np.array(to_rgb(colour))
    ends = [tuple(1.0 - 0.3 * (1.0 - own)), tuple(own), tuple(0.3 * own)]
    return LinearSegmentedColormap.from_list(f"density of {colour}", ends)


def draw_cells(
    axes: Axes, ground: GroundMap, places: tuple[Array, Array], panel: MapPanel | None, norm: LogNorm, colour: str
) -> None:
    """Draw how many places lie in each cell of a panel, or of the half of the body.

    places: latitude and longitude [deg], shape [count] each.
    """
    counts, (x, y), _ = cell_counts(ground, places, panel)
    shown = np.ma.masked_equal(counts.T, 0)
    axes.pcolormesh(x, y, shown, norm=norm, cmap=density_colours(colour), zorder=1.4, rasterized=True)


def cell_counts(
    ground: GroundMap, places: tuple[Array, Array], panel: MapPanel | None
) -> tuple[Array, tuple[Array, Array], float]:
    """Counts in cells [CELLS, CELLS], the edges of these east and north [m], and the width of a cell [m]."""
    shown = panel or MapPanel(0.0, 0.0, ground.edge)
    seen = ground.facing(*places) >= 0.0
    east, north = ground.places(*(one[seen] for one in places))
    edges = np.linspace(-shown.half, shown.half, CELLS + 1)
    x, y = shown.east + edges, shown.north + edges
    return np.histogram2d(east, north, bins=(x, y))[0], (x, y), 2.0 * shown.half / CELLS


def density_norm(counts: Sequence[Array]) -> LogNorm:
    """One scale for several maps."""
    return LogNorm(1.0, max([10.0, *(float(one.max()) for one in counts)]))
