"""The patch over which a pair touches: its points, and how they share one elastic energy.

The overlap of a feature is what is left of both rounding radii when its distance is taken off. The elastic energy of
the pair is Hertz', 2/5 K D^(5/2), with D a smooth maximum of these overlaps; every point carries the derivative of that
energy by its own overlap. So the forces come from one potential of the relative pose, move smoothly from corner to
corner, and hold a face by all of its corners.
"""

from lithobrake.compiled import kernel, large_kernel
from lithobrake.dem.arrays import Bodies, Cores, Pairs, Planes
from lithobrake.dem.crossing import way_out
from lithobrake.dem.distance import APART, CROSSING, Search, approach, weighted
from lithobrake.dem.features import edge_of, edge_to_edge, point_to_core, stands_above, write_relative
from lithobrake.dem.listing import CORNER_OF_FIRST, CORNER_OF_SECOND, DEEP, KIND, PLACE, SPHERES
from lithobrake.dem.vectors import Vector, dot, minus, plus, put, row, scaled, times, transposed_times

# Weight of a pair of edges beside a corner: where an edge ends, all edges of that corner meet the same place.
EDGE_WEIGHT = 0.25
EDGE_ALONE = EDGE_WEIGHT**0.125  # overlap of a patch of one pair of edges over theirs
# Between these parts of the rounding the patch narrows to its deepest point; the cores themselves stay apart till 1.
NARROW_FROM, NARROW_TO = 0.5, 0.9


@kernel
def note_point(search: Search, count: int, point: Vector, normal: Vector, depth: float, weight: float) -> int:
    """Add a point to the patch if it overlaps; return the number of points."""
    if depth <= 0.0:
        return count
    put(search.point, count, point)
    put(search.normal, count, normal)
    search.depth[count], search.weight_of_point[count] = depth, weight
    return count + 1


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
        corner = row(cores.vertex, cores.vertex_start[shape] + pairs.term[pair, k] // PLACE)
        depth = level - dot(corner, down)
        foot = plus(row(bodies.position, body), times(bodies.rotation, body, corner))
        count = note_point(search, count, minus(foot, scaled(rounding, outward)), inward, depth, 1.0)
    return count


@kernel
def touch_bodies(pair: int, bodies: Bodies, cores: Cores, pairs: Pairs, search: Search) -> int:
    """Write the points where two bodies touch. Returns their number."""
    first, second = pairs.first[pair], pairs.second[pair]
    apart = minus(row(bodies.position, second), row(bodies.position, first))
    if pairs.term_count[pair] == DEEP:
        return touch_deep(bodies, cores, first, second, apart, search)
    if pairs.term_count[pair] > 0 and pairs.term[pair, 0] // KIND == SPHERES:
        return touch_spheres(bodies, first, second, apart, search)
    shapes, count = (bodies.shape[first], bodies.shape[second]), 0
    reach = cores.rounding[shapes[0]] + cores.rounding[shapes[1]]
    half_difference = 0.5 * (cores.rounding[shapes[0]] - cores.rounding[shapes[1]])
    write_relative(bodies.rotation, first, second, search.relative)
    there = transposed_times(bodies.rotation, first, apart)
    for k in range(pairs.term_count[pair]):
        on_first, normal, distance = feature(pairs.term[pair, k], cores, shapes, search, there, reach)
        if distance < reach:
            middle = plus(on_first, scaled(0.5 * distance + half_difference, normal))
            point = plus(row(bodies.position, first), times(bodies.rotation, first, middle))
            weight = EDGE_WEIGHT if pairs.term[pair, k] // KIND > CORNER_OF_SECOND else 1.0
            normal = times(bodies.rotation, first, normal)
            count = note_point(search, count, point, normal, reach - distance, weight)
    return count


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
    return note_point(search, 0, middle, normal, depth, 1.0)


@large_kernel
def touch_deep(bodies: Bodies, cores: Cores, first: int, second: int, apart: Vector, search: Search) -> int:
    """Write the deepest point of two bodies whose cores cross."""
    shapes, members = (bodies.shape[first], bodies.shape[second]), (first, second)
    reach = cores.rounding[shapes[0]] + cores.rounding[shapes[1]]
    found, count, _ = approach(search, cores, shapes, bodies.rotation, members, apart, reach)
    if found == APART:
        return 0
    if found == CROSSING:
        distance, normal, on_first, on_second = way_out(search, cores, shapes, bodies.rotation, members, apart)
    else:
        on_first = weighted(search.on_first, search.weight, count)
        on_second = weighted(search.on_second, search.weight, count)
        between = minus(on_second, on_first)
        distance = dot(between, between) ** 0.5
        normal = scaled(1.0 / distance, between)
    half_difference = 0.5 * (cores.rounding[shapes[0]] - cores.rounding[shapes[1]])
    middle = plus(scaled(0.5, plus(on_first, on_second)), scaled(half_difference, normal))
    return note_point(search, 0, plus(row(bodies.position, first), middle), normal, reach - distance, 1.0)


@kernel
def spread(search: Search, count: int, rounding: float) -> tuple[float, Vector, Vector]:
    """Combine the overlaps of a patch into one, and write the share of each point in the force.

    D is the 8-norm of the weighted overlaps: one point is Hertz exactly, four or eight equal points are 1.5 or 1.9
    times as stiff. Toward overlaps as deep as the rounding, D passes into the deepest overlap alone. Returns D, the
    centre of pressure, and the unit normal of the whole force.
    """
    if count == 1:
        depth, share = search.depth[0], 1.0
        if search.weight_of_point[0] < 1.0:
            depth, narrowing, slope = narrowed(depth, EDGE_ALONE * depth, rounding)
            share = EDGE_ALONE + narrowing * (1.0 - EDGE_ALONE) + slope
        search.share[0] = share
        return depth, row(search.point, 0), row(search.normal, 0)
    top = 0
    for k in range(1, count):
        if search.depth[k] > search.depth[top]:
            top = k
    deepest, total = search.depth[top], 0.0
    for k in range(count):
        ratio = search.depth[k] / deepest
        fourth = ratio * ratio * ratio * ratio
        search.share[k] = search.weight_of_point[k] * fourth * ratio * ratio * ratio
        total += search.weight_of_point[k] * fourth * fourth
    root = ((total**0.5) ** 0.5) ** 0.5
    overlap, narrowing, slope = narrowed(deepest, deepest * root, rounding)
    centre, force, weight = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0
    for k in range(count):
        search.share[k] *= (1.0 - narrowing) * root / total
        if k == top:
            search.share[k] += narrowing
        centre = plus(centre, scaled(search.share[k], row(search.point, k)))
        force = plus(force, scaled(search.share[k], row(search.normal, k)))
        weight += search.share[k]
    search.share[top] += slope
    size = dot(force, force) ** 0.5
    return overlap, scaled(1.0 / weight, centre), scaled(1.0 / size, force)


@kernel
def narrowed(deepest: float, wide: float, rounding: float) -> tuple[float, float, float]:
    """Return the overlap between that of the wide patch and that of its deepest point, the weight of the latter, and
    what its change with depth adds to the deepest point's share.
    """
    progress = (deepest / rounding - NARROW_FROM) / (NARROW_TO - NARROW_FROM)
    if progress <= 0.0:
        return wide, 0.0, 0.0
    if progress >= 1.0:
        return deepest, 1.0, 0.0
    weight = progress * progress * (3.0 - 2.0 * progress)
    slope = 6.0 * progress * (1.0 - progress) / ((NARROW_TO - NARROW_FROM) * rounding)
    return wide + weight * (deepest - wide), weight, slope * (deepest - wide)


@kernel
def spin_radii(search: Search, count: int, centre: Vector, normal: Vector) -> tuple[float, float]:
    """Return mean squared and mean distance of a patch's force from the axis through its centre along the normal."""
    square, mean, weight = 0.0, 0.0, 0.0
    if count == 1:
        return 0.0, 0.0
    for k in range(count):
        arm = minus(row(search.point, k), centre)
        arm = minus(arm, scaled(dot(arm, normal), normal))
        share = max(search.share[k], 0.0)
        square += share * dot(arm, arm)
        mean += share * dot(arm, arm) ** 0.5
        weight += share
    return square / weight, mean / weight
