"""The points where the members of a pair touch.

The overlap of a feature is what is left of both rounding radii when its distance is taken off (for shares.py). Cores
that cross go on so: the distance of a corner changes its sign, and pairs of edges have by then passed into sunk ones.
"""

from lithobrake.compiled import kernel, large_kernel
from lithobrake.dem.arrays import Bodies, Cores, Pairs, Planes
from lithobrake.dem.closest import approach, way_out
from lithobrake.dem.distance import CROSSING, Search
from lithobrake.dem.features import edge_of, edge_to_edge, point_to_core, stands_above, write_relative
from lithobrake.dem.listing import CORNER_OF_FIRST, CORNER_OF_SECOND, DEEP, KIND, PLACE, SPHERES, name_of
from lithobrake.dem.shares import CORNER, EDGES_APART, SINK_FROM, WAY_OUT, note_point, sinking
from lithobrake.dem.sunk import note_sunk_edges
from lithobrake.dem.vectors import Vector, dot, minus, plus, put, row, scaled, times, transposed_times


@kernel
def touch_plane(pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, search: Search) -> int:
    """Write the points where a body presses on a plane; the normal points into the plane. Returns their number.

    The force acts on the surface of the body as if it were not dented, so that a ball rolls with its own radius.
    """
    body, plane = pairs.first[pair], -1 - pairs.second[pair]
    outward, shape, count = row(planes.normal, plane), bodies.shape[body], 0
    inward, rounding = scaled(-1.0, outward), cores.rounding[shape]
    down = transposed_times(bodies.rotation, body, outward)
    level = planes.offset[plane] + rounding - dot(outward, row(bodies.position, body))
    for k in range(pairs.term_count[pair]):
        corner = row(cores.vertex, cores.vertex_start[shape] + name_of(pairs, pair, k) // PLACE)
        depth = level - dot(corner, down)
        foot = plus(row(bodies.position, body), times(bodies.rotation, body, corner))
        point = minus(foot, scaled(rounding, outward))
        count = note_point(search, count, CORNER, depth, point, inward)
    return count


@kernel
def touch_bodies(pair: int, bodies: Bodies, cores: Cores, pairs: Pairs, search: Search) -> tuple[int, float, float]:
    """Write the points where two bodies touch. Returns their number, and what `spread` needs to know of edges."""
    first, second = pairs.first[pair], pairs.second[pair]
    apart = minus(row(bodies.position, second), row(bodies.position, first))
    if pairs.term_count[pair] > 0 and pairs.term[pair, 0] // KIND == SPHERES:
        return touch_spheres(bodies, first, second, apart, search), 0.0, 0.0
    shapes = (bodies.shape[first], bodies.shape[second])
    write_relative(bodies.rotation, first, second, search.relative)
    there = transposed_times(bodies.rotation, first, apart)
    crossing = pairs.term_count[pair] == DEEP
    if crossing:
        count, sunk, slope = note_all_corners(search, bodies, cores, first, second, there), 1.0, 0.0
    else:
        count, sunk, slope = note_listed(search, pairs, pair, bodies, cores, there)
    if sunk > 0.0:
        apart_count, count = count, note_sunk_edges(search, count, cores, shapes, there)
        for k in range(apart_count, count):
            put(search.point, k, plus(row(bodies.position, first), times(bodies.rotation, first, row(search.point, k))))
            put(search.normal, k, times(bodies.rotation, first, row(search.normal, k)))
            put(search.couple, k, times(bodies.rotation, first, row(search.couple, k)))
    if crossing:
        count = note_way_out(search, count, bodies, cores, first, second, apart)
    return count, sunk, slope


@large_kernel
def note_way_out(
    search: Search, count: int, bodies: Bodies, cores: Cores, first: int, second: int, apart: Vector
) -> int:
    """Add the point at the shortest way out, if the cores still cross; return the number of points.

    Its overlap is the depth of the cores and both roundings. It keeps two flat bars apart of which no corner lies in
    the other: the points at which their edges meet stay on the sides of both, however deep they are. And it pushes out
    the sharp edge through whose far side another has come, where the nearest points of both edges draw inward.
    """
    shapes, members = (bodies.shape[first], bodies.shape[second]), (first, second)
    found, _, _ = approach(search, cores, shapes, bodies.rotation, members, apart, 0.0)
    if found != CROSSING:
        return count
    distance, normal, on_first, on_second = way_out(search, cores, shapes, bodies.rotation, members, apart)
    half_difference = 0.5 * (cores.rounding[shapes[0]] - cores.rounding[shapes[1]])
    middle = plus(scaled(0.5, plus(on_first, on_second)), scaled(half_difference, normal))
    point = plus(row(bodies.position, first), middle)
    reach = cores.rounding[shapes[0]] + cores.rounding[shapes[1]]
    return note_point(search, count, WAY_OUT, reach - distance, point, normal)


@kernel
def note_listed(
    search: Search, pairs: Pairs, pair: int, bodies: Bodies, cores: Cores, there: Vector
) -> tuple[int, float, float]:
    """Write the listed features that overlap; return their number, how far edges have passed into sunk ones, and the
    derivative of that by the deepest overlap (1/m).
    """
    first, second = pairs.first[pair], pairs.second[pair]
    count, corners, deepest = 0, 0, 0.0
    for k in range(pairs.term_count[pair]):
        name = name_of(pairs, pair, k)
        count = note_feature(search, count, bodies, cores, first, second, there, name)
        # Corners are listed before edges.
        if name // KIND <= CORNER_OF_SECOND:
            corners = count
    for k in range(count):
        deepest = max(deepest, search.depth[k])
    reach = cores.rounding[bodies.shape[first]] + cores.rounding[bodies.shape[second]]
    if deepest <= SINK_FROM * reach:
        return count, 0.0, 0.0
    sunk, slope = sinking(deepest / reach)
    return corners if sunk == 1.0 else count, sunk, slope / reach


@large_kernel
def note_all_corners(search: Search, bodies: Bodies, cores: Cores, first: int, second: int, there: Vector) -> int:
    """Write all corners of two bodies that overlap; return their number."""
    count = 0
    for kind in range(2):
        shape = bodies.shape[first if kind == 0 else second]
        for k in range(cores.vertex_start[shape + 1] - cores.vertex_start[shape]):
            term = kind * KIND + k * PLACE
            count = note_feature(search, count, bodies, cores, first, second, there, term)
    return count


@kernel
def note_feature(
    search: Search, count: int, bodies: Bodies, cores: Cores, first: int, second: int, there: Vector, term: int
) -> int:
    """Add a feature to the patch if it overlaps; return the number of points."""
    shapes = (bodies.shape[first], bodies.shape[second])
    reach = cores.rounding[shapes[0]] + cores.rounding[shapes[1]]
    half_difference = 0.5 * (cores.rounding[shapes[0]] - cores.rounding[shapes[1]])
    on_first, normal, distance = feature(term, cores, shapes, search, there, reach)
    if distance >= reach:
        return count
    middle = plus(on_first, scaled(0.5 * distance + half_difference, normal))
    point = plus(row(bodies.position, first), times(bodies.rotation, first, middle))
    family = CORNER if term // KIND <= CORNER_OF_SECOND else EDGES_APART
    return note_point(search, count, family, reach - distance, point, times(bodies.rotation, first, normal))


@kernel
def feature(
    term: int, cores: Cores, shapes: tuple[int, int], search: Search, there: Vector, reach: float
) -> tuple[Vector, Vector, float]:
    """Return point on the first core, normal to the second and distance of a feature, in the first body's frame."""
    kind, i, j = term // KIND, term % KIND // PLACE, term % PLACE
    if kind == CORNER_OF_FIRST:
        corner = row(cores.vertex, cores.vertex_start[shapes[0]] + i)
        seen = transposed_times(search.relative, 0, minus(corner, there))
        distance, outward = over(cores, shapes[1], seen, j - 1, reach)
        return corner, scaled(-1.0, times(search.relative, 0, outward)), distance
    if kind == CORNER_OF_SECOND:
        corner = plus(times(search.relative, 0, row(cores.vertex, cores.vertex_start[shapes[1]] + i)), there)
        distance, outward = over(cores, shapes[0], corner, j - 1, reach)
        return minus(corner, scaled(distance, outward)), outward, distance
    begin, along = edge_of(cores, shapes[0], i)
    other, other_along = edge_of(cores, shapes[1], j)
    other = plus(times(search.relative, 0, other), there)
    here, hither = edge_to_edge(begin, along, other, times(search.relative, 0, other_along))
    between = minus(hither, here)
    square = dot(between, between)
    if square >= reach * reach:
        return here, between, reach
    distance = square**0.5
    return here, scaled(1.0 / distance, between) if distance > 0.0 else between, distance


@kernel
def over(cores: Cores, shape: int, point: Vector, face: int, reach: float) -> tuple[float, Vector]:
    """Return distance (at most `reach`) and normal of a point over a core that stood over `face` when last listed.

    Where it still does, nothing else can be closer; if not, all of the core is searched, with the same result.
    """
    if face >= 0:
        height, closest = stands_above(cores, shape, face, point)
        if closest:
            return min(height, reach), row(cores.normal, cores.face_start[shape] + face)
    distance, normal, near, _ = point_to_core(cores, shape, point, reach)
    return distance if near else reach, normal


@kernel
def touch_spheres(bodies: Bodies, first: int, second: int, apart: Vector, search: Search) -> int:
    """Write the point where two spheres touch."""
    distance = dot(apart, apart) ** 0.5
    depth = bodies.contact_radius[first] + bodies.contact_radius[second] - distance
    # Spheres about one centre: every normal is as good as another.
    normal = scaled(1.0 / distance, apart) if distance > 0.0 else (0.0, 0.0, 1.0)
    middle = plus(row(bodies.position, first), scaled(bodies.contact_radius[first] - 0.5 * depth, normal))
    return note_point(search, 0, CORNER, depth, middle, normal)
