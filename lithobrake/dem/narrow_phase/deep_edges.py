"""Pairs of edges of cores that may penetrate each other.

The distance of two edges cannot change its sign, but that of a point to a core can. So a pair of edges is taken by the
points where the two come closest, each against the other's core: overlaps a and b are what is left of both rounding
radii when the signed distances of these points are taken off, and the overlap of the pair is their smooth minimum d,
1/d^4 = (1/a^4 + 1/b^4) / 2. While the cores are apart and each edge is the closest feature to the other, this is what
the distance of the edges leaves.
"""

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Cores, Floats
from lithobrake.dem.bodies.vectors import Vector, cross, dot, minus, plus, put, scaled, times, transposed_times
from lithobrake.dem.narrow_phase.feature_distance import closest_fractions, edge_of, lowest_height, point_to_core
from lithobrake.dem.narrow_phase.patch_energy import DEEP_EDGES, add_point
from lithobrake.dem.narrow_phase.scratch import Patch


@large_kernel
def add_deep_edges(
    cores: Cores, patch: Patch, relative: Floats, count: int, shapes: tuple[int, int], there: Vector
) -> int:
    """Add all pairs of edges that overlap to the patch, in the first body's frame; return the number of points.

    Writes to patch.
    """
    reach = cores.rounding[shapes[0]] + cores.rounding[shapes[1]]
    size = dot(there, there) ** 0.5
    along = scaled(1.0 / size, there) if size > 0.0 else (0.0, 0.0, 1.0)
    turned = transposed_times(relative, 0, along)
    # No point of the first core stands higher than this along the line of centres, none of the second lower.
    top = -lowest_height(cores, shapes[0], scaled(-1.0, along)) + reach
    bottom = lowest_height(cores, shapes[1], turned) - reach
    for i in range(cores.edge_start[shapes[0] + 1] - cores.edge_start[shapes[0]]):
        begin, u = edge_of(cores, shapes[0], i)
        height = dot(begin, along)
        if max(height, height + dot(u, along)) < bottom + dot(there, along):
            continue
        for j in range(cores.edge_start[shapes[1] + 1] - cores.edge_start[shapes[1]]):
            other, v = edge_of(cores, shapes[1], j)
            height = dot(other, turned) + dot(there, along)
            if min(height, height + dot(v, turned)) <= top:
                other, v = plus(times(relative, 0, other), there), times(relative, 0, v)
                count = add_deep_edge_pair(cores, patch, relative, count, shapes, there, reach, (begin, u), (other, v))
    return count


@large_kernel
def add_deep_edge_pair(
    cores: Cores, patch: Patch, relative: Floats, count: int, shapes: tuple[int, int], there: Vector, reach: float,
    first: tuple[Vector, Vector], second: tuple[Vector, Vector],
) -> int:  # fmt: skip
    """Add a pair of edges (begin and direction each) to the patch if it overlaps; return the number of points.

    As the second body moves by v (at the point) and turns by w against the first, the overlap falls by the mean of
    normal . v + couple . w over the two points. Writes to patch.
    """
    fraction, other_fraction, parallel = closest_fractions(first[0], first[1], second[0], second[1])
    here, hither = plus(first[0], scaled(fraction, first[1])), plus(second[0], scaled(other_fraction, second[1]))
    distance, outward, near, _ = point_to_core(cores, shapes[0], hither, reach)
    if not near:
        return count
    seen = transposed_times(relative, 0, minus(here, there))
    other_distance, inward, near, _ = point_to_core(cores, shapes[1], seen, reach)
    if not near:
        return count
    inward = times(relative, 0, inward)
    free, other_free = 0.0 < fraction < 1.0 and not parallel, 0.0 < other_fraction < 1.0 and not parallel
    between = minus(hither, here)
    overlap, gain, other_gain = smooth_minimum(reach - distance, reach - other_distance)
    half_difference = 0.5 * (cores.rounding[shapes[0]] - cores.rounding[shapes[1]])

    normal, couple = sliding(first[1], second[1], between, outward, free, other_free)
    point = plus(hither, scaled(half_difference - 0.5 * distance, normal))
    put(patch.couple, count, scaled(gain, couple))
    count = add_point(patch, count, DEEP_EDGES, overlap, point, scaled(gain, normal))

    normal, couple = sliding(second[1], first[1], scaled(-1.0, between), inward, other_free, free)
    point = minus(here, scaled(half_difference + 0.5 * other_distance, normal))
    put(patch.couple, count, scaled(-other_gain, couple))
    return add_point(patch, count, DEEP_EDGES, overlap, point, scaled(-other_gain, normal))


@kernel
def smooth_minimum(a: float, b: float) -> tuple[float, float, float]:
    """Return a smooth minimum of two positive overlaps, and twice its derivatives: the pair stands for two points."""
    least = min(a, b)
    ratio, other = least / a, least / b
    total = 0.5 * (ratio * ratio * ratio * ratio + other * other * other * other)
    overlap = least / (total**0.5) ** 0.5
    return overlap, (overlap / a) ** 5, (overlap / b) ** 5


@kernel
def sliding(
    u: Vector, v: Vector, between: Vector, outward: Vector, u_free: bool, v_free: bool
) -> tuple[Vector, Vector]:
    """Return how the height of the closest point on edge v over a face of u's core grows: normal and couple.

    The point slides along v as the edges move; it rises by normal . (motion of v's body there) + couple . (its turn).
    `between` leads from the closest point of u to that of v, `outward` is the unit normal of the face. An edge is free
    where its closest point is none of its ends.
    """
    if not v_free:
        return outward, (0.0, 0.0, 0.0)
    rise = dot(outward, v)
    if not u_free:
        rise /= dot(v, v)
        return minus(outward, scaled(rise, v)), scaled(-rise, cross(v, between))
    normal = cross(u, v)
    square = dot(normal, normal)
    # Derived: across = u x m and m = u x v / |u x v| keep v's closest point above u while both turn.
    across = scaled(1.0 / square, cross(u, normal))
    gap = dot(between, normal) / square
    couple = plus(scaled(dot(u, v), across), u)
    return plus(outward, scaled(rise, across)), scaled(-rise * gap, couple)
