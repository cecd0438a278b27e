"""The one elastic energy of all points of a patch.

The elastic energy of a pair is Hertz', 2/5 K D^(5/2), with D a smooth maximum of the overlaps of its points; every
point carries the derivative of that energy by its own overlap. So the forces come from one potential of the relative
pose, move smoothly from corner to corner, and hold a face by all of its corners.
"""

from typing import NamedTuple

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.vectors import Vector, dot, minus, plus, put, row, scaled, tangential_part
from lithobrake.dem.narrow_phase.scratch import Patch

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
    square = ratio * ratio
    sixth = square * square * square
    return sixth * square, sixth * ratio


@kernel
def power_above_tangent(ratio: float, start: float) -> tuple[float, float]:
    """Return how far an eighth power has risen over its tangent at the start, and an eighth of the derivative of that.

    Both start from nothing. Written out in powers of the growth, whose terms are all positive.
    """
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
    both = xx + yy + zz
    squares = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx)
    return 0.5 * (both + max(0.0, 2.0 * squares - both * both) ** 0.5)
