"""Which features of a pair are near enough to touch before its motion has used up a margin."""

from typing import NamedTuple

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import (
    Bodies,
    Cores,
    Pairs,
    Planes,
    both_roundings,
    both_shapes,
    contact_radii,
    first_shape,
)
from lithobrake.dem.bodies.motion import surface_speed_bound
from lithobrake.dem.bodies.vectors import dot, minus, plus, put, row, scaled, times, transposed_times, way_between
from lithobrake.dem.narrow_phase.feature_distance import (
    ALL_FEATURES,
    CORNER_OF_FIRST,
    CORNER_OF_SECOND,
    EDGES,
    SPHERES,
    add_feature,
    edge_of,
    edge_to_edge,
    feature_capacity,
    lowest_height,
    point_to_core,
    write_relative,
)
from lithobrake.dem.narrow_phase.gjk import APART, CLOSE, PENETRATING, weighted
from lithobrake.dem.narrow_phase.patch_energy import DEEP_TO
from lithobrake.dem.narrow_phase.penetration import find_closest_points
from lithobrake.dem.narrow_phase.scratch import Scratch, Simplex, TurnedFeatures
from lithobrake.vocabulary.array_types import Floats, Vector

# The margin is this part of the rounding radii, which themselves count for at most this part of the contact radii.
MARGIN_OF_ROUNDING, ROUNDING_OF_RADIUS = 0.1, 0.04
# A pair in motion has a margin for about so many steps at its present speed, up to that part of the contact radii.
STEPS_LISTED = 24.0
# Part of a margin that is kept back: covers the round-off in summing travels.
BOUND_SLACK = 1e-6


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
        # Only the part of an edge in the band can be near enough, and its small box leaves few pairs to measure.
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
    # At most one end is too deep, so where `climb` divides it is not 0.
    start = (deepest - depth) / climb if depth >= deepest else 0.0
    stop = (deepest - depth) / climb if depth + climb >= deepest else 1.0
    a, b = plus(begin, scaled(start, along)), plus(begin, scaled(stop, along))
    low = (min(a[0], b[0]), min(a[1], b[1]), min(a[2], b[2]))
    return low, (max(a[0], b[0]), max(a[1], b[1]), max(a[2], b[2]))


@kernel
def beyond(low: Vector, high: Vector, farthest: float) -> bool:
    """Whether lowest coordinates lie farther above highest ones, along any axis, than may be."""
    return low[0] - high[0] >= farthest or low[1] - high[1] >= farthest or low[2] - high[2] >= farthest


@kernel
def travelled(bodies: Bodies, first: int, second: int) -> float:
    """Return a bound on how far the members of a pair have moved against each other so far."""
    return bodies.travel[first] + (bodies.travel[second] if second >= 0 else 0.0)


@kernel
def list_margin(pair: int, bodies: Bodies, cores: Cores, pairs: Pairs, time_step: float) -> float:
    """Return the motion [m] for which the list of a pair shall serve."""
    rounding = cores.rounding[first_shape(pair, bodies, pairs)]
    speed = surface_speed_bound(bodies, pairs.first[pair])
    if pairs.second[pair] >= 0:
        rounding += cores.rounding[bodies.shape[pairs.second_part[pair]]]
        speed += surface_speed_bound(bodies, pairs.second[pair])
    most = ROUNDING_OF_RADIUS * contact_radii(pair, bodies, pairs)
    return max(MARGIN_OF_ROUNDING * min(rounding, most), min(STEPS_LISTED * speed * time_step, most))


@kernel
def renew_list(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, scratch: Scratch, margin: float,
    travel: float,
) -> bool:  # fmt: skip
    """List the features of a pair within a margin [m], to serve from a travel [m] on; tell whether there was room.

    Writes to pairs and scratch.
    """
    if pairs.second[pair] < 0:
        serves = max(margin, list_plane(pair, bodies, cores, planes, pairs, margin))
    else:
        serves = list_bodies(pair, bodies, cores, pairs, scratch.simplex, scratch.turned, scratch.relative, margin)
    if pairs.feature_count[pair] > feature_capacity(pair, pairs):
        return False
    pairs.wake[pair] = travel + (1.0 - BOUND_SLACK) * serves
    return True


@large_kernel
def update_feature_lists(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, scratch: Scratch, time_step: float, start: int,
    stop: int,
) -> int:  # fmt: skip
    """Renew the lists of pairs start to stop whose margin is used up; return how many found too little room.

    Those are listed again at the next call. Writes to pairs and scratch.
    """
    lacking = 0
    for pair in range(start, stop):
        travel = travelled(bodies, pairs.first[pair], pairs.second[pair])
        if travel < pairs.wake[pair]:
            continue
        margin = list_margin(pair, bodies, cores, pairs, time_step)
        if not renew_list(pair, bodies, cores, planes, pairs, scratch, margin, travel):
            lacking += 1
    return lacking


@kernel
def list_plane(pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, margin: float) -> float:
    """List the corners near a plane; return the gap. Writes to pairs."""
    body, plane = pairs.first[pair], -1 - pairs.second[pair]
    shape = first_shape(pair, bodies, pairs)
    pairs.feature_count[pair] = 0
    outward = row(planes.normal, plane)
    down = transposed_times(bodies.rotation, body, outward)
    level = dot(outward, row(bodies.position, body)) - planes.offset[plane] - cores.rounding[shape]
    start, end = cores.vertex_start[shape], cores.vertex_start[shape + 1]
    gap = level + dot(row(cores.vertex, start), down)
    for k in range(start, end):
        height = level + dot(row(cores.vertex, k), down)
        gap = min(gap, height)
        if height < margin:
            add_feature(pair, pairs, CORNER_OF_FIRST, k - start, 0)
    return gap


@kernel
def closest_approach(simplex: Simplex, found: int, count: int) -> tuple[float, Vector]:
    """Return distance and direction, first to second, of the closest points of two cores; zero where they cross."""
    between = weighted(simplex.difference, simplex.weight, count) if found == CLOSE else (0.0, 0.0, 0.0)
    distance = dot(between, between) ** 0.5
    return distance, scaled(-1.0 / distance, between) if distance > 0.0 else between


@large_kernel
def list_bodies(
    pair: int, bodies: Bodies, cores: Cores, pairs: Pairs, simplex: Simplex, turned: TurnedFeatures, relative: Floats,
    margin: float,
) -> float:  # fmt: skip
    """List the features of two bodies that are near each other; return the motion for which the list serves.

    Writes to pairs, simplex, turned and relative.
    """
    first, second = pairs.first[pair], pairs.second[pair]
    shapes, members = both_shapes(pair, bodies, pairs), (first, second)
    pairs.feature_count[pair] = 0
    apart = way_between(bodies, first, second)
    bound = dot(apart, apart) ** 0.5 - bodies.bounding_radius[first] - bodies.bounding_radius[second]
    # Bounding spheres that far apart prove as much as a search would, at a fraction of the cost.
    if bound >= margin:
        return bound
    reach = both_roundings(cores, shapes)
    if is_point(cores, shapes[0]) and is_point(cores, shapes[1]):
        add_feature(pair, pairs, SPHERES, 0, 0)
        return margin
    found, count, bound = find_closest_points(
        cores, simplex, turned, relative, shapes, bodies.rotation, members, apart, reach + margin
    )
    if found == APART:
        return bound - reach
    hulls = not (is_point(cores, shapes[0]) or is_point(cores, shapes[1]))
    if found == PENETRATING and hulls:
        # Until they are this far apart again, the listed features and all of them come to the same (contact_patch.py).
        pairs.feature_count[pair] = ALL_FEATURES
        return (1.0 - DEEP_TO) * reach
    write_relative(bodies.rotation, first, second, relative)
    there = transposed_times(bodies.rotation, first, apart)
    distance, direction = closest_approach(simplex, found, count)
    axis = transposed_times(bodies.rotation, first, direction)
    band = band_along(cores, relative, shapes, there, axis, reach + margin)
    list_corners(pair, cores, pairs, relative, shapes, there, band)
    if not hulls:
        return margin
    list_edges(pair, cores, pairs, turned, relative, shapes, there, band)
    # Once the bodies have moved by the distance of their cores these may cross, and all features count.
    return min(margin, distance)
