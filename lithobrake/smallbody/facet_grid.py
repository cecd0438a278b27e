"""A grid of cells over a shape: facets near a place, signed distance, and lines that meet facets."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_cdt

from lithobrake.compilation.compiled import compiled, kernel, large_kernel
from lithobrake.vocabulary.array_types import Floats, Integers, ShortIntegers

# Cells along the longest side: some five to the edge of a facet, as more are no faster, and at most 24 MB of indices.
CELLS, LARGEST = 2.0, 160  # of the square root of the number of facets, and at most
PAD = 1e-3  # of a cell: covers the rounding of a point that lies on a facet and on a cell's side
RIM = 1e-9  # part of a facet by which it is widened, so that a line through a common edge meets at least one facet


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
        """Sort the facets of a mesh into cells of an edge [m], by default as many to the longest side as CELLS says."""
        corner = vertices[faces]
        low, high = corner.min(axis=1), corner.max(axis=1)
        lower, upper = low.min(axis=0), high.max(axis=0)
        if edge is None:
            edge = float((upper - lower).max()) / min(CELLS * np.sqrt(len(faces)), LARGEST)
        # A cell and a half, so that the outermost layer is empty and `clearance` can count on it.
        lower = lower - 1.5 * edge
        size = np.ceil((upper - lower) / edge).astype(np.int64) + 2
        first = np.floor((low - lower) / edge - PAD).astype(np.int64)
        last = np.floor((high - lower) / edge + PAD).astype(np.int64)
        scaled = (corner - lower) / edge
        normal = np.cross(scaled[:, 1] - scaled[:, 0], scaled[:, 2] - scaled[:, 0])
        plane = np.column_stack([normal, np.einsum("fi,fi->f", normal, scaled[:, 0])])
        start = np.zeros(int(size.prod()) + 1, dtype=np.int32)
        # Counted first and placed then, so that the facets of all cells stand in one array.
        _sort(first, last, plane, size, start, np.empty(0, dtype=np.int32))
        gap = distance_transform_cdt((start[1:] == 0).reshape(size), metric="chessboard").reshape(-1)
        gap -= 1
        np.maximum(gap, 0, out=gap)
        np.cumsum(start, out=start)
        facets = np.empty(start[-1], dtype=np.int32)
        _sort(first, last, plane, size, start, facets)
        # Each cell stands where the next one began.
        start[1:] = start[:-1].copy()
        start[0] = 0
        return cls(lower, edge, size, start, facets, gap)


@compiled
def _sort(
    first: Integers, last: Integers, plane: Floats, size: Integers, start: ShortIntegers, facets: ShortIntegers
) -> None:
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


def pseudonormals(
    vertices: NDArray[np.float64], faces: NDArray[np.int64], normals: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Outward directions of each facet's features: itself, edges 01, 12, 20, corners 0, 1, 2; [facet_count, 7, 3].

    Which side of the nearest feature a point lies on tells whether it is inside. An edge has the sum of its two facets'
    normals, a corner the sum weighted by the facets' angles there.
    """
    result = np.empty((len(faces), 7, 3))
    result[:, 0] = normals
    size = len(vertices)
    ends = np.stack([faces, faces[:, [1, 2, 0]]], axis=2)
    keys = ends.min(axis=2) * size + ends.max(axis=2)
    unique, index = np.unique(keys, return_inverse=True)
    edge_sum = np.zeros((len(unique), 3))
    np.add.at(edge_sum, index.reshape(-1), np.repeat(normals, 3, axis=0))
    result[:, 1:4] = edge_sum[index.reshape(-1, 3)]
    corner = vertices[faces]
    forth, back = corner[:, [1, 2, 0]] - corner, corner[:, [2, 0, 1]] - corner
    # An arc cosine would lose the digits of the small angles of slivers.
    turn = np.arctan2(np.linalg.norm(np.cross(forth, back), axis=2), np.einsum("fci,fci->fc", forth, back))
    vertex_sum = np.zeros((size, 3))
    np.add.at(vertex_sum, faces.reshape(-1), (turn[:, :, None] * normals[:, None, :]).reshape(-1, 3))
    result[:, 4:7] = vertex_sum[faces]
    return result


@kernel
def _closest_feature(p: Floats, a: Floats, b: Floats, c: Floats) -> tuple[float, float, int]:
    """Closest point of triangle a, b, c to p as weights of b and c, and its feature (as in pseudonormals)."""
    d1 = d2 = d3 = d4 = d5 = d6 = 0.0
    for i in range(3):
        u, v = b[i] - a[i], c[i] - a[i]
        d1 += u * (p[i] - a[i])
        d2 += v * (p[i] - a[i])
        d3 += u * (p[i] - b[i])
        d4 += v * (p[i] - b[i])
        d5 += u * (p[i] - c[i])
        d6 += v * (p[i] - c[i])
    # Corners first, then edges, then the facet: each test counts on those before it.
    if d1 <= 0.0 and d2 <= 0.0:
        return 0.0, 0.0, 4
    if d3 >= 0.0 and d4 <= d3:
        return 1.0, 0.0, 5
    if d6 >= 0.0 and d5 <= d6:
        return 0.0, 1.0, 6
    area_c = d1 * d4 - d3 * d2
    if area_c <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        return d1 / (d1 - d3), 0.0, 1
    area_b = d5 * d2 - d1 * d6
    if area_b <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        return 0.0, d2 / (d2 - d6), 3
    area_a = d3 * d6 - d5 * d4
    if area_a <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        fraction = (d4 - d3) / (d4 - d3 + d5 - d6)
        return 1.0 - fraction, fraction, 2
    total = area_a + area_b + area_c
    return area_b / total, area_c / total, 0


@kernel
def _facet_distance(corner: Floats, outward: Floats, f: int, p: Floats) -> tuple[float, float]:
    """Distance of p to facet f [m] and the same with the sign of the side of its nearest feature."""
    v, w, feature = _closest_feature(p, corner[f, 0], corner[f, 1], corner[f, 2])
    square = side = 0.0
    for i in range(3):
        a = corner[f, 0, i]
        offset = p[i] - (a + v * (corner[f, 1, i] - a) + w * (corner[f, 2, i] - a))
        square += offset * offset
        side += offset * outward[f, feature, i]
    distance = np.sqrt(square)
    return distance, -distance if side < 0.0 else distance


@large_kernel
def height_near(grid: Grid, corner: Floats, outward: Floats, p: Floats) -> tuple[float, int]:
    """Signed distance [m] and nearest facet, for a p whose distance is below a cell's edge; else inf and -1.

    outward: pseudonormals [facet_count, 7, 3].
    """
    size, start, facets = grid.size, grid.start, grid.facets
    i, j, k = cell_of(grid, p[0], p[1], p[2])
    # The cells around that of the point hold all facets nearer than an edge, and no others can be trusted to be the
    # nearest.
    best, height, nearest = grid.edge, np.inf, -1
    for a in range(max(i - 1, 0), min(i + 2, size[0])):
        for b in range(max(j - 1, 0), min(j + 2, size[1])):
            for c in range(max(k - 1, 0), min(k + 2, size[2])):
                cell = (a * size[1] + b) * size[2] + c
                for entry in range(start[cell], start[cell + 1]):
                    distance, signed = _facet_distance(corner, outward, facets[entry], p)
                    if distance < best:
                        best, height, nearest = distance, signed, facets[entry]
    return height, nearest


@compiled
def heights(corner: Floats, outward: Floats, points: Floats, height: Floats, nearest: Integers) -> None:
    """Write signed distance [m] and nearest facet of points [count, 3], anywhere."""
    for r in range(len(points)):
        best = np.inf
        for f in range(len(corner)):
            distance, signed = _facet_distance(corner, outward, f, points[r])
            if distance < best:
                best, height[r], nearest[r] = distance, signed, f


@compiled
def near_heights(
    grid: Grid, corner: Floats, outward: Floats, points: Floats, height: Floats, nearest: Integers
) -> None:
    """Write height_near of points [count, 3]: inf and -1 where the surface is farther than a cell's edge."""
    for r in range(len(points)):
        height[r], nearest[r] = height_near(grid, corner, outward, points[r])


@kernel
def intersect_facet(corner: Floats, f: int, origin: Floats, along: Floats) -> tuple[float, float]:
    """Multiple of `along` at which the line meets facet f (nan: it does not), and the side it comes from.

    corner: vertices of the facets [m], [facet_count, 3, 3]; the side is positive where the line goes from outside
    inwards.
    """
    ax, ay, az = corner[f, 0, 0], corner[f, 0, 1], corner[f, 0, 2]
    ux, uy, uz = corner[f, 1, 0] - ax, corner[f, 1, 1] - ay, corner[f, 1, 2] - az
    vx, vy, vz = corner[f, 2, 0] - ax, corner[f, 2, 1] - ay, corner[f, 2, 2] - az
    px, py, pz = along[1] * vz - along[2] * vy, along[2] * vx - along[0] * vz, along[0] * vy - along[1] * vx
    side = ux * px + uy * py + uz * pz
    if side == 0.0:
        return np.nan, 0.0
    tx, ty, tz = origin[0] - ax, origin[1] - ay, origin[2] - az
    u = (tx * px + ty * py + tz * pz) / side
    if not -RIM <= u <= 1.0 + RIM:
        return np.nan, side
    qx, qy, qz = ty * uz - tz * uy, tz * ux - tx * uz, tx * uy - ty * ux
    v = (along[0] * qx + along[1] * qy + along[2] * qz) / side
    if not (v >= -RIM and u + v <= 1.0 + RIM):
        return np.nan, side
    return (vx * qx + vy * qy + vz * qz) / side, side


@large_kernel
def first_entry(grid: Grid, corner: Floats, origin: Floats, along: Floats) -> tuple[float, int]:
    """Where the chord from origin to origin + along first goes from outside inwards: fraction of the chord, and facet.

    The facet is -1 where it does not. Meant for chords no longer than a few cells.
    """
    size, start, facets = grid.size, grid.start, grid.facets
    i, j, k = cell_of(grid, origin[0], origin[1], origin[2])
    u, v, w = cell_of(grid, origin[0] + along[0], origin[1] + along[1], origin[2] + along[2])
    best, hit = np.inf, -1
    for a in range(max(min(i, u), 0), min(max(i, u), size[0] - 1) + 1):
        for b in range(max(min(j, v), 0), min(max(j, v), size[1] - 1) + 1):
            for c in range(max(min(k, w), 0), min(max(k, w), size[2] - 1) + 1):
                cell = (a * size[1] + b) * size[2] + c
                for entry in range(start[cell], start[cell + 1]):
                    fraction, side = intersect_facet(corner, facets[entry], origin, along)
                    # Only inward: a start on the ground, or within rounding of it, then does not hit what it leaves.
                    if side > 0.0 and 0.0 <= fraction <= 1.0 and fraction < best:
                        best, hit = fraction, facets[entry]
    return best, hit


def cones(corner: NDArray[np.float64]) -> NDArray[np.float64]:
    """A cone from the origin around each facet: axis, and least cosine of what is within; [facet_count, 4]."""
    # A corner in the origin has no direction, and its facet no cone.
    with np.errstate(invalid="ignore"):
        toward = corner / np.linalg.norm(corner, axis=2, keepdims=True)
        axis = toward.sum(axis=1)
        axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    cosine = np.einsum("fi,fki->fk", axis, toward).min(axis=1)
    # A cone nearly as wide as a half space holds everything.
    return np.column_stack([axis, np.where(cosine > 0.1, cosine - 1e-6, -2.0)])


@compiled
def outermost_hit(corner: Floats, cone: Floats, directions: Floats, distance: Floats, facet: Integers) -> None:
    """Write the farthest hit of rays from the origin along unit directions [count, 3]: distance [m] (nan: none), facet.

    cone: those of the facets.
    """
    origin = np.zeros(3)
    for r in range(len(directions)):
        distance[r], facet[r] = np.nan, -1
        x, y, z = directions[r, 0], directions[r, 1], directions[r, 2]
        for f in range(len(corner)):
            if x * cone[f, 0] + y * cone[f, 1] + z * cone[f, 2] < cone[f, 3]:
                continue
            t, side = intersect_facet(corner, f, origin, directions[r])
            # Going outwards the line leaves the body: the side is negative.
            # `not t <=` lets the first hit pass, against a distance that is still NaN.
            if side < 0.0 and t > 0.0 and not t <= distance[r]:
                distance[r], facet[r] = t, f
