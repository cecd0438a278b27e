"""Signed distance of two cores that cross: the shortest way out, over all faces and edge pairs.

The way out of a convex difference set leads through one of its faces, and these are the faces of either core and the
edge pairs whose arcs on the sphere of normals intersect. Source: Gregorius, "The separating axis test" (2013).
"""

from lithobrake.compiled import kernel, large_kernel
from lithobrake.dem.arrays import Cores, Floats
from lithobrake.dem.distance import Search
from lithobrake.dem.features import write_relative
from lithobrake.dem.vectors import Vector, cross, dot, minus, plus, put, row, scaled, times, transposed_times

# Signed distance, unit normal from first to second, point on first, point on second.
Witness = tuple[float, Vector, Vector, Vector]


@large_kernel
def way_out(
    search: Search, cores: Cores, shapes: tuple[int, int], rotation: Floats, bodies: tuple[int, int], apart: Vector
) -> Witness:
    """Return the witness of crossing cores, relative to the first body's centroid, in the world frame."""
    write_relative(rotation, bodies[0], bodies[1], search.relative)
    there = transposed_times(rotation, bodies[0], apart)
    best = (-1.0, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), there)
    best, found = through_first(search, cores, shapes, there, best, False)
    best, found = through_second(search, cores, shapes, there, best, found)
    if found:
        best = through_edges(search, cores, shapes, there, best)
    else:
        # Two points at one place: every way out is as good as another.
        best = (0.0, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    body = bodies[0]
    return (best[0], times(rotation, body, best[1]), times(rotation, body, best[2]), times(rotation, body, best[3]))


@kernel
def through_first(
    search: Search, cores: Cores, shapes: tuple[int, int], there: Vector, best: Witness, found: bool
) -> tuple[Witness, bool]:
    """Try the faces of the first core."""
    start, end = cores.vertex_start[shapes[1]], cores.vertex_start[shapes[1] + 1]
    for k in range(start, end):
        put(search.turned, k - start, plus(times(search.relative, 0, row(cores.vertex, k)), there))
    for face in range(cores.face_start[shapes[0]], cores.face_start[shapes[0] + 1]):
        normal = row(cores.normal, face)
        lowest, height = 0, dot(normal, row(search.turned, 0))
        for k in range(1, end - start):
            trial = dot(normal, row(search.turned, k))
            if trial < height:
                lowest, height = k, trial
        distance = height - cores.offset[face]
        if not found or distance > best[0]:
            point = row(search.turned, lowest)
            best, found = (distance, normal, minus(point, scaled(distance, normal)), point), True
    return best, found


@kernel
def through_second(
    search: Search, cores: Cores, shapes: tuple[int, int], there: Vector, best: Witness, found: bool
) -> tuple[Witness, bool]:
    """Try the faces of the second core."""
    start, end = cores.vertex_start[shapes[0]], cores.vertex_start[shapes[0] + 1]
    for face in range(cores.face_start[shapes[1]], cores.face_start[shapes[1] + 1]):
        inward = times(search.relative, 0, row(cores.normal, face))
        offset = cores.offset[face] + dot(inward, there)
        lowest, height = start, dot(inward, row(cores.vertex, start))
        for k in range(start + 1, end):
            trial = dot(inward, row(cores.vertex, k))
            if trial < height:
                lowest, height = k, trial
        distance = height - offset
        if not found or distance > best[0]:
            point = row(cores.vertex, lowest)
            best = (distance, scaled(-1.0, inward), point, minus(point, scaled(distance, inward)))
            found = True
    return best, found


@kernel
def through_edges(search: Search, cores: Cores, shapes: tuple[int, int], there: Vector, best: Witness) -> Witness:
    """Try the pairs of edges that make a face of the difference set."""
    turn_edges(search, cores, shapes[1], there)
    second_count = cores.edge_start[shapes[1] + 1] - cores.edge_start[shapes[1]]
    for edge in range(cores.edge_start[shapes[0]], cores.edge_start[shapes[0] + 1]):
        begin = row(cores.vertex, cores.vertex_start[shapes[0]] + cores.edge[edge, 0])
        along = minus(row(cores.vertex, cores.vertex_start[shapes[0]] + cores.edge[edge, 1]), begin)
        left = row(cores.normal, cores.face_start[shapes[0]] + cores.edge[edge, 2])
        right = row(cores.normal, cores.face_start[shapes[0]] + cores.edge[edge, 3])
        for k in range(second_count):
            other = row(search.turned[:, 3:6], k)
            other_left, other_right = row(search.turned[:, 6:9], k), row(search.turned[:, 9:12], k)
            # The second core enters turned inside out: its normals count with the opposite sign.
            side_left, side_right = -dot(other_left, along), -dot(other_right, along)
            cross_left, cross_right = dot(left, other), dot(right, other)
            if side_left * side_right >= 0.0 or cross_left * cross_right >= 0.0 or cross_left * side_right <= 0.0:
                continue
            normal = cross(along, other)
            square = dot(normal, normal)
            if square == 0.0:
                continue
            outward = dot(normal, left) + dot(normal, right)
            normal = scaled((1.0 if outward > 0.0 else -1.0) / square**0.5, normal)
            between = minus(row(search.turned, k), begin)
            distance = dot(between, normal)
            if distance > best[0]:
                here, there_on_line = closest_on_lines(begin, along, row(search.turned, k), other)
                best = (distance, normal, here, there_on_line)
    return best


@kernel
def turn_edges(search: Search, cores: Cores, shape: int, there: Vector) -> None:
    """Write begin, along, left and right normal of the second core's edges, in the first body's frame."""
    first = cores.edge_start[shape]
    for edge in range(first, cores.edge_start[shape + 1]):
        k = edge - first
        begin = row(cores.vertex, cores.vertex_start[shape] + cores.edge[edge, 0])
        end = row(cores.vertex, cores.vertex_start[shape] + cores.edge[edge, 1])
        left = row(cores.normal, cores.face_start[shape] + cores.edge[edge, 2])
        right = row(cores.normal, cores.face_start[shape] + cores.edge[edge, 3])
        put(search.turned, k, plus(times(search.relative, 0, begin), there))
        put(search.turned[:, 3:6], k, times(search.relative, 0, minus(end, begin)))
        put(search.turned[:, 6:9], k, times(search.relative, 0, left))
        put(search.turned[:, 9:12], k, times(search.relative, 0, right))


@kernel
def closest_on_lines(begin: Vector, along: Vector, other_begin: Vector, other: Vector) -> tuple[Vector, Vector]:
    """Return the closest points of two lines that are not parallel."""
    between = minus(other_begin, begin)
    aa, ab, bb = dot(along, along), dot(along, other), dot(other, other)
    ad, bd = dot(along, between), dot(other, between)
    determinant = aa * bb - ab * ab
    here = (ad * bb - bd * ab) / determinant
    there = (ad * ab - bd * aa) / determinant
    return plus(begin, scaled(here, along)), plus(other_begin, scaled(there, other))
