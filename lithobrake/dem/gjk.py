"""Distance of two convex cores, and the points where they come closest.

Source: Gilbert, Johnson and Keerthi (1988). Positions are relative to the first body's centroid, so that precision does
not depend on where in the world the pair stands. All tolerances are relative to the sizes met on the way.
"""

from typing import NamedTuple

import numpy as np

from lithobrake.compiled import kernel, large_kernel
from lithobrake.dem.arrays import Cores, Floats, Integers
from lithobrake.dem.simplex import simplex_weights
from lithobrake.dem.vectors import Vector, dot, minus, plus, put, row, scaled, times, transposed_times

# Squared distance still to be gained, over the squared distance, at which the search ends.
CONVERGED = 1e-14
# Distance over the size of the pair that may still be gained where the search cannot go on.
EXACT = 1e-13
# Distance over the size of the pair below which cores are taken as touching.
TOUCHING = 1e-13
ITERATIONS = 100

APART, CLOSE, PENETRATING, UNSURE = 0, 1, 2, 3


class Search(NamedTuple):
    """Scratch: a simplex while it is sought, the points of a contact."""

    on_first: Floats  # [4, 3]
    on_second: Floats  # [4, 3]
    difference: Floats  # [4, 3]
    vertex: Integers  # [4, 2]
    weight: Floats  # [4]
    steps: Integers  # [1], that the last search took
    turned: Floats  # [edge_count_max + vertex_count_max, 12], a core, or edges with their boxes, in the other's frame
    listed: Integers  # [edge_count_max + vertex_count_max], which edges these are
    relative: Floats  # [1, 3, 3]
    point: Floats  # [point_max, 3], of a patch
    normal: Floats  # [point_max, 3], from first to second
    couple: Floats  # [point_max, 3], of deep edges, see deep_edges.py
    depth: Floats  # [point_max], overlap at the point
    family: Integers  # [point_max]
    point_weight: Floats  # [point_max], derivative of the patch's overlap by that of the point


def search_for(feature_max: int, point_max: int) -> Search:
    """Return scratch large enough for the corners and edges of a core, and the points of a patch."""
    return Search(
        np.zeros((4, 3)), np.zeros((4, 3)), np.zeros((4, 3)), np.zeros((4, 2), dtype=np.int64), np.zeros(4),
        np.zeros(1, dtype=np.int64), np.zeros((feature_max, 12)), np.zeros(feature_max, dtype=np.int64),
        np.zeros((1, 3, 3)), np.zeros((point_max, 3)), np.zeros((point_max, 3)), np.zeros((point_max, 3)),
        np.zeros(point_max), np.zeros(point_max, dtype=np.int64), np.zeros(point_max),
    )  # fmt: skip


@kernel
def support(cores: Cores, shape: int, direction: Vector) -> int:
    """Return the core vertex of a shape that lies farthest along a direction of the body frame."""
    start, end = cores.vertex_start[shape], cores.vertex_start[shape + 1]
    best, farthest = start, dot(row(cores.vertex, start), direction)
    for k in range(start + 1, end):
        height = dot(row(cores.vertex, k), direction)
        if height > farthest:
            best, farthest = k, height
    return best - start


@kernel
def place_corner(
    search: Search, k: int, cores: Cores, shapes: tuple[int, int], rotation: Floats, bodies: tuple[int, int],
    apart: Vector,
) -> None:  # fmt: skip
    """Compute corner k of the simplex from its two vertices."""
    first = times(rotation, bodies[0], row(cores.vertex, cores.vertex_start[shapes[0]] + search.vertex[k, 0]))
    second = times(rotation, bodies[1], row(cores.vertex, cores.vertex_start[shapes[1]] + search.vertex[k, 1]))
    second = plus(second, apart)
    put(search.on_first, k, first)
    put(search.on_second, k, second)
    put(search.difference, k, minus(first, second))


@kernel
def weighted(array: Floats, weight: Floats, count: int) -> Vector:
    """Return the weighted sum of the first `count` rows."""
    total = scaled(weight[0], row(array, 0))
    for k in range(1, count):
        total = plus(total, scaled(weight[k], row(array, k)))
    return total


@kernel
def reduce_simplex(search: Search, count: int, closest_before: float) -> tuple[int, bool]:
    """Drop the corners that do not carry the closest point; refuse a step that comes no closer (second value False)."""
    d = search.difference
    a, b, c, e = row(d, 0), row(d, 1), row(d, 2), row(d, 3)
    weights = simplex_weights(count, a, b, c, e)
    point = plus(plus(scaled(weights[0], a), scaled(weights[1], b)), plus(scaled(weights[2], c), scaled(weights[3], e)))
    if closest_before >= 0.0 and dot(point, point) >= closest_before:
        return count - 1, False
    kept = 0
    for k in range(count):
        if weights[k] > 0.0:
            search.weight[kept] = weights[k]
            search.vertex[kept, 0], search.vertex[kept, 1] = search.vertex[k, 0], search.vertex[k, 1]
            put(search.on_first, kept, row(search.on_first, k))
            put(search.on_second, kept, row(search.on_second, k))
            put(d, kept, row(d, k))
            kept += 1
    return kept, True


@large_kernel
def closest_simplex(
    search: Search, cores: Cores, shapes: tuple[int, int], rotation: Floats, bodies: tuple[int, int], apart: Vector,
    margin: float,
) -> tuple[int, int, float]:  # fmt: skip
    """Search for the simplex of differences that carries the closest points of the cores.

    Returns what was found (APART: farther than the margin; CLOSE: points in `search`; CROSSING; UNSURE: rounding ended
    the search without proof), the number of corners, and a lower bound of the distance where they are apart.
    """
    search.vertex[0, 0], search.vertex[0, 1] = 0, 0
    place_corner(search, 0, cores, shapes, rotation, bodies, apart)
    count, _ = reduce_simplex(search, 1, -1.0)
    for step in range(ITERATIONS):
        search.steps[0] = step + 1
        closest = weighted(search.difference, search.weight, count)
        square, size = dot(closest, closest), largest(search.difference, count)
        if square <= TOUCHING * TOUCHING * size:
            return PENETRATING, count, 0.0
        if count == 4:
            return UNSURE, count, 0.0
        backward = scaled(-1.0, closest)
        search.vertex[count, 0] = support(cores, shapes[0], transposed_times(rotation, bodies[0], backward))
        search.vertex[count, 1] = support(cores, shapes[1], transposed_times(rotation, bodies[1], closest))
        corner = find_corner(search, count)
        if corner == count:
            place_corner(search, count, cores, shapes, rotation, bodies, apart)
        bound = dot(closest, row(search.difference, corner))
        if bound > 0.0 and bound * bound > margin * margin * square:
            return APART, count, bound / square**0.5
        if square - bound <= CONVERGED * square:
            return CLOSE, count, 0.0
        closer = False
        if corner == count:
            count, closer = reduce_simplex(search, count + 1, square)
        if not closer:
            # Rounding leaves no way to go on: what is missing yet counts by the size, as rounding does.
            gain = (square - bound) / square**0.5
            return CLOSE if gain <= EXACT * size**0.5 else UNSURE, count, 0.0
    return UNSURE, count, 0.0


@kernel
def find_corner(search: Search, count: int) -> int:
    """Return which corner has the same vertices as the one after the first `count`: that one, if no other has."""
    for k in range(count):
        if search.vertex[k, 0] == search.vertex[count, 0] and search.vertex[k, 1] == search.vertex[count, 1]:
            return k
    return count


@kernel
def largest(array: Floats, count: int) -> float:
    """Return the largest square of the first `count` rows."""
    square = 0.0
    for k in range(count):
        square = max(square, dot(row(array, k), row(array, k)))
    return square
