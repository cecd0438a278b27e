"""Where and how deep the two members of a pair touch."""

import numpy as np

from lithobrake.compiled import kernel
from lithobrake.dem.arrays import Bodies, Cores, Pairs, Planes
from lithobrake.dem.crossing import way_out
from lithobrake.dem.distance import APART, CROSSING, Search, approach, weighted
from lithobrake.dem.vectors import Vector, dot, minus, plus, put, row, scaled, times, transposed_times

# Number of points (0: apart), unit normal from first to second, lower bound of the gap where apart.
Touch = tuple[int, Vector, float]


@kernel
def touch_plane(bodies: Bodies, cores: Cores, planes: Planes, body: int, plane: int, search: Search) -> Touch:
    """Find all core vertices of a body that press on a plane; the normal points into the plane."""
    outward = row(planes.normal, plane)
    shape = bodies.shape[body]
    down = transposed_times(bodies.rotation, body, outward)
    rounding = cores.rounding[shape]
    level = planes.offset[plane] - dot(outward, row(bodies.position, body)) + rounding
    count, deepest = 0, -np.inf
    for k in range(cores.vertex_start[shape], cores.vertex_start[shape + 1]):
        corner = row(cores.vertex, k)
        overlap = level - dot(corner, down)
        deepest = max(deepest, overlap)
        if overlap > 0.0:
            foot = plus(row(bodies.position, body), times(bodies.rotation, body, corner))
            put(search.point, count, minus(foot, scaled(rounding - 0.5 * overlap, outward)))
            search.depth[count] = overlap
            count += 1
    return count, scaled(-1.0, outward), -deepest


@kernel
def touch_spheres(bodies: Bodies, first: int, second: int, apart: Vector, reach: float, search: Search) -> Touch:
    """Find how two bodies whose cores are points meet."""
    distance = dot(apart, apart) ** 0.5
    normal = scaled(1.0 / distance, apart) if distance > 0.0 else (0.0, 0.0, 1.0)
    middle = bodies.contact_radius[first] - 0.5 * (reach - distance)
    put(search.point, 0, plus(row(bodies.position, first), scaled(middle, normal)))
    search.depth[0] = reach - distance
    return (1 if distance < reach else 0), normal, distance - reach


@kernel
def touch_bodies(bodies: Bodies, cores: Cores, pairs: Pairs, pair: int, search: Search) -> Touch:
    """Find where two bodies meet, at their deepest point; the names of their closest features are kept in the pair for the next step."""
    first, second = pairs.first[pair], pairs.second[pair]
    shapes = (bodies.shape[first], bodies.shape[second])
    apart = minus(row(bodies.position, second), row(bodies.position, first))
    bound = bodies.bounding_radius[first] + bodies.bounding_radius[second]
    if dot(apart, apart) >= bound * bound:
        return 0, (0.0, 0.0, 1.0), dot(apart, apart) ** 0.5 - bound
    reach = cores.rounding[shapes[0]] + cores.rounding[shapes[1]]
    points = cores.face_start[shapes[0]] == cores.face_start[shapes[0] + 1]
    if points and cores.face_start[shapes[1]] == cores.face_start[shapes[1] + 1]:
        return touch_spheres(bodies, first, second, apart, reach, search)
    count = pairs.simplex[pair, 0]
    for k in range(count):
        search.names[k, 0], search.names[k, 1] = pairs.simplex[pair, 1 + k], pairs.simplex[pair, 4 + k]
    if count == 0:
        search.names[0, 0], search.names[0, 1], count = 0, 0, 1
    rotation, members = bodies.rotation, (first, second)
    found, count, bound = approach(search, count, cores, shapes, rotation, members, apart, reach)
    pairs.simplex[pair, 0] = min(count, 3)
    for k in range(pairs.simplex[pair, 0]):
        pairs.simplex[pair, 1 + k], pairs.simplex[pair, 4 + k] = search.names[k, 0], search.names[k, 1]
    if found == APART:
        return 0, (0.0, 0.0, 1.0), bound - reach
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
    put(search.point, 0, plus(row(bodies.position, first), middle))
    search.depth[0] = reach - distance
    return (1 if distance < reach else 0), normal, distance - reach
