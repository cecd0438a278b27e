"""Which features of a pair are near enough to touch before its motion has used up a margin.

Distances are computed anew in each step (contact_patch.py), and features that do not touch add nothing. So it makes no
difference to any bit when, or how often, a list is renewed.
"""

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, Floats, Pairs, Planes
from lithobrake.dem.bodies.motion import surface_speed_bound
from lithobrake.dem.bodies.parts import both_roundings, both_shapes, contact_radii, first_shape
from lithobrake.dem.bodies.period import way_between
from lithobrake.dem.bodies.vectors import Vector, dot, row, scaled, transposed_times
from lithobrake.dem.narrow_phase.closest_points import find_closest_points
from lithobrake.dem.narrow_phase.feature_culling import band_along, is_point, list_corners, list_edges
from lithobrake.dem.narrow_phase.feature_distance import write_relative
from lithobrake.dem.narrow_phase.feature_id import ALL_FEATURES, CORNER_OF_FIRST, SPHERES, add_feature, feature_capacity
from lithobrake.dem.narrow_phase.gjk import APART, CLOSE, PENETRATING, weighted
from lithobrake.dem.narrow_phase.patch_energy import DEEP_TO
from lithobrake.dem.narrow_phase.scratch import Scratch, Simplex, TurnedFeatures

# The margin is this part of the rounding radii, which themselves count for at most this part of the contact radii.
MARGIN_OF_ROUNDING, ROUNDING_OF_RADIUS = 0.1, 0.04
# A pair in motion has a margin for about so many steps at its present speed, up to that part of the contact radii.
STEPS_LISTED = 24.0
# Part of a margin that is kept back: covers the round-off in summing travels.
BOUND_SLACK = 1e-6


@kernel
def travelled(bodies: Bodies, first: int, second: int) -> float:
    """Return a bound on how far the members of a pair have moved against each other so far."""
    return bodies.travel[first] + (bodies.travel[second] if second >= 0 else 0.0)


@kernel
def list_margin(pair: int, bodies: Bodies, cores: Cores, pairs: Pairs, time_step: float) -> float:
    """Return the motion [m] for which the list of a pair shall serve."""
    rounding = cores.rounding[first_shape(pair, bodies, pairs)]
    speed = surface_speed_bound(bodies, pairs.first[pair])
    if pairs.second[pair] >= 0:
        rounding += cores.rounding[bodies.shape[pairs.second_part[pair]]]
        speed += surface_speed_bound(bodies, pairs.second[pair])
    most = ROUNDING_OF_RADIUS * contact_radii(pair, bodies, pairs)
    return max(MARGIN_OF_ROUNDING * min(rounding, most), min(STEPS_LISTED * speed * time_step, most))


@kernel
def renew_list(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, scratch: Scratch, margin: float,
    travel: float,
) -> bool:  # fmt: skip
    """List the features of a pair within a margin [m], to serve from a travel [m] on; tell whether there was room.

    Writes to pairs and scratch.
    """
    if pairs.second[pair] < 0:
        serves = max(margin, list_plane(pair, bodies, cores, planes, pairs, margin))
    else:
        serves = list_bodies(pair, bodies, cores, pairs, scratch.simplex, scratch.turned, scratch.relative, margin)
    if pairs.feature_count[pair] > feature_capacity(pair, pairs):
        return False
    pairs.wake[pair] = travel + (1.0 - BOUND_SLACK) * serves
    return True


@large_kernel
def update_feature_lists(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, scratch: Scratch, time_step: float, start: int,
    stop: int,
) -> int:  # fmt: skip
    """Renew the lists of pairs start to stop whose margin is used up; return how many found too little room.

    Those are listed again at the next call. Writes to pairs and scratch.
    """
    lacking = 0
    for pair in range(start, stop):
        travel = travelled(bodies, pairs.first[pair], pairs.second[pair])
        if travel < pairs.wake[pair]:
            continue
        margin = list_margin(pair, bodies, cores, pairs, time_step)
        if not renew_list(pair, bodies, cores, planes, pairs, scratch, margin, travel):
            lacking += 1
    return lacking


@kernel
def list_plane(pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, margin: float) -> float:
    """List the corners near a plane; return the gap. Writes to pairs."""
    body, plane = pairs.first[pair], -1 - pairs.second[pair]
    shape = first_shape(pair, bodies, pairs)
    pairs.feature_count[pair] = 0
    outward = row(planes.normal, plane)
    down = transposed_times(bodies.rotation, body, outward)
    level = dot(outward, row(bodies.position, body)) - planes.offset[plane] - cores.rounding[shape]
    start, end = cores.vertex_start[shape], cores.vertex_start[shape + 1]
    gap = level + dot(row(cores.vertex, start), down)
    for k in range(start, end):
        height = level + dot(row(cores.vertex, k), down)
        gap = min(gap, height)
        if height < margin:
            add_feature(pair, pairs, CORNER_OF_FIRST, k - start, 0)
    return gap


@kernel
def closest_approach(simplex: Simplex, found: int, count: int) -> tuple[float, Vector]:
    """Return distance and direction, first to second, of the closest points of two cores; zero where they cross."""
    between = weighted(simplex.difference, simplex.weight, count) if found == CLOSE else (0.0, 0.0, 0.0)
    distance = dot(between, between) ** 0.5
    return distance, scaled(-1.0 / distance, between) if distance > 0.0 else between


@large_kernel
def list_bodies(
    pair: int, bodies: Bodies, cores: Cores, pairs: Pairs, simplex: Simplex, turned: TurnedFeatures, relative: Floats,
    margin: float,
) -> float:  # fmt: skip
    """List the features of two bodies that are near each other; return the motion for which the list serves.

    Writes to pairs, simplex, turned and relative.
    """
    first, second = pairs.first[pair], pairs.second[pair]
    shapes, members = both_shapes(pair, bodies, pairs), (first, second)
    pairs.feature_count[pair] = 0
    apart = way_between(bodies, first, second)
    bound = dot(apart, apart) ** 0.5 - bodies.bounding_radius[first] - bodies.bounding_radius[second]
    if bound >= margin:
        return bound
    reach = both_roundings(cores, shapes)
    if is_point(cores, shapes[0]) and is_point(cores, shapes[1]):
        add_feature(pair, pairs, SPHERES, 0, 0)
        return margin
    found, count, bound = find_closest_points(
        cores, simplex, turned, relative, shapes, bodies.rotation, members, apart, reach + margin
    )
    if found == APART:
        return bound - reach
    hulls = not (is_point(cores, shapes[0]) or is_point(cores, shapes[1]))
    if found == PENETRATING and hulls:
        # Until they are this far apart again, the listed features and all of them come to the same (contact_patch.py).
        pairs.feature_count[pair] = ALL_FEATURES
        return (1.0 - DEEP_TO) * reach
    write_relative(bodies.rotation, first, second, relative)
    there = transposed_times(bodies.rotation, first, apart)
    distance, direction = closest_approach(simplex, found, count)
    axis = transposed_times(bodies.rotation, first, direction)
    band = band_along(cores, relative, shapes, there, axis, reach + margin)
    list_corners(pair, cores, pairs, relative, shapes, there, band)
    if not hulls:
        return margin
    list_edges(pair, cores, pairs, turned, relative, shapes, there, band)
    return min(margin, distance)
