"""A grid of cells over a shape: which facets are near a place, and how far the surface is at least."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_cdt

from lithobrake.compiled import compiled

LARGEST = 128  # cells along the longest side: 10 MB of indices, and a facet is rarely smaller than such a cell


@dataclass(frozen=True)
class Grid:
    """Cells [cell] of equal edges; cell (i, j, k) has index (i * size[1] + j) * size[2] + k.

    lower       corner of the grid [m], [3]; the outermost layer of cells is empty
    edge        length of a cell's edge [m]
    size        cells along x, y, z, [3]
    start       facets of cell c stand at start[c] to start[c + 1], [cell_count + 1]
    facets      facet indices, cell by cell
    gap         empty cells between a cell and the nearest cell with facets, minus one; 0 in and beside those,
                [cell_count]
    """

    lower: NDArray[np.float64]
    edge: float
    size: NDArray[np.int64]
    start: NDArray[np.int64]
    facets: NDArray[np.int64]
    gap: NDArray[np.int64]

    @classmethod
    def of(cls, vertices: NDArray[np.float64], faces: NDArray[np.int64], edge: float | None = None) -> "Grid":
        """Sort the facets of a mesh into cells of an edge [m], by default somewhat smaller than the mean facet."""
        corner = vertices[faces]
        low, high = corner.min(axis=1), corner.max(axis=1)
        lower, upper = low.min(axis=0), high.max(axis=0)
        doubled = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
        if edge is None:
            edge = max(0.7 * float(np.sqrt(0.5 * doubled.mean())), float((upper - lower).max()) / LARGEST)
        lower = lower - 1.5 * edge
        size = np.ceil((upper - lower) / edge).astype(np.int64) + 2
        # A thousandth of a cell covers the rounding of a point that lies on a facet and on a cell's side.
        first = np.floor((low - lower) / edge - 1e-3).astype(np.int64)
        last = np.floor((high - lower) / edge + 1e-3).astype(np.int64)
        spans = last - first + 1
        start = np.zeros(int(size.prod()) + 1, dtype=np.int64)
        facets = np.empty(int(spans.prod(axis=1).sum()), dtype=np.int64)
        _sort(first, last, size, start, facets)
        occupied = (np.diff(start) > 0).reshape(size)
        gap = np.maximum(distance_transform_cdt(~occupied, metric="chessboard").astype(np.int64) - 1, 0)
        return cls(lower, edge, size, start, facets, gap.reshape(-1))

    @property
    def arrays(self) -> tuple[Any, ...]:
        """The grid in the order in which kernels take it."""
        return self.lower, self.edge, self.size, self.start, self.facets, self.gap


@compiled
def _sort(first: Any, last: Any, size: Any, start: Any, facets: Any) -> None:
    """Write start and facets: count the facets of each cell, sum, then place them in rising order."""
    for write in range(2):
        for f in range(len(first)):
            for i in range(first[f, 0], last[f, 0] + 1):
                for j in range(first[f, 1], last[f, 1] + 1):
                    for k in range(first[f, 2], last[f, 2] + 1):
                        cell = (i * size[1] + j) * size[2] + k
                        if write:
                            facets[start[cell]] = f
                            start[cell] += 1
                        else:
                            start[cell + 1] += 1
        if write:
            # Each entry has moved on to the start of the next cell.
            for cell in range(len(start) - 1, 0, -1):
                start[cell] = start[cell - 1]
            start[0] = 0
        else:
            for cell in range(len(start) - 1):
                start[cell + 1] += start[cell]


@compiled
def place(grid: Any, x: float, y: float, z: float) -> Any:
    """Cell (i, j, k) of a point; outside the grid it lies outside 0 to size - 1."""
    lower, edge = grid[0], grid[1]
    return (
        int(np.floor((x - lower[0]) / edge)),
        int(np.floor((y - lower[1]) / edge)),
        int(np.floor((z - lower[2]) / edge)),
    )


@compiled
def clearance(grid: Any, x: float, y: float, z: float) -> float:
    """A distance [m] within which there is certainly no facet; 0 near the surface."""
    lower, edge, size, _, _, gap = grid
    i, j, k = place(grid, x, y, z)
    if 0 <= i < size[0] and 0 <= j < size[1] and 0 <= k < size[2]:
        return gap[(i * size[1] + j) * size[2] + k] * edge
    # The outermost layer of the grid is empty.
    dx = max(lower[0] - x, x - (lower[0] + size[0] * edge), 0.0)
    dy = max(lower[1] - y, y - (lower[1] + size[1] * edge), 0.0)
    dz = max(lower[2] - z, z - (lower[2] + size[2] * edge), 0.0)
    return np.sqrt(dx * dx + dy * dy + dz * dz) + 0.4 * edge
