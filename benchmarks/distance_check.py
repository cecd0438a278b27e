"""Distance of two convex polyhedra without search, for comparison: every feature against every feature.

Nothing is shared with the narrow phase. Apart, the distance is the smallest of all corners to all triangles and of all
edges to all edges, each taken between points of the features themselves, so that round-off makes it no shorter than
the true one by more than that of a coordinate. Whether two polyhedra overlap, and how deep, is asked of all directions
in which they can part first: normals of faces and of pairs of edges. Source: Gottschalk, Lin and Manocha (1996).
"""

import math
from typing import Any, NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


class Meshes(NamedTuple):
    """Polyhedra one after the other, each in its own frame. `start[s]:start[s + 1]` belongs to polyhedron s."""

    vertex: Floats  # [vertex_total, 3], m
    vertex_start: Integers  # [shape_count + 1]
    triangle: Integers  # [triangle_total, 3], counted within the polyhedron
    triangle_start: Integers  # [shape_count + 1]
    edge: Integers  # [edge_total, 2], every side of a triangle once
    edge_start: Integers  # [shape_count + 1]


def meshes_of(solids: list[tuple[Floats, Integers]]) -> Meshes:
    """Lay solids (vertices [m], triangles) one after the other; a point has no triangles."""
    edges = []
    for _, triangles in solids:
        sides = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
        edges.append(np.unique(sides, axis=0))

    def starts(parts: list[Any]) -> Integers:
        return np.concatenate([[0], np.cumsum([len(part) for part in parts])]).astype(np.int64)

    vertices, triangles = [solid[0] for solid in solids], [solid[1] for solid in solids]
    return Meshes(
        np.concatenate(vertices), starts(vertices), np.concatenate(triangles), starts(triangles),
        np.concatenate(edges), starts(edges),
    )  # fmt: skip


@numba.njit(cache=True)
def turned(meshes: Meshes, shape: int, rotation: Floats, place: Floats) -> Floats:
    """Return the vertices of a polyhedron in the world frame [m], shape [vertex_count, 3]."""
    start, end = meshes.vertex_start[shape], meshes.vertex_start[shape + 1]
    result = np.empty((end - start, 3))
    for k in range(start, end):
        for i in range(3):
            total = place[i]
            for j in range(3):
                total += rotation[i, j] * meshes.vertex[k, j]
            result[k - start, i] = total
    return result


@numba.njit(cache=True)
def dot(a: Floats, b: Floats) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@numba.njit(cache=True)
def foot_square(p: Floats, a: Floats, b: Floats, c: Floats) -> float:
    """Return the squared distance of p from its foot on a triangle; infinity where that lies beside it."""
    u0, u1, u2 = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    v0, v1, v2 = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    w0, w1, w2 = p[0] - a[0], p[1] - a[1], p[2] - a[2]
    n0, n1, n2 = u1 * v2 - u2 * v1, u2 * v0 - u0 * v2, u0 * v1 - u1 * v0
    square = n0 * n0 + n1 * n1 + n2 * n2
    if square == 0.0:
        return math.inf
    along_u = (n0 * (w1 * v2 - w2 * v1) + n1 * (w2 * v0 - w0 * v2) + n2 * (w0 * v1 - w1 * v0)) / square
    along_v = (n0 * (u1 * w2 - u2 * w1) + n1 * (u2 * w0 - u0 * w2) + n2 * (u0 * w1 - u1 * w0)) / square
    if along_u < 0.0 or along_v < 0.0 or along_u + along_v > 1.0:
        return math.inf
    x = w0 - along_u * u0 - along_v * v0
    y = w1 - along_u * u1 - along_v * v1
    z = w2 - along_u * u2 - along_v * v2
    return x * x + y * y + z * z


@numba.njit(cache=True)
def segment_square(p: Floats, q: Floats, r: Floats, s: Floats) -> float:
    """Return the squared distance of two segments pq and rs, by their lines first and then by all four ends."""
    u0, u1, u2 = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    v0, v1, v2 = s[0] - r[0], s[1] - r[1], s[2] - r[2]
    w0, w1, w2 = r[0] - p[0], r[1] - p[1], r[2] - p[2]
    uu, vv, uv = u0 * u0 + u1 * u1 + u2 * u2, v0 * v0 + v1 * v1 + v2 * v2, u0 * v0 + u1 * v1 + u2 * v2
    uw, vw = u0 * w0 + u1 * w1 + u2 * w2, v0 * w0 + v1 * w1 + v2 * w2
    n0, n1, n2 = u1 * v2 - u2 * v1, u2 * v0 - u0 * v2, u0 * v1 - u1 * v0
    square = n0 * n0 + n1 * n1 + n2 * n2
    best = math.inf
    for trial in range(5):
        if trial == 0:
            if square == 0.0:
                continue
            # The cross product of gap and edge keeps digits that uw vv - vw uv loses where edges are nearly parallel.
            along_u = (n0 * (w1 * v2 - w2 * v1) + n1 * (w2 * v0 - w0 * v2) + n2 * (w0 * v1 - w1 * v0)) / square
            along_u = min(max(along_u, 0.0), 1.0)
            along_v = min(max((along_u * uv - vw) / vv, 0.0), 1.0)
            along_u = min(max((along_v * uv + uw) / uu, 0.0), 1.0)
        elif trial <= 2:
            along_u = trial - 1.0
            along_v = min(max((along_u * uv - vw) / vv, 0.0), 1.0)
        else:
            along_v = trial - 3.0
            along_u = min(max((along_v * uv + uw) / uu, 0.0), 1.0)
        x = w0 + along_v * v0 - along_u * u0
        y = w1 + along_v * v1 - along_u * u1
        z = w2 + along_v * v2 - along_u * u2
        best = min(best, x * x + y * y + z * z)
    return best


@numba.njit(cache=True)
def surface_distance(meshes: Meshes, one: int, two: int, a: Floats, b: Floats) -> float:
    """Return the smallest distance of all features of two polyhedra with vertices a and b [m]."""
    best = math.inf
    for shape, corners, others in ((one, a, b), (two, b, a)):
        for t in range(meshes.triangle_start[shape], meshes.triangle_start[shape + 1]):
            i, j, k = meshes.triangle[t]
            for n in range(len(others)):
                best = min(best, foot_square(others[n], corners[i], corners[j], corners[k]))
        if len(others) == 1:
            for e in range(meshes.edge_start[shape], meshes.edge_start[shape + 1]):
                i, j = meshes.edge[e]
                along, away = corners[j] - corners[i], others[0] - corners[i]
                away -= min(max(dot(along, away) / dot(along, along), 0.0), 1.0) * along
                best = min(best, dot(away, away))
    for e in range(meshes.edge_start[one], meshes.edge_start[one + 1]):
        for f in range(meshes.edge_start[two], meshes.edge_start[two + 1]):
            p, q, r, s = meshes.edge[e, 0], meshes.edge[e, 1], meshes.edge[f, 0], meshes.edge[f, 1]
            best = min(best, segment_square(a[p], a[q], b[r], b[s]))
    if len(a) == 1 and len(b) == 1:
        best = dot(a[0] - b[0], a[0] - b[0])
    return math.sqrt(best)


@numba.njit(cache=True)
def gap_along(a: Floats, b: Floats, x: float, y: float, z: float) -> float:
    """Return how far all of b lies beyond all of a along a unit vector [m]: never more than their distance."""
    top, bottom = -math.inf, math.inf
    for k in range(len(a)):
        top = max(top, a[k, 0] * x + a[k, 1] * y + a[k, 2] * z)
    for k in range(len(b)):
        bottom = min(bottom, b[k, 0] * x + b[k, 1] * y + b[k, 2] * z)
    return bottom - top


@numba.njit(cache=True)
def gap_across(a: Floats, b: Floats, u: Floats, v: Floats) -> float:
    """Return the larger gap along u x v and against it [m]; minus infinity for parallel vectors."""
    x, y, z = u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]
    # Of nearly parallel edges the product is square to neither by rounding: once more, and it is.
    for w in (u, v, u):
        slant = (x * w[0] + y * w[1] + z * w[2]) / dot(w, w)
        x, y, z = x - slant * w[0], y - slant * w[1], z - slant * w[2]
    length = math.sqrt(x * x + y * y + z * z)
    if length == 0.0:
        return -math.inf
    x, y, z = x / length, y / length, z / length
    top_a, bottom_a, top_b, bottom_b = -math.inf, math.inf, -math.inf, math.inf
    for k in range(len(a)):
        height = a[k, 0] * x + a[k, 1] * y + a[k, 2] * z
        top_a, bottom_a = max(top_a, height), min(bottom_a, height)
    for k in range(len(b)):
        height = b[k, 0] * x + b[k, 1] * y + b[k, 2] * z
        top_b, bottom_b = max(top_b, height), min(bottom_b, height)
    return max(bottom_b - top_a, bottom_a - top_b)


@numba.njit(cache=True)
def edges_of(meshes: Meshes, shape: int, corners: Floats) -> Floats:
    """Return the directions of the edges of a polyhedron with its vertices at `corners`, [edge_count, 3]."""
    start, end = meshes.edge_start[shape], meshes.edge_start[shape + 1]
    result = np.empty((end - start, 3))
    for e in range(start, end):
        result[e - start] = corners[meshes.edge[e, 1]] - corners[meshes.edge[e, 0]]
    return result


@numba.njit(cache=True)
def widest_gap(meshes: Meshes, one: int, two: int, a: Floats, b: Floats) -> float:
    """Return the largest gap over all directions that can part two polyhedra first [m]; negative: minus the depth."""
    if len(a) == 1 and len(b) == 1:
        return surface_distance(meshes, one, two, a, b)
    best = -math.inf
    for shape, corners in ((one, a), (two, b)):
        for t in range(meshes.triangle_start[shape], meshes.triangle_start[shape + 1]):
            i, j, k = meshes.triangle[t]
            best = max(best, gap_across(a, b, corners[j] - corners[i], corners[k] - corners[i]))
    ours, others = edges_of(meshes, one, a), edges_of(meshes, two, b)
    for e in range(len(ours)):
        for f in range(len(others)):
            best = max(best, gap_across(a, b, ours[e], others[f]))
    return best
