"""The points where the members of a pair touch.

The overlap of a feature is what is left of both rounding radii when its distance is taken off (for patch_energy.py).
Cores that penetrate go on so: the distance of a corner changes its sign, and pairs of edges are by then deep edges.
"""

from typing import NamedTuple

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, Pairs, Planes, both_roundings, both_shapes, first_shape
from lithobrake.dem.bodies.vectors import dot, minus, plus, put, row, scaled, times, transposed_times, way_between
from lithobrake.dem.narrow_phase.feature_distance import (
    ALL_FEATURES,
    CORNER_OF_FIRST,
    CORNER_OF_SECOND,
    SPHERES,
    edge_of,
    edge_to_edge,
    encode_feature,
    feature_indices,
    feature_kind,
    listed_feature,
    point_to_core,
    stands_above,
    write_relative,
)
from lithobrake.dem.narrow_phase.patch_energy import (
    CORNER,
    DEEP_FROM,
    EDGES_APART,
    add_deep_edges,
    add_point,
    combine_overlaps,
    deepening,
)
from lithobrake.dem.narrow_phase.penetration import add_penetration_point
from lithobrake.dem.narrow_phase.scratch import Patch, Scratch
from lithobrake.vocabulary.array_types import Vector


class Contact(NamedTuple):
    points: int  # number of points of the patch, which lie in the scratch; 0 where apart
    overlap: float  # m
    point: Vector  # m, centre of pressure
    normal: Vector  # from first to second
    through_centroids: bool  # whether the normal runs so: two spheres


@kernel
def find_contact(pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, scratch: Scratch) -> Contact:
    """Return where the members of a pair touch that has features to look at. Writes to scratch."""
    patch, second = scratch.patch, pairs.second[pair]
    if feature_kind(pairs.feature[pair, 0]) == SPHERES and pairs.feature_count[pair] > 0:
        overlap, point, normal, central = sphere_overlap(pair, bodies, cores, pairs)
        # Spheres come straight from their centres; as a lone corner they take the short way through the law.
        patch.weight[0], patch.family[0] = 1.0, CORNER
        return Contact(1 if overlap > 0.0 else 0, overlap, point, normal, central)
    if second >= 0:
        count, deep, derivative = body_patch(pair, bodies, cores, pairs, scratch)
        reach = both_roundings(cores, both_shapes(pair, bodies, pairs))
    else:
        reach = cores.rounding[first_shape(pair, bodies, pairs)]
        count, deep, derivative = plane_patch(pair, bodies, cores, planes, pairs, patch), 0.0, 0.0
    if count == 0:
        return Contact(0, 0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), False)
    overlap, point, normal = combine_overlaps(patch, count, deep, derivative, reach)
    return Contact(count, overlap, point, normal, False)


@kernel
def plane_patch(pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, patch: Patch) -> int:
    """Write the points where a body presses on a plane; the normal points into the plane. Returns their number.

    The force acts on the surface of the body as if it were not dented, so that a ball rolls with its own radius.
    Writes to patch.
    """
    body, plane = pairs.first[pair], -1 - pairs.second[pair]
    outward, shape, count = row(planes.normal, plane), first_shape(pair, bodies, pairs), 0
    inward, rounding = scaled(-1.0, outward), cores.rounding[shape]
    down = transposed_times(bodies.rotation, body, outward)
    level = planes.offset[plane] + rounding - dot(outward, row(bodies.position, body))
    for k in range(pairs.feature_count[pair]):
        corner = row(cores.vertex, cores.vertex_start[shape] + feature_indices(listed_feature(pair, pairs, k))[0])
        depth = level - dot(corner, down)
        foot = plus(row(bodies.position, body), times(bodies.rotation, body, corner))
        point = minus(foot, scaled(rounding, outward))
        count = add_point(patch, count, CORNER, depth, point, inward)
    return count


@kernel
def body_patch(pair: int, bodies: Bodies, cores: Cores, pairs: Pairs, scratch: Scratch) -> tuple[int, float, float]:
    """Write the points where two bodies touch. Returns their number, and what `spread` needs to know of edges.

    Writes to scratch.
    """
    relative, patch = scratch.relative, scratch.patch
    first, second = pairs.first[pair], pairs.second[pair]
    apart, shapes = way_between(bodies, first, second), both_shapes(pair, bodies, pairs)
    penetrating = pairs.feature_count[pair] == ALL_FEATURES
    if penetrating:
        count, deep, derivative = add_all_corners(bodies, cores, patch, (first, second), shapes, apart), 1.0, 0.0
    else:
        count, deep, derivative = add_listed_features(pair, bodies, cores, pairs, patch, apart)
    # Every pair of edges is examined here, at ten times the cost of the list: not before half of the rounding.
    if deep > 0.0:
        write_relative(bodies.rotation, first, second, relative)
        there = transposed_times(bodies.rotation, first, apart)
        apart_count, count = count, add_deep_edges(cores, patch, relative, count, shapes, there)
        # Deep edges are measured in the frame of the first body, whose faces then need no turning.
        for k in range(apart_count, count):
            put(patch.point, k, plus(row(bodies.position, first), times(bodies.rotation, first, row(patch.point, k))))
            put(patch.normal, k, times(bodies.rotation, first, row(patch.normal, k)))
            put(patch.couple, k, times(bodies.rotation, first, row(patch.couple, k)))
    if penetrating:
        count = add_penetration_point(bodies, cores, scratch, count, (first, second), shapes, apart)
    return count, deep, derivative


@kernel
def add_listed_features(
    pair: int, bodies: Bodies, cores: Cores, pairs: Pairs, patch: Patch, apart: Vector
) -> tuple[int, float, float]:
    """Write the listed features that overlap; return their number, how far edges have passed into deep ones, and the
    derivative of that by the deepest overlap (1/m).

    Writes to patch.
    """
    members, shapes = (pairs.first[pair], pairs.second[pair]), both_shapes(pair, bodies, pairs)
    count, corners, deepest = 0, 0, 0.0
    for k in range(pairs.feature_count[pair]):
        feature = listed_feature(pair, pairs, k)
        count = add_feature_point(bodies, cores, patch, count, members, shapes, apart, feature)
        # Corners are listed before edges.
        if feature_kind(feature) <= CORNER_OF_SECOND:
            corners = count
    for k in range(count):
        deepest = max(deepest, patch.depth[k])
    reach = both_roundings(cores, shapes)
    if deepest <= DEEP_FROM * reach:
        return count, 0.0, 0.0
    deep, derivative = deepening(deepest / reach)
    # Where edges apart have passed into deep ones in full they weigh nothing, and the list need not hold them.
    return corners if deep == 1.0 else count, deep, derivative / reach


@large_kernel
def add_all_corners(
    bodies: Bodies, cores: Cores, patch: Patch, members: tuple[int, int], shapes: tuple[int, int], apart: Vector
) -> int:
    """Write all corners of two bodies that overlap; return their number. Writes to patch."""
    count = 0
    for kind in range(2):
        shape = shapes[0] if kind == 0 else shapes[1]
        for k in range(cores.vertex_start[shape + 1] - cores.vertex_start[shape]):
            feature = encode_feature(kind, k, 0)
            count = add_feature_point(bodies, cores, patch, count, members, shapes, apart, feature)
    return count


@kernel
def add_feature_point(
    bodies: Bodies, cores: Cores, patch: Patch, count: int, members: tuple[int, int], shapes: tuple[int, int],
    apart: Vector, feature: int,
) -> int:  # fmt: skip
    """Add a feature to the patch if it overlaps; return the number of points. Writes to patch."""
    roundings = (cores.rounding[shapes[0]], cores.rounding[shapes[1]])
    reach, half_difference = roundings[0] + roundings[1], 0.5 * (roundings[0] - roundings[1])
    on_first, normal, distance = measure_feature(bodies, cores, feature, members, shapes, apart, reach)
    if distance >= reach:
        return count
    middle = plus(on_first, scaled(0.5 * distance + half_difference, normal))
    family = CORNER if feature_kind(feature) <= CORNER_OF_SECOND else EDGES_APART
    return add_point(patch, count, family, reach - distance, plus(row(bodies.position, members[0]), middle), normal)


@kernel
def measure_feature(
    bodies: Bodies, cores: Cores, feature: int, members: tuple[int, int], shapes: tuple[int, int], apart: Vector,
    reach: float,
) -> tuple[Vector, Vector, float]:  # fmt: skip
    """Return point on the first core, about its centre of mass, normal to the second and distance of a feature."""
    kind, (i, j), turn = feature_kind(feature), feature_indices(feature), bodies.rotation
    first, second = members
    shape, other_shape = shapes
    if kind == CORNER_OF_FIRST:
        corner = times(turn, first, row(cores.vertex, cores.vertex_start[shape] + i))
        seen = transposed_times(turn, second, minus(corner, apart))
        distance, outward = corner_over_core(cores, other_shape, seen, j - 1, reach)
        return corner, scaled(-1.0, times(turn, second, outward)), distance
    if kind == CORNER_OF_SECOND:
        corner = plus(times(turn, second, row(cores.vertex, cores.vertex_start[other_shape] + i)), apart)
        distance, outward = corner_over_core(cores, shape, transposed_times(turn, first, corner), j - 1, reach)
        normal = times(turn, first, outward)
        return minus(corner, scaled(distance, normal)), normal, distance
    begin, along = edge_of(cores, shape, i)
    other, other_along = edge_of(cores, other_shape, j)
    here, hither = edge_to_edge(
        times(turn, first, begin), times(turn, first, along),
        plus(times(turn, second, other), apart), times(turn, second, other_along),
    )  # fmt: skip
    between = minus(hither, here)
    square = dot(between, between)
    # Most listed edges are out of reach: compared by the square, they cost no root.
    if square >= reach * reach:
        return here, between, reach
    distance = square**0.5
    return here, scaled(1.0 / distance, between) if distance > 0.0 else between, distance


@kernel
def corner_over_core(cores: Cores, shape: int, point: Vector, face: int, reach: float) -> tuple[float, Vector]:
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
def sphere_overlap(
    pair: int, bodies: Bodies, cores: Cores, pairs: Pairs
) -> tuple[float, Vector, Vector, bool]:  # fmt: skip
    """Return overlap (not above 0: none), middle and normal of two spheres, and whether the normal runs through the
    centres of mass of both bodies.
    """
    centre, apart, central = sphere_centres(pair, bodies, cores, pairs)
    radius = bodies.contact_radius[pairs.first_part[pair]]
    distance = dot(apart, apart) ** 0.5
    overlap = radius + bodies.contact_radius[pairs.second_part[pair]] - distance
    # Spheres about one centre: every normal is as good as another.
    normal = scaled(1.0 / distance, apart) if distance > 0.0 else (0.0, 0.0, 1.0)
    half = scaled(radius - 0.5 * overlap, normal)
    return overlap, plus(centre, half), normal, central


@kernel
def sphere_centres(
    pair: int, bodies: Bodies, cores: Cores, pairs: Pairs
) -> tuple[Vector, Vector, bool]:  # fmt: skip
    """Return the centre of a pair's first sphere, the way to that of the second [m], and whether both are centres of
    mass.
    """
    first, second, (shape, other_shape) = pairs.first[pair], pairs.second[pair], both_shapes(pair, bodies, pairs)
    centre, apart = row(bodies.position, first), way_between(bodies, first, second)
    arm, other_arm = row(cores.vertex, cores.vertex_start[shape]), row(cores.vertex, cores.vertex_start[other_shape])
    # Nearly all balls have their centre at the centre of mass, and need not be turned.
    if dot(arm, arm) + dot(other_arm, other_arm) == 0.0:
        return centre, apart, True
    arm, other_arm = times(bodies.rotation, first, arm), times(bodies.rotation, second, other_arm)
    return plus(centre, arm), plus(apart, minus(other_arm, arm)), False
