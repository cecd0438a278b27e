"""Signed distance of two cores that cross: the shortest way out, over all faces and edge pairs.

The way out of a convex difference set leads through one of its faces, and these are the faces of either core and the
edge pairs whose arcs on the sphere of normals intersect. Source: [Gregorius-2013].
"""

import math

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Cores, Floats
from lithobrake.dem.bodies.vectors import Vector, cross, dot, minus, plus, put, row, scaled, times, transposed_times
from lithobrake.dem.narrow_phase.feature_distance import lowest_height, write_relative
from lithobrake.dem.narrow_phase.scratch import TurnedFeatures

# Two edges at a smaller angle (squared) part nowhere farther, to rounding, than faces beside them.
PARALLEL = 1e-24
NO_NORMAL = (0.0, 0.0, 0.0)
# Signed distance, unit normal from first to second.
Separation = tuple[float, Vector]


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
    """Try the faces of the second core."""
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
