"""A grid of cells over a shape: which facets are near a place, and how far the surface is at least."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_cdt

from lithobrake.compilation.compiled import compiled, kernel
from lithobrake.smallbody.arrays import Floats, Indices, Integers

LARGEST = 160  # cells along the longest side: 20 MB of indices, and few facets in a cell
PAD = 1e-3  # of a cell: covers the rounding of a point that lies on a facet and on a cell's side


class Grid(NamedTuple):
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
    start: NDArray[np.int32]
    facets: NDArray[np.int32]
    gap: NDArray[np.int32]

    @classmethod
    def of(cls, vertices: NDArray[np.float64], faces: NDArray[np.int64], edge: float | None = None) -> "Grid":
        """Sort the facets of a mesh into cells of an edge [m], by default LARGEST to the longest side."""
        corner = vertices[faces]
        low, high = corner.min(axis=1), corner.max(axis=1)
        lower, upper = low.min(axis=0), high.max(axis=0)
        if edge is None:
            edge = float((upper - lower).max()) / LARGEST
        lower = lower - 1.5 * edge
        size = np.ceil((upper - lower) / edge).astype(np.int64) + 2
        first = np.floor((low - lower) / edge - PAD).astype(np.int64)
        last = np.floor((high - lower) / edge + PAD).astype(np.int64)
        scaled = (corner - lower) / edge
        normal = np.cross(scaled[:, 1] - scaled[:, 0], scaled[:, 2] - scaled[:, 0])
        plane = np.column_stack([normal, np.einsum("fi,fi->f", normal, scaled[:, 0])])
        start = np.zeros(int(size.prod()) + 1, dtype=np.int32)
        _sort(first, last, plane, size, start, np.empty(0, dtype=np.int32))
        occupied = (start[1:] > 0).reshape(size)
        start = np.cumsum(start, dtype=np.int32)
        facets = np.empty(start[-1], dtype=np.int32)
        _sort(first, last, plane, size, start, facets)
        start = np.concatenate([np.zeros(1, dtype=np.int32), start[:-1]])
        gap = np.maximum(distance_transform_cdt(~occupied, metric="chessboard") - 1, 0).astype(np.int32)
        return cls(lower, edge, size, start, facets, gap.reshape(-1))


@compiled
def _sort(first: Integers, last: Integers, plane: Floats, size: Integers, start: Indices, facets: Indices) -> None:
    """Count the facets of each cell c in start[c + 1]; or, given room in facets, place them and move start[c] on.

    first, last: cells that a facet's box spans, [facet_count, 3]; plane: normal and offset in cells, [facet_count, 4].
    """
    for f in range(len(first)):
        nx, ny, nz, offset = plane[f, 0], plane[f, 1], plane[f, 2], plane[f, 3]
        reach = (0.5 + PAD) * (abs(nx) + abs(ny) + abs(nz))
        for i in range(first[f, 0], last[f, 0] + 1):
            for j in range(first[f, 1], last[f, 1] + 1):
                for k in range(first[f, 2], last[f, 2] + 1):
                    # Of the cells in the facet's box only those that its plane cuts.
                    if abs(nx * (i + 0.5) + ny * (j + 0.5) + nz * (k + 0.5) - offset) > reach:
                        continue
                    cell = (i * size[1] + j) * size[2] + k
                    if len(facets) > 0:
                        facets[start[cell]] = f
                        start[cell] += 1
                    else:
                        start[cell + 1] += 1


@kernel
def cell_of(grid: Grid, x: float, y: float, z: float) -> tuple[int, int, int]:
    """Cell (i, j, k) of a point; outside the grid it lies outside 0 to size - 1."""
    lower, edge = grid.lower, grid.edge
    return (
        int(np.floor((x - lower[0]) / edge)),
        int(np.floor((y - lower[1]) / edge)),
        int(np.floor((z - lower[2]) / edge)),
    )


@kernel
def clearance(grid: Grid, x: float, y: float, z: float) -> float:
    """A distance [m] within which there is certainly no facet; 0 near the surface."""
    lower, edge, size = grid.lower, grid.edge, grid.size
    i, j, k = cell_of(grid, x, y, z)
    if 0 <= i < size[0] and 0 <= j < size[1] and 0 <= k < size[2]:
        return grid.gap[(i * size[1] + j) * size[2] + k] * edge
    # The outermost layer of the grid is empty.
    dx = max(lower[0] - x, x - (lower[0] + size[0] * edge), 0.0)
    dy = max(lower[1] - y, y - (lower[1] + size[1] * edge), 0.0)
    dz = max(lower[2] - z, z - (lower[2] + size[2] * edge), 0.0)
    return np.sqrt(dx * dx + dy * dy + dz * dz) + 0.4 * edge
