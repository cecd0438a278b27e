"""Which features of a pair are near enough to touch before its motion has used up a margin.

Only names are kept; their distances are computed anew in each step (patch.py), and features that do not touch add
nothing. So it makes no difference to any bit when, or how often, the names are renewed.
"""

from lithobrake.compiled import kernel, large_kernel
from lithobrake.dem.arrays import Bodies, Cores, Pairs, Planes
from lithobrake.dem.closest import approach
from lithobrake.dem.distance import APART, CROSSING, Search, weighted
from lithobrake.dem.features import edge_of, edge_to_edge, lowest_height, point_to_core, write_relative
from lithobrake.dem.motion import top_speed
from lithobrake.dem.shares import SINK_TO
from lithobrake.dem.vectors import Vector, dot, minus, plus, row, scaled, times, transposed_times

# Kinds of features: a corner of the first on the second, of the second on the first (i, and one more than the number of
# the face below it, or 0), two edges (i and j), two spheres.
CORNER_OF_FIRST, CORNER_OF_SECOND, EDGES, SPHERES = 0, 1, 2, 3
KIND_BITS, PLACE_BITS = 40, 20
# Names that every pair has room for; few need more.
NEAR = 6
# In `term_count`: the cores cross, and all their features are looked at.
DEEP = -1
# The margin is this part of the rounding radii, which themselves count for at most this part of the contact radii.
MARGIN_OF_ROUNDING, ROUNDING_OF_RADIUS = 0.1, 0.04
# A pair in motion has a margin for about so many steps at its present speed, up to that part of the contact radii.
STEPS_LISTED = 24.0
# Share of a margin that is kept back: covers the round-off in summing travels.
BOUND_SLACK = 1e-6


@kernel
def travelled(bodies: Bodies, first: int, second: int) -> float:
    """Return a bound on how far the members of a pair have moved against each other so far."""
    return bodies.travel[first] + (bodies.travel[second] if second >= 0 else 0.0)


@kernel
def margin_of(bodies: Bodies, cores: Cores, first: int, second: int, time_step: float) -> float:
    """Return the motion [m] for which the list of a pair shall serve."""
    rounding, radius = cores.rounding[bodies.shape[first]], bodies.contact_radius[first]
    speed = top_speed(bodies, first)
    if second >= 0:
        rounding += cores.rounding[bodies.shape[second]]
        radius += bodies.contact_radius[second]
        speed += top_speed(bodies, second)
    most = ROUNDING_OF_RADIUS * radius
    return max(MARGIN_OF_ROUNDING * min(rounding, most), min(STEPS_LISTED * speed * time_step, most))


@large_kernel
def renew(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, search: Search, time_step: float, start: int, stop: int
) -> int:
    """Renew the lists of pairs start to stop whose margin is used up; return how many found too little room.

    Those are listed again at the next call.
    """
    lacking = 0
    for pair in range(start, stop):
        first, second = pairs.first[pair], pairs.second[pair]
        travel = travelled(bodies, first, second)
        if travel < pairs.wake[pair]:
            continue
        margin = margin_of(bodies, cores, first, second, time_step)
        if second < 0:
            serves = max(margin, list_plane(pair, bodies, cores, planes, pairs, margin))
        else:
            serves = list_bodies(pair, bodies, cores, pairs, margin, search)
        if pairs.term_count[pair] > room(pairs, pair):
            lacking += 1
        else:
            pairs.wake[pair] = travel + (1.0 - BOUND_SLACK) * serves
    return lacking


@kernel
def feature_name(kind: int, i: int, j: int) -> int:
    """Return the name of a feature."""
    return (kind << KIND_BITS) + (i << PLACE_BITS) + j


@kernel
def kind_of(name: int) -> int:
    """Return the kind of a feature."""
    return name >> KIND_BITS


@kernel
def places_of(name: int) -> tuple[int, int]:
    """Return i and j of a feature."""
    lowest = (1 << PLACE_BITS) - 1
    return (name >> PLACE_BITS) & lowest, name & lowest


@kernel
def note_term(pairs: Pairs, pair: int, kind: int, i: int, j: int) -> None:
    """Add a name to the list of a pair; the count goes on where the list is full."""
    count, name = pairs.term_count[pair], feature_name(kind, i, j)
    if count < room(pairs, pair):
        if count < NEAR:
            pairs.term[pair, count] = name
        else:
            pairs.rest[pairs.rest_row[pair], count - NEAR] = name
    pairs.term_count[pair] = count + 1


@kernel
def room(pairs: Pairs, pair: int) -> int:
    """Return how many names the list of a pair can hold."""
    return NEAR + pairs.rest.shape[1] if pairs.rest_row[pair] >= 0 else NEAR


@kernel
def name_of(pairs: Pairs, pair: int, k: int) -> int:
    """Return name k of the list of a pair."""
    return pairs.term[pair, k] if k < NEAR else pairs.rest[pairs.rest_row[pair], k - NEAR]


@kernel
def list_plane(pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, margin: float) -> float:
    """List the corners near a plane; return the gap."""
    body, plane = pairs.first[pair], -1 - pairs.second[pair]
    shape = bodies.shape[body]
    pairs.term_count[pair] = 0
    outward = row(planes.normal, plane)
    down = transposed_times(bodies.rotation, body, outward)
    level = dot(outward, row(bodies.position, body)) - planes.offset[plane] - cores.rounding[shape]
    start, end = cores.vertex_start[shape], cores.vertex_start[shape + 1]
    gap = level + dot(row(cores.vertex, start), down)
    for k in range(start, end):
        height = level + dot(row(cores.vertex, k), down)
        gap = min(gap, height)
        if height < margin:
            note_term(pairs, pair, CORNER_OF_FIRST, k - start, 0)
    return gap


@large_kernel
def list_bodies(pair: int, bodies: Bodies, cores: Cores, pairs: Pairs, margin: float, search: Search) -> float:
    """List the features of two bodies that are near each other; return the motion for which the list serves."""
    first, second = pairs.first[pair], pairs.second[pair]
    shapes, members = (bodies.shape[first], bodies.shape[second]), (first, second)
    pairs.term_count[pair] = 0
    apart = minus(row(bodies.position, second), row(bodies.position, first))
    bound = dot(apart, apart) ** 0.5 - bodies.bounding_radius[first] - bodies.bounding_radius[second]
    if bound >= margin:
        return bound
    reach = cores.rounding[shapes[0]] + cores.rounding[shapes[1]]
    if is_point(cores, shapes[0]) and is_point(cores, shapes[1]):
        note_term(pairs, pair, SPHERES, 0, 0)
        return margin
    found, count, bound = approach(search, cores, shapes, bodies.rotation, members, apart, reach + margin)
    if found == APART:
        return bound - reach
    hulls = not (is_point(cores, shapes[0]) or is_point(cores, shapes[1]))
    if found == CROSSING and hulls:
        # Until they are this far apart again, the listed features and all of them come to the same (patch.py).
        pairs.term_count[pair] = DEEP
        return (1.0 - SINK_TO) * reach
    write_relative(bodies.rotation, first, second, search.relative)
    there = transposed_times(bodies.rotation, first, apart)
    list_corners(pair, pairs, cores, shapes, search, there, reach + margin)
    if not hulls:
        return margin
    between = weighted(search.difference, search.weight, count)
    distance = dot(between, between) ** 0.5
    normal = transposed_times(bodies.rotation, first, scaled(-1.0 / distance, between))
    list_edges(pair, pairs, cores, shapes, search, there, normal, reach + margin)
    return min(margin, distance)


@kernel
def is_point(cores: Cores, shape: int) -> bool:
    """Whether a core is a point: the shape is a sphere."""
    return cores.face_start[shape] == cores.face_start[shape + 1]


@kernel
def list_corners(
    pair: int, pairs: Pairs, cores: Cores, shapes: tuple[int, int], search: Search, there: Vector, farthest: float
) -> None:
    """List the corners of either core that are nearer to the other than `farthest`."""
    if not is_point(cores, shapes[1]):
        start = cores.vertex_start[shapes[0]]
        for k in range(start, cores.vertex_start[shapes[0] + 1]):
            seen = transposed_times(search.relative, 0, minus(row(cores.vertex, k), there))
            _, _, near, face = point_to_core(cores, shapes[1], seen, farthest)
            if near:
                note_term(pairs, pair, CORNER_OF_FIRST, k - start, face + 1)
    if not is_point(cores, shapes[0]):
        start = cores.vertex_start[shapes[1]]
        for k in range(start, cores.vertex_start[shapes[1] + 1]):
            seen = plus(times(search.relative, 0, row(cores.vertex, k)), there)
            _, _, near, face = point_to_core(cores, shapes[0], seen, farthest)
            if near:
                note_term(pairs, pair, CORNER_OF_SECOND, k - start, face + 1)


@large_kernel
def list_edges(
    pair: int, pairs: Pairs, cores: Cores, shapes: tuple[int, int], search: Search, there: Vector, normal: Vector,
    farthest: float,
) -> None:  # fmt: skip
    """List the pairs of edges that are nearer than `farthest`; far ones fall out by their depth behind the gap."""
    turned = transposed_times(search.relative, 0, normal)
    top = -lowest_height(cores, shapes[0], scaled(-1.0, normal))
    bottom = lowest_height(cores, shapes[1], turned)
    # The gap along the normal at hand: it is the distance, but for rounding where cores all but touch.
    band = farthest - (bottom + dot(there, normal) - top)
    for i in range(cores.edge_start[shapes[0] + 1] - cores.edge_start[shapes[0]]):
        begin, along = edge_of(cores, shapes[0], i)
        height = dot(begin, normal)
        depth = top - max(height, height + dot(along, normal))
        if depth >= band:
            continue
        for j in range(cores.edge_start[shapes[1] + 1] - cores.edge_start[shapes[1]]):
            other, other_along = edge_of(cores, shapes[1], j)
            height = dot(other, turned)
            if depth + min(height, height + dot(other_along, turned)) - bottom >= band:
                continue
            other = plus(times(search.relative, 0, other), there)
            here, hither = edge_to_edge(begin, along, other, times(search.relative, 0, other_along))
            between = minus(hither, here)
            if dot(between, between) < farthest * farthest:
                note_term(pairs, pair, EDGES, i, j)
