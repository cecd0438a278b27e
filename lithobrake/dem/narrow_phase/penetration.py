"""Closest points and penetration of two cores, by GJK and by separating axes."""

import math

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, both_roundings
from lithobrake.dem.bodies.vectors import cross, dot, minus, plus, put, row, scaled, times, transposed_times
from lithobrake.dem.narrow_phase.feature_distance import edge_of, lowest_height, point_to_core, write_relative
from lithobrake.dem.narrow_phase.gjk import APART, CLOSE, PENETRATING, UNSURE, closest_simplex, weighted
from lithobrake.dem.narrow_phase.patch_energy import PENETRATION, add_point
from lithobrake.dem.narrow_phase.scratch import Scratch, Simplex, TurnedFeatures
from lithobrake.vocabulary.array_types import Floats, Vector

# Two edges at a smaller angle (squared) part nowhere farther, to rounding, than faces beside them.
PARALLEL = 1e-24
NO_NORMAL = (0.0, 0.0, 0.0)
# Signed distance, unit normal from first to second.
Separation = tuple[float, Vector]
# Edges must come closer by this part than corners, whose points are the more exact ones where both are the same.
TIE = 1e-15
# Distance, point on first, point on second.
Gap = tuple[float, Vector, Vector]
# Where the deepest points are looked for from, beyond the way out, over the size of the pair: far above round-off.
STAND_OFF = 0.01


@large_kernel
def largest_separation(
    cores: Cores, turned: TurnedFeatures, relative: Floats, shapes: tuple[int, int], rotation: Floats,
    members: tuple[int, int], apart: Vector,
) -> Separation:  # fmt: skip
    """Return the largest gap of two cores over the normals of all faces and edge pairs, and its normal, in the first
    body's frame. Where they cross, minus the gap is the shortest way out; no gap is larger than the distance.

    Writes to turned and relative.
    """
    write_relative(rotation, members[0], members[1], relative)
    there = transposed_times(rotation, members[0], apart)
    best = (-math.inf, (0.0, 0.0, 1.0))
    best = separation_by_first_faces(cores, turned, relative, shapes, there, best)
    best = separation_by_second_faces(cores, relative, shapes, there, best)
    if best[0] == -math.inf:
        # Two points at one place: every way out is as good as another.
        return 0.0, best[1]
    return separation_by_edges(cores, turned, relative, shapes, there, best)


@kernel
def separation_by_first_faces(
    cores: Cores, turned: TurnedFeatures, relative: Floats, shapes: tuple[int, int], there: Vector, best: Separation
) -> Separation:
    """Try the faces of the first core. Writes to turned."""
    start, end = cores.vertex_start[shapes[1]], cores.vertex_start[shapes[1] + 1]
    for k in range(start, end):
        put(turned.feature, k - start, plus(times(relative, 0, row(cores.vertex, k)), there))
    for face in range(cores.face_start[shapes[0]], cores.face_start[shapes[0] + 1]):
        normal = row(cores.normal, face)
        height = dot(normal, row(turned.feature, 0))
        for k in range(1, end - start):
            height = min(height, dot(normal, row(turned.feature, k)))
        if height - cores.offset[face] > best[0]:
            best = (height - cores.offset[face], normal)
    return best


@kernel
def separation_by_second_faces(
    cores: Cores, relative: Floats, shapes: tuple[int, int], there: Vector, best: Separation
) -> Separation:
    for face in range(cores.face_start[shapes[1]], cores.face_start[shapes[1] + 1]):
        inward = times(relative, 0, row(cores.normal, face))
        distance = lowest_height(cores, shapes[0], inward) - cores.offset[face] - dot(inward, there)
        if distance > best[0]:
            best = (distance, scaled(-1.0, inward))
    return best


@kernel
def separation_by_edges(
    cores: Cores, turned: TurnedFeatures, relative: Floats, shapes: tuple[int, int], there: Vector, best: Separation
) -> Separation:
    """Try the pairs of edges that make a face of the difference set. Writes to turned."""
    turn_edges(cores, turned, relative, shapes[1], there)
    second_count = cores.edge_start[shapes[1] + 1] - cores.edge_start[shapes[1]]
    for edge in range(cores.edge_start[shapes[0]], cores.edge_start[shapes[0] + 1]):
        begin, along = row(cores.edge_begin, edge), row(cores.edge_along, edge)
        left = row(cores.normal, cores.face_start[shapes[0]] + cores.edge[edge, 2])
        right = row(cores.normal, cores.face_start[shapes[0]] + cores.edge[edge, 3])
        for k in range(second_count):
            other = row(turned.feature[:, 3:6], k)
            other_left, other_right = row(turned.feature[:, 6:9], k), row(turned.feature[:, 9:12], k)
            # The second core enters turned inside out: its normals count with the opposite sign.
            side_left, side_right = -dot(other_left, along), -dot(other_right, along)
            cross_left, cross_right = dot(left, other), dot(right, other)
            if side_left * side_right >= 0.0 or cross_left * cross_right >= 0.0 or cross_left * side_right <= 0.0:
                continue
            normal = normal_to_both(along, other)
            if dot(normal, left) + dot(normal, right) < 0.0:
                normal = scaled(-1.0, normal)
            # Rounding takes some pairs of nearly parallel edges for a face: only the gap itself tells.
            if normal != NO_NORMAL and dot(minus(row(turned.feature, k), begin), normal) > best[0]:
                distance = gap_along(cores, relative, shapes, there, normal)
                if distance > best[0]:
                    best = (distance, normal)
    return best


@kernel
def turn_edges(cores: Cores, turned: TurnedFeatures, relative: Floats, shape: int, there: Vector) -> None:
    """Write begin, along, left and right normal of the second core's edges, in the first body's frame.

    Writes to turned.
    """
    first = cores.edge_start[shape]
    for edge in range(first, cores.edge_start[shape + 1]):
        k = edge - first
        left = row(cores.normal, cores.face_start[shape] + cores.edge[edge, 2])
        right = row(cores.normal, cores.face_start[shape] + cores.edge[edge, 3])
        put(turned.feature, k, plus(times(relative, 0, row(cores.edge_begin, edge)), there))
        put(turned.feature[:, 3:6], k, times(relative, 0, row(cores.edge_along, edge)))
        put(turned.feature[:, 6:9], k, times(relative, 0, left))
        put(turned.feature[:, 9:12], k, times(relative, 0, right))


@kernel
def normal_to_both(along: Vector, other: Vector) -> Vector:
    """Return the unit normal of two edges, square to both to the last digits, or NO_NORMAL where they are parallel."""
    normal = cross(along, other)
    first_square, square = dot(along, along), dot(normal, normal)
    if square <= PARALLEL * first_square * dot(other, other):
        return NO_NORMAL
    # Rounding tilts the product by its part of the angle between the edges, and a tilt counts by the length of an edge.
    normal = minus(normal, scaled(dot(normal, other) / dot(other, other), other))
    normal = minus(normal, scaled(dot(normal, along) / first_square, along))
    return scaled(1.0 / dot(normal, normal) ** 0.5, normal)


@kernel
def gap_along(cores: Cores, relative: Floats, shapes: tuple[int, int], there: Vector, normal: Vector) -> float:
    """Return how far all of the second core lies beyond all of the first along a unit vector of the first's frame."""
    top = -lowest_height(cores, shapes[0], scaled(-1.0, normal))
    return lowest_height(cores, shapes[1], transposed_times(relative, 0, normal)) + dot(there, normal) - top


@large_kernel
def find_closest_points(
    cores: Cores, simplex: Simplex, turned: TurnedFeatures, relative: Floats, shapes: tuple[int, int], rotation: Floats,
    members: tuple[int, int], apart: Vector, margin: float,
) -> tuple[int, int, float]:  # fmt: skip
    """Find the closest points of the cores of two bodies, the second's centroid `apart` from the first's.

    Returns what was found (APART: farther than the margin; CLOSE: points in `simplex`; PENETRATING), the number of
    weighted points, and a lower bound of the distance where they are apart. Writes to simplex, turned and relative.
    """
    found, count, bound = closest_simplex(cores, simplex, shapes, rotation, members, apart, margin)
    if found != UNSURE:
        return found, count, bound
    if largest_separation(cores, turned, relative, shapes, rotation, members, apart)[0] <= 0.0:
        return PENETRATING, 0, 0.0
    there = transposed_times(rotation, members[0], apart)
    best = corners_to_cores(cores, relative, shapes, there)
    distance, on_first, on_second = edges_to_edges(cores, relative, shapes, there, best)
    difference = minus(on_first, on_second)
    if dot(difference, difference) == 0.0:
        return PENETRATING, 0, 0.0
    put(simplex.on_first, 0, times(rotation, members[0], on_first))
    put(simplex.on_second, 0, times(rotation, members[0], on_second))
    put(simplex.difference, 0, times(rotation, members[0], difference))
    simplex.weight[0] = 1.0
    return APART if distance > margin else CLOSE, 1, distance


@kernel
def corners_to_cores(cores: Cores, relative: Floats, shapes: tuple[int, int], there: Vector) -> Gap:
    """Return the smallest gap between a corner of one core and the other core, in the first body's frame."""
    best = (math.inf, there, there)
    for k in range(cores.vertex_start[shapes[1]], cores.vertex_start[shapes[1] + 1]):
        corner = plus(times(relative, 0, row(cores.vertex, k)), there)
        distance, outward, near, _ = point_to_core(cores, shapes[0], corner, best[0])
        if near and distance < best[0]:
            best = (distance, minus(corner, scaled(distance, outward)), corner)
    for k in range(cores.vertex_start[shapes[0]], cores.vertex_start[shapes[0] + 1]):
        corner = row(cores.vertex, k)
        seen = transposed_times(relative, 0, minus(corner, there))
        distance, outward, near, _ = point_to_core(cores, shapes[1], seen, best[0])
        if near and distance < best[0]:
            best = (distance, corner, minus(corner, scaled(distance, times(relative, 0, outward))))
    return best


@kernel
def edges_to_edges(cores: Cores, relative: Floats, shapes: tuple[int, int], there: Vector, best: Gap) -> Gap:
    """Return the smallest gap between two edges that meet amid both, where it is smaller than the best so far."""
    for i in range(cores.edge_start[shapes[0] + 1] - cores.edge_start[shapes[0]]):
        begin, along = edge_of(cores, shapes[0], i)
        for j in range(cores.edge_start[shapes[1] + 1] - cores.edge_start[shapes[1]]):
            other_begin, other = edge_of(cores, shapes[1], j)
            other_begin, other = plus(times(relative, 0, other_begin), there), times(relative, 0, other)
            normal, between = cross(along, other), minus(other_begin, begin)
            square = dot(normal, normal)
            # Parallel edges are closest at an end of one of them, which `corners_to_cores` has tried.
            if square == 0.0:
                continue
            # Written so that round-off counts by the gap of the edges, not by their length over their small angle.
            fraction = min(max(dot(normal, cross(between, other)) / square, 0.0), 1.0)
            other_fraction = min(max(dot(minus(scaled(fraction, along), between), other) / dot(other, other), 0.0), 1.0)
            here, hither = plus(begin, scaled(fraction, along)), plus(other_begin, scaled(other_fraction, other))
            distance = dot(minus(hither, here), minus(hither, here)) ** 0.5
            if distance < (1.0 - TIE) * best[0]:
                best = (distance, here, hither)
    return best


@large_kernel
def penetration_vector(
    cores: Cores, simplex: Simplex, turned: TurnedFeatures, relative: Floats, shapes: tuple[int, int], rotation: Floats,
    members: tuple[int, int], apart: Vector,
) -> tuple[float, Vector, Vector, Vector]:  # fmt: skip
    """Return the shortest way out of crossing cores: signed distance, unit normal from first to second, and the points
    of first and second that lie deepest in each other, relative to the first body's centroid, in the world frame.

    Writes to simplex, turned and relative.
    """
    distance, normal = largest_separation(cores, turned, relative, shapes, rotation, members, apart)
    normal = times(rotation, members[0], normal)
    # Moved apart along the way out, they come closest where they leave each other; faces, somewhere amid both.
    size = dot(apart, apart) ** 0.5 - distance
    out = scaled(STAND_OFF * size - distance, normal)
    _, count, _ = find_closest_points(
        cores, simplex, turned, relative, shapes, rotation, members, plus(apart, out), math.inf
    )
    on_second = minus(weighted(simplex.on_second, simplex.weight, count), out)
    return distance, normal, weighted(simplex.on_first, simplex.weight, count), on_second


@large_kernel
def add_penetration_point(
    bodies: Bodies, cores: Cores, scratch: Scratch, count: int, members: tuple[int, int], shapes: tuple[int, int],
    apart: Vector,
) -> int:  # fmt: skip
    """Add the point at the shortest way out, if the cores still cross; return the number of points.

    Its overlap is the depth of the cores and both roundings. It keeps two flat bars apart of which no corner lies in
    the other: the points at which their edges meet stay on the sides of both, however deep they are. And it pushes out
    the sharp edge through whose far side another has come, where the nearest points of both edges draw inward.
    Writes to scratch.
    """
    simplex, turned, relative, patch = scratch
    found, _, _ = find_closest_points(cores, simplex, turned, relative, shapes, bodies.rotation, members, apart, 0.0)
    if found != PENETRATING:
        return count
    distance, normal, on_first, on_second = penetration_vector(
        cores, simplex, turned, relative, shapes, bodies.rotation, members, apart
    )
    half_difference = 0.5 * (cores.rounding[shapes[0]] - cores.rounding[shapes[1]])
    middle = plus(scaled(0.5, plus(on_first, on_second)), scaled(half_difference, normal))
    point, reach = plus(row(bodies.position, members[0]), middle), both_roundings(cores, shapes)
    return add_point(patch, count, PENETRATION, reach - distance, point, normal)
