"""Distance from a point to the surface of a shape, negative inside.

Sources: [Ericson-2005], section 5.1.5 (closest point of a triangle); [Baerentzen-2005].
"""

import numpy as np
from numpy.typing import NDArray

from lithobrake.compilation.compiled import compiled, kernel, large_kernel
from lithobrake.smallbody.arrays import Floats, Integers
from lithobrake.smallbody.grid import Grid, cell_of


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
