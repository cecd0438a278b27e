"""The corners and pairs of edges of two cores that are nearer to each other than some distance."""

from typing import NamedTuple

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Cores, Floats, Pairs
from lithobrake.dem.bodies.vectors import Vector, dot, minus, plus, put, row, scaled, times, transposed_times
from lithobrake.dem.narrow_phase.feature_distance import edge_of, edge_to_edge, lowest_height, point_to_core
from lithobrake.dem.narrow_phase.feature_id import CORNER_OF_FIRST, CORNER_OF_SECOND, EDGES, add_feature
from lithobrake.dem.narrow_phase.scratch import TurnedFeatures


class Band(NamedTuple):
    """The space between two cores along a direction of the first's frame, and what is too far behind it."""

    normal: Vector  # of the first's frame, toward the second; 0: nothing is too far
    turned: Vector  # the same in the second's frame
    top: float  # m, of the first core along it, about its centroid
    bottom: float  # m, of the second core, about its own
    farthest: float  # m, of features that are wanted
    depth: float  # m: features deeper behind the gap than this, on both sides together, are farther apart than that


@kernel
def band_along(
    cores: Cores, relative: Floats, shapes: tuple[int, int], there: Vector, normal: Vector, farthest: float
) -> Band:
    """Return the gap of two cores along a normal, and what is near it."""
    turned = transposed_times(relative, 0, normal)
    top = -lowest_height(cores, shapes[0], scaled(-1.0, normal))
    bottom = lowest_height(cores, shapes[1], turned)
    return Band(normal, turned, top, bottom, farthest, farthest - (bottom + dot(there, normal) - top))


@kernel
def is_point(cores: Cores, shape: int) -> bool:
    """Whether a core is a point: the shape is a sphere."""
    return cores.face_start[shape] == cores.face_start[shape + 1]


@kernel
def list_corners(
    pair: int, cores: Cores, pairs: Pairs, relative: Floats, shapes: tuple[int, int], there: Vector, band: Band
) -> None:
    """List the corners of either core that are near enough to the other; far ones fall out by their depth.

    Writes to pairs.
    """
    if not is_point(cores, shapes[1]):
        start = cores.vertex_start[shapes[0]]
        for k in range(start, cores.vertex_start[shapes[0] + 1]):
            if band.top - dot(row(cores.vertex, k), band.normal) >= band.depth:
                continue
            seen = transposed_times(relative, 0, minus(row(cores.vertex, k), there))
            _, _, near, face = point_to_core(cores, shapes[1], seen, band.farthest)
            if near:
                add_feature(pair, pairs, CORNER_OF_FIRST, k - start, face + 1)
    if not is_point(cores, shapes[0]):
        start = cores.vertex_start[shapes[1]]
        for k in range(start, cores.vertex_start[shapes[1] + 1]):
            if dot(row(cores.vertex, k), band.turned) - band.bottom >= band.depth:
                continue
            seen = plus(times(relative, 0, row(cores.vertex, k)), there)
            _, _, near, face = point_to_core(cores, shapes[0], seen, band.farthest)
            if near:
                add_feature(pair, pairs, CORNER_OF_SECOND, k - start, face + 1)


@large_kernel
def list_edges(
    pair: int, cores: Cores, pairs: Pairs, turned: TurnedFeatures, relative: Floats, shapes: tuple[int, int],
    there: Vector, band: Band,
) -> None:  # fmt: skip
    """List the pairs of edges that are near enough: of those that reach into the band, whose parts in it may meet.

    Writes to pairs and turned.
    """
    near = edges_in_band(cores, turned, relative, shapes[1], there, band)
    for i in range(cores.edge_start[shapes[0] + 1] - cores.edge_start[shapes[0]]):
        begin, along = edge_of(cores, shapes[0], i)
        depth, climb = band.top - dot(begin, band.normal), -dot(along, band.normal)
        if min(depth, depth + climb) >= band.depth:
            continue
        low, high = box_in_band(begin, along, depth, climb, band.depth)
        for k in range(near):
            if beyond(low, row(turned.feature[:, 9:], k), band.farthest):
                continue
            if beyond(row(turned.feature[:, 6:], k), high, band.farthest):
                continue
            here, hither = edge_to_edge(begin, along, row(turned.feature, k), row(turned.feature[:, 3:], k))
            between = minus(hither, here)
            if dot(between, between) < band.farthest * band.farthest:
                add_feature(pair, pairs, EDGES, i, turned.edge[k])


@kernel
def edges_in_band(cores: Cores, turned: TurnedFeatures, relative: Floats, shape: int, there: Vector, band: Band) -> int:
    """Write begin, direction and box, in the first's frame, of the second's edges in the band; return their number.

    Writes to turned.
    """
    near = 0
    for j in range(cores.edge_start[shape + 1] - cores.edge_start[shape]):
        begin, along = edge_of(cores, shape, j)
        depth, climb = dot(begin, band.turned) - band.bottom, dot(along, band.turned)
        if min(depth, depth + climb) >= band.depth:
            continue
        begin, along = plus(times(relative, 0, begin), there), times(relative, 0, along)
        low, high = box_in_band(begin, along, depth, climb, band.depth)
        put(turned.feature, near, begin)
        put(turned.feature[:, 3:], near, along)
        put(turned.feature[:, 6:], near, low)
        put(turned.feature[:, 9:], near, high)
        turned.edge[near] = j
        near += 1
    return near


@kernel
def box_in_band(begin: Vector, along: Vector, depth: float, climb: float, deepest: float) -> tuple[Vector, Vector]:
    """Return the lowest and highest coordinates of the part of an edge that is less deep than the deepest.

    Its begin is at a depth, its end deeper by `climb`; one of them at least is less deep.
    """
    start = (deepest - depth) / climb if depth >= deepest else 0.0
    stop = (deepest - depth) / climb if depth + climb >= deepest else 1.0
    a, b = plus(begin, scaled(start, along)), plus(begin, scaled(stop, along))
    low = (min(a[0], b[0]), min(a[1], b[1]), min(a[2], b[2]))
    return low, (max(a[0], b[0]), max(a[1], b[1]), max(a[2], b[2]))


@kernel
def beyond(low: Vector, high: Vector, farthest: float) -> bool:
    """Whether lowest coordinates lie farther above highest ones, along any axis, than may be."""
    return low[0] - high[0] >= farthest or low[1] - high[1] >= farthest or low[2] - high[2] >= farthest
