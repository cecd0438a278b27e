"""Where and how deep the two members of a pair touch."""

from lithobrake.compiled import kernel
from lithobrake.dem.arrays import Bodies, Cores, Pairs, Planes
from lithobrake.dem.crossing import way_out
from lithobrake.dem.distance import APART, CROSSING, Search, approach, weighted
from lithobrake.dem.vectors import Vector, dot, minus, plus, row, scaled, times, transposed_times

# Overlap (not positive where apart), unit normal from first to second, contact point.
Touch = tuple[float, Vector, Vector]


@kernel
def touch_plane(bodies: Bodies, cores: Cores, planes: Planes, body: int, plane: int) -> Touch:
    """Return how the deepest core vertex of a body meets a plane; the normal points into the plane."""
    outward = row(planes.normal, plane)
    shape = bodies.shape[body]
    down = transposed_times(bodies.rotation, body, outward)
    lowest, height = 0.0, 0.0
    deepest = cores.vertex_start[shape]
    height = dot(row(cores.vertex, deepest), down)
    for k in range(deepest + 1, cores.vertex_start[shape + 1]):
        lowest = dot(row(cores.vertex, k), down)
        if lowest < height:
            deepest, height = k, lowest
    corner = plus(row(bodies.position, body), times(bodies.rotation, body, row(cores.vertex, deepest)))
    overlap = cores.rounding[shape] + planes.offset[plane] - dot(outward, corner)
    point = minus(corner, scaled(cores.rounding[shape] - 0.5 * overlap, outward))
    return overlap, scaled(-1.0, outward), point


@kernel
def touch_spheres(bodies: Bodies, first: int, second: int, apart: Vector, reach: float) -> Touch:
    """Return how two bodies whose cores are points meet."""
    distance = dot(apart, apart) ** 0.5
    normal = scaled(1.0 / distance, apart) if distance > 0.0 else (0.0, 0.0, 1.0)
    middle = bodies.contact_radius[first] - 0.5 * (reach - distance)
    return reach - distance, normal, plus(row(bodies.position, first), scaled(middle, normal))


@kernel
def touch_bodies(bodies: Bodies, cores: Cores, pairs: Pairs, pair: int, search: Search) -> Touch:
    """Return how two bodies meet; the names of their closest features are kept in the pair for the next step."""
    first, second = pairs.first[pair], pairs.second[pair]
    shapes = (bodies.shape[first], bodies.shape[second])
    apart = minus(row(bodies.position, second), row(bodies.position, first))
    nothing = (0.0, (0.0, 0.0, 1.0), row(bodies.position, first))
    bound = bodies.bounding_radius[first] + bodies.bounding_radius[second]
    if dot(apart, apart) >= bound * bound:
        return nothing
    reach = cores.rounding[shapes[0]] + cores.rounding[shapes[1]]
    points = cores.face_start[shapes[0]] == cores.face_start[shapes[0] + 1]
    if points and cores.face_start[shapes[1]] == cores.face_start[shapes[1] + 1]:
        return touch_spheres(bodies, first, second, apart, reach)
    count = pairs.simplex[pair, 0]
    for k in range(count):
        search.names[k, 0], search.names[k, 1] = pairs.simplex[pair, 1 + k], pairs.simplex[pair, 4 + k]
    if count == 0:
        search.names[0, 0], search.names[0, 1], count = 0, 0, 1
    rotation, members = bodies.rotation, (first, second)
    found, count = approach(search, count, cores, shapes, rotation, members, apart, reach)
    pairs.simplex[pair, 0] = min(count, 3)
    for k in range(pairs.simplex[pair, 0]):
        pairs.simplex[pair, 1 + k], pairs.simplex[pair, 4 + k] = search.names[k, 0], search.names[k, 1]
    if found == APART:
        return nothing
    if found == CROSSING:
        distance, normal, on_first, on_second = way_out(search, cores, shapes, rotation, members, apart)
    else:
        on_first = weighted(search.on_first, search.weight, count)
        on_second = weighted(search.on_second, search.weight, count)
        between = minus(on_second, on_first)
        distance = dot(between, between) ** 0.5
        normal = scaled(1.0 / distance, between)
    half_gap = 0.5 * (cores.rounding[shapes[0]] - cores.rounding[shapes[1]])
    middle = plus(scaled(0.5, plus(on_first, on_second)), scaled(half_gap, normal))
    return reach - distance, normal, plus(row(bodies.position, first), middle)
