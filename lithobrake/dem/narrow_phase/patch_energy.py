"""The one elastic energy of all points of a patch, and edges that penetrate each other deeply."""

from typing import NamedTuple

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Cores
from lithobrake.dem.bodies.vectors import (
    cross,
    dot,
    minus,
    plus,
    put,
    row,
    scaled,
    tangential_part,
    times,
    transposed_times,
)
from lithobrake.dem.narrow_phase.feature_distance import closest_fractions, edge_of, lowest_height, point_to_core
from lithobrake.dem.narrow_phase.scratch import Patch
from lithobrake.vocabulary.array_types import Floats, Vector

# Families of points: corners, pairs of edges apart, deep pairs of edges (deep_edges.py), and the
# penetration vector of cores.
CORNER, EDGES_APART, DEEP_EDGES, PENETRATION = 0, 1, 2, 3
# Weight of a pair of edges beside a corner: where an edge ends, all edges of that corner meet the same place.
EDGE_WEIGHT = 0.25
EDGE_ALONE = EDGE_WEIGHT**0.125  # overlap of a patch that is one pair of edges, over the overlap of that pair
# Between these parts of the rounding, edges apart pass into deep ones; the cores themselves stay apart till 1.
DEEP_FROM, DEEP_TO = 0.5, 0.9


@kernel
def add_point(patch: Patch, count: int, family: int, depth: float, point: Vector, normal: Vector) -> int:
    """Add a point to the patch if it overlaps; return the number of points. Writes to patch."""
    if depth <= 0.0:
        return count
    put(patch.point, count, point)
    put(patch.normal, count, normal)
    patch.depth[count], patch.family[count] = depth, family
    return count + 1


@kernel
def deepening(progress: float) -> tuple[float, float]:
    """Return how far edges apart have passed into deep ones at an overlap over the rounding, and the derivative."""
    progress = (progress - DEEP_FROM) / (DEEP_TO - DEEP_FROM)
    if progress <= 0.0:
        return 0.0, 0.0
    if progress >= 1.0:
        return 1.0, 0.0
    return progress * progress * (3.0 - 2.0 * progress), 6.0 * progress * (1.0 - progress) / (DEEP_TO - DEEP_FROM)


@kernel
def deepest_shallow_point(patch: Patch, count: int) -> int:
    """Return the deepest point of a patch of cores that do not penetrate; it is no deep pair of edges."""
    top = 0
    for k in range(1, count):
        if patch.family[k] != DEEP_EDGES and patch.depth[k] > patch.depth[top]:
            top = k
    return top


@kernel
def power_eight(ratio: float) -> tuple[float, float]:
    """Return the eighth power, and an eighth of its derivative."""
    # The eighth power and not a lower one, because features coincide where faces meet: two equal faces laid exactly on
    # each other, with 40 features, are 2.4 times as stiff as one point, and would be 5.7 times with the fourth.
    square = ratio * ratio
    sixth = square * square * square
    return sixth * square, sixth * ratio


@kernel
def power_above_tangent(ratio: float, start: float) -> tuple[float, float]:
    """Return how far an eighth power has risen over its tangent at the start, and an eighth of the derivative of that.

    Both start from nothing. Written out in powers of the growth, whose terms are all positive.
    """
    # The coefficients are those of (1 + x)^8, less 1 + 8 x, and of (1 + x)^7, less 1.
    x = (ratio - start) / start
    power, seventh = power_eight(start)
    grown = x * x * (28.0 + x * (56.0 + x * (70.0 + x * (56.0 + x * (28.0 + x * (8.0 + x))))))
    derivative = x * (7.0 + x * (21.0 + x * (35.0 + x * (35.0 + x * (21.0 + x * (7.0 + x))))))
    return power * grown, seventh * derivative


class PatchSums(NamedTuple):
    """Sums over the points of a patch: eighth powers of the overlap over the deepest, by family, and weighted ones."""

    corners: float  # with the penetration
    apart: float  # edges apart
    below: float  # deep edges
    weight: float
    centre: Vector  # m, of the points
    force: Vector  # of their normals


@kernel
def weigh_points(patch: Patch, count: int, deepest: float, deep: float, reach: float) -> PatchSums:
    """Sum up the points of a patch, each by its family, and write their weights in that sum. Writes to patch."""
    corners, apart, below = 0.0, 0.0, 0.0
    centre, force, weight_sum = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0
    for k in range(count):
        # Over the deepest, so that no overlap, however small, underflows in its eighth power.
        ratio, family = patch.depth[k] / deepest, patch.family[k]
        eighth, seventh = power_eight(ratio)
        family_weight = 1.0
        if family == CORNER:
            corners += eighth
        elif family == EDGES_APART:
            family_weight = EDGE_WEIGHT * (1.0 - deep)
            apart += EDGE_WEIGHT * eighth
        elif family == DEEP_EDGES:
            # Each pair of deep edges gives two points.
            family_weight = 0.5 * EDGE_WEIGHT * deep
            below += 0.5 * EDGE_WEIGHT * eighth
        else:
            eighth, seventh = power_above_tangent(ratio, reach / deepest)
            corners += eighth
        weight = family_weight * seventh
        patch.weight[k] = weight
        centre = plus(centre, scaled(weight, row(patch.point, k)))
        force = plus(force, scaled(weight, row(patch.normal, k)))
        weight_sum += weight
    return PatchSums(corners, apart, below, weight_sum, centre, force)


@kernel
def combine_overlaps(
    patch: Patch, count: int, deep: float, derivative: float, reach: float
) -> tuple[float, Vector, Vector]:
    """Combine the overlaps of a patch into one, and write the weight of each point in the force.

    D^8 = sum of d^8 over the corners + 1/4 (1 - deep) sum of d^8 over edges apart + 1/4 deep sum of d^8 over deep
    edges + d^8 of the penetration less its tangent at d = reach, where the cores begin to cross, with `deep` a function
    of the deepest overlap, `derivative` [1/m] its derivative, and `reach` [m] both roundings. One corner is Hertz
    exactly until cores cross, four or eight equal ones are 1.5 or 1.9 times as stiff. Returns D [m], the centre of
    pressure, and the unit normal of the whole force. Writes to patch.
    """
    # More than half of the contacts of a bed have one point, and need no root.
    if count == 1 and (patch.family[0] == CORNER or (patch.family[0] == EDGES_APART and deep == 0.0)):
        weight = 1.0 if patch.family[0] == CORNER else EDGE_ALONE
        patch.weight[0] = weight
        return weight * patch.depth[0], row(patch.point, 0), row(patch.normal, 0)
    deepest = 0.0
    for k in range(count):
        deepest = max(deepest, patch.depth[k])
    sums = weigh_points(patch, count, deepest, deep, reach)
    total = sums.corners + (1.0 - deep) * sums.apart + deep * sums.below
    root = ((total**0.5) ** 0.5) ** 0.5
    for k in range(count):
        patch.weight[k] *= root / total
    if derivative > 0.0:
        # As the patch deepens, edges apart pass into deep ones: that too changes the energy.
        patch.weight[deepest_shallow_point(patch, count)] += (
            0.125 * (sums.below - sums.apart) * derivative * deepest * root / total
        )
    size = dot(sums.force, sums.force) ** 0.5
    # Forces of all directions that cancel: every normal is as good as another.
    normal = scaled(1.0 / size, sums.force) if size > 0.0 else (0.0, 0.0, 1.0)
    return deepest * root, scaled(1.0 / sums.weight, sums.centre), normal


@kernel
def spin_radii(patch: Patch, count: int, centre: Vector, normal: Vector) -> tuple[float, float]:
    """Return mean squared and mean distance of a patch's force from the axis through its centre along the normal."""
    square, mean, weight_sum = 0.0, 0.0, 0.0
    if count == 1:
        return 0.0, 0.0
    for k in range(count):
        arm = tangential_part(minus(row(patch.point, k), centre), normal)
        # The passage into deep edges can make a weight negative (`combine_overlaps`), as no weight of a mean may be.
        weight = max(patch.weight[k], 0.0)
        square += weight * dot(arm, arm)
        mean += weight * dot(arm, arm) ** 0.5
        weight_sum += weight
    return square / weight_sum, mean / weight_sum


@kernel
def patch_tilt_stiffness(
    patch: Patch, count: int, centre: Vector, normal: Vector, overlap: float, stiffness: float
) -> float:
    """Return the stiffness [N m] of a patch against tilting about the stiffest axis through its centre.

    Second derivative of the patch's energy where the points move against each other: each has a part of the
    normal stiffness, 3/2 of the secant `stiffness` [N/m], and seven times the force over its own overlap.
    """
    if count == 1:
        return 0.0
    xx, yy, zz, xy, yz, zx = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(count):
        x, y, z = tangential_part(minus(row(patch.point, k), centre), normal)
        weight = max(patch.weight[k], 0.0) * stiffness * (1.5 + 7.0 * overlap / patch.depth[k])
        xx, yy, zz = xx + weight * x * x, yy + weight * y * y, zz + weight * z * z
        xy, yz, zx = xy + weight * x * y, yz + weight * y * z, zx + weight * z * x
    # All arms lie across the normal, so one eigenvalue is 0 and the largest has a closed form; rounding may leave its
    # discriminant below 0.
    both = xx + yy + zz
    squares = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx)
    return 0.5 * (both + max(0.0, 2.0 * squares - both * both) ** 0.5)


@large_kernel
def add_deep_edges(
    cores: Cores, patch: Patch, relative: Floats, count: int, shapes: tuple[int, int], there: Vector
) -> int:
    """Add all pairs of edges that overlap to the patch, in the first body's frame; return the number of points.

    Writes to patch.
    """
    reach = cores.rounding[shapes[0]] + cores.rounding[shapes[1]]
    size = dot(there, there) ** 0.5
    # Any axis gives the same patch: heights along it only sort out pairs that are too far from each other.
    along = scaled(1.0 / size, there) if size > 0.0 else (0.0, 0.0, 1.0)
    turned = transposed_times(relative, 0, along)
    # No point of the first core stands higher than this along the line of centres, none of the second lower.
    top = -lowest_height(cores, shapes[0], scaled(-1.0, along)) + reach
    bottom = lowest_height(cores, shapes[1], turned) - reach
    for i in range(cores.edge_start[shapes[0] + 1] - cores.edge_start[shapes[0]]):
        begin, u = edge_of(cores, shapes[0], i)
        height = dot(begin, along)
        if max(height, height + dot(u, along)) < bottom + dot(there, along):
            continue
        for j in range(cores.edge_start[shapes[1] + 1] - cores.edge_start[shapes[1]]):
            other, v = edge_of(cores, shapes[1], j)
            height = dot(other, turned) + dot(there, along)
            if min(height, height + dot(v, turned)) <= top:
                other, v = plus(times(relative, 0, other), there), times(relative, 0, v)
                count = add_deep_edge_pair(cores, patch, relative, count, shapes, there, reach, (begin, u), (other, v))
    return count


@large_kernel
def add_deep_edge_pair(
    cores: Cores, patch: Patch, relative: Floats, count: int, shapes: tuple[int, int], there: Vector, reach: float,
    first: tuple[Vector, Vector], second: tuple[Vector, Vector],
) -> int:  # fmt: skip
    """Add a pair of edges (begin and direction each) to the patch if it overlaps; return the number of points.

    As the second body moves by v (at the point) and turns by w against the first, the overlap falls by the mean of
    normal . v + couple . w over the two points. Writes to patch.
    """
    fraction, other_fraction, parallel = closest_fractions(first[0], first[1], second[0], second[1])
    here, hither = plus(first[0], scaled(fraction, first[1])), plus(second[0], scaled(other_fraction, second[1]))
    distance, outward, near, _ = point_to_core(cores, shapes[0], hither, reach)
    if not near:
        return count
    seen = transposed_times(relative, 0, minus(here, there))
    other_distance, inward, near, _ = point_to_core(cores, shapes[1], seen, reach)
    if not near:
        return count
    inward = times(relative, 0, inward)
    free, other_free = 0.0 < fraction < 1.0 and not parallel, 0.0 < other_fraction < 1.0 and not parallel
    between = minus(hither, here)
    overlap, gain, other_gain = smooth_minimum(reach - distance, reach - other_distance)
    half_difference = 0.5 * (cores.rounding[shapes[0]] - cores.rounding[shapes[1]])

    normal, couple = sliding(first[1], second[1], between, outward, free, other_free)
    point = plus(hither, scaled(half_difference - 0.5 * distance, normal))
    put(patch.couple, count, scaled(gain, couple))
    count = add_point(patch, count, DEEP_EDGES, overlap, point, scaled(gain, normal))

    normal, couple = sliding(second[1], first[1], scaled(-1.0, between), inward, other_free, free)
    point = minus(here, scaled(half_difference + 0.5 * other_distance, normal))
    put(patch.couple, count, scaled(-other_gain, couple))
    return add_point(patch, count, DEEP_EDGES, overlap, point, scaled(-other_gain, normal))


@kernel
def smooth_minimum(a: float, b: float) -> tuple[float, float, float]:
    """Return a smooth minimum of two positive overlaps, and twice its derivatives: the pair stands for two points."""
    least = min(a, b)
    # Over the smaller one, so that no overlap, however small, underflows in its fourth power.
    ratio, other = least / a, least / b
    total = 0.5 * (ratio * ratio * ratio * ratio + other * other * other * other)
    overlap = least / (total**0.5) ** 0.5
    return overlap, (overlap / a) ** 5, (overlap / b) ** 5


@kernel
def sliding(
    u: Vector, v: Vector, between: Vector, outward: Vector, u_free: bool, v_free: bool
) -> tuple[Vector, Vector]:
    """Return how the height of the closest point on edge v over a face of u's core grows: normal and couple.

    The point slides along v as the edges move; it rises by normal . (motion of v's body there) + couple . (its turn).
    `between` leads from the closest point of u to that of v, `outward` is the unit normal of the face. An edge is free
    where its closest point is none of its ends.
    """
    # A point at the end of its edge is fixed in its body: it slides nowhere, and turning about it does not lift it.
    if not v_free:
        return outward, (0.0, 0.0, 0.0)
    rise = dot(outward, v)
    if not u_free:
        rise /= dot(v, v)
        return minus(outward, scaled(rise, v)), scaled(-rise, cross(v, between))
    normal = cross(u, v)
    square = dot(normal, normal)
    # Derived: across = u x m and m = u x v / |u x v| keep v's closest point above u while both turn.
    across = scaled(1.0 / square, cross(u, normal))
    gap = dot(between, normal) / square
    couple = plus(scaled(dot(u, v), across), u)
    return plus(outward, scaled(rise, across)), scaled(-rise * gap, couple)
