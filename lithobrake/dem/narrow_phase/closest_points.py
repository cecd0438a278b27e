"""The closest points of two cores, for every input.

The search of gjk.py ends with a proof, or says that rounding left it without one: very close faces or edges that
are almost parallel. Then every feature is looked at.
"""

import math

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Cores, Floats
from lithobrake.dem.bodies.vectors import Vector, cross, dot, minus, plus, put, row, scaled, times, transposed_times
from lithobrake.dem.narrow_phase.feature_distance import edge_of, point_to_core
from lithobrake.dem.narrow_phase.gjk import APART, CLOSE, PENETRATING, UNSURE, closest_simplex
from lithobrake.dem.narrow_phase.scratch import Simplex, TurnedFeatures
from lithobrake.dem.narrow_phase.separating_axis import largest_separation

# Edges must come closer by this part than corners, whose points are the more exact ones where both are the same.
TIE = 1e-15

# Distance, point on first, point on second.
Gap = tuple[float, Vector, Vector]


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
