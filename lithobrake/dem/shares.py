"""How the points of a patch share one elastic energy.

The elastic energy of a pair is Hertz', 2/5 K D^(5/2), with D a smooth maximum of the overlaps of its points; every
point carries the derivative of that energy by its own overlap. So the forces come from one potential of the relative
pose, move smoothly from corner to corner, and hold a face by all of its corners.
"""

from lithobrake.compiled import kernel
from lithobrake.dem.distance import Search
from lithobrake.dem.vectors import Vector, dot, minus, plus, put, row, scaled

# Families of points: corners, pairs of edges apart, pairs of edges that may cross (sunk.py), and the shortest way out
# of cores that cross.
CORNER, EDGES_APART, EDGES_SUNK, WAY_OUT = 0, 1, 2, 3
# Weight of a pair of edges beside a corner: where an edge ends, all edges of that corner meet the same place.
EDGE_WEIGHT = 0.25
EDGE_ALONE = EDGE_WEIGHT**0.125  # overlap of a patch that is one pair of edges, over the overlap of that pair
# Between these parts of the rounding, edges apart pass into sunk ones; the cores themselves stay apart till 1.
SINK_FROM, SINK_TO = 0.5, 0.9


@kernel
def note_point(search: Search, count: int, family: int, depth: float, point: Vector, normal: Vector) -> int:
    """Add a point to the patch if it overlaps; return the number of points."""
    if depth <= 0.0:
        return count
    put(search.point, count, point)
    put(search.normal, count, normal)
    search.depth[count], search.family[count] = depth, family
    return count + 1


@kernel
def sinking(progress: float) -> tuple[float, float]:
    """Return how far edges apart have passed into sunk ones at an overlap over the rounding, and the derivative."""
    progress = (progress - SINK_FROM) / (SINK_TO - SINK_FROM)
    if progress <= 0.0:
        return 0.0, 0.0
    if progress >= 1.0:
        return 1.0, 0.0
    return progress * progress * (3.0 - 2.0 * progress), 6.0 * progress * (1.0 - progress) / (SINK_TO - SINK_FROM)


@kernel
def deepest_apart(search: Search, count: int) -> int:
    """Return the deepest point of a patch of cores that do not cross; it is no sunk pair of edges."""
    top = 0
    for k in range(1, count):
        if search.family[k] != EDGES_SUNK and search.depth[k] > search.depth[top]:
            top = k
    return top


@kernel
def power_eight(ratio: float) -> tuple[float, float]:
    """Return the eighth power, and an eighth of its derivative."""
    square = ratio * ratio
    sixth = square * square * square
    return sixth * square, sixth * ratio


@kernel
def past_touch(ratio: float, start: float) -> tuple[float, float]:
    """Return how far an eighth power has risen over its tangent at the start, and an eighth of the derivative of that.

    Both start from nothing. Written out in powers of the growth, whose terms are all positive.
    """
    x = (ratio - start) / start
    power, seventh = power_eight(start)
    grown = x * x * (28.0 + x * (56.0 + x * (70.0 + x * (56.0 + x * (28.0 + x * (8.0 + x))))))
    slope = x * (7.0 + x * (21.0 + x * (35.0 + x * (35.0 + x * (21.0 + x * (7.0 + x))))))
    return power * grown, seventh * slope


@kernel
def spread(search: Search, count: int, sunk: float, slope: float, reach: float) -> tuple[float, Vector, Vector]:
    """Combine the overlaps of a patch into one, and write the share of each point in the force.

    D^8 = sum of d^8 over the corners + 1/4 (1 - sunk) sum of d^8 over edges apart + 1/4 sunk sum of d^8 over sunk
    edges + d^8 of the way out less its tangent at d = reach, where the cores begin to cross, with `sunk` a function of
    the deepest overlap, `slope` [1/m] its derivative, and `reach` [m] both roundings. One corner is Hertz exactly until
    cores cross, four or eight equal ones are 1.5 or 1.9 times as stiff. Returns D [m], the centre of pressure, and the
    unit normal of the whole force.
    """
    if count == 1 and (search.family[0] == CORNER or (search.family[0] == EDGES_APART and sunk == 0.0)):
        share = 1.0 if search.family[0] == CORNER else EDGE_ALONE
        search.share[0] = share
        return share * search.depth[0], row(search.point, 0), row(search.normal, 0)
    deepest, corners, apart, below = 0.0, 0.0, 0.0, 0.0
    centre, force, weights = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0
    for k in range(count):
        deepest = max(deepest, search.depth[k])
    for k in range(count):
        ratio, family = search.depth[k] / deepest, search.family[k]
        eighth, seventh = power_eight(ratio)
        weight = 1.0
        if family == CORNER:
            corners += eighth
        elif family == EDGES_APART:
            weight = EDGE_WEIGHT * (1.0 - sunk)
            apart += EDGE_WEIGHT * eighth
        elif family == EDGES_SUNK:
            # Each pair of sunk edges gives two points.
            weight = 0.5 * EDGE_WEIGHT * sunk
            below += 0.5 * EDGE_WEIGHT * eighth
        else:
            eighth, seventh = past_touch(ratio, reach / deepest)
            corners += eighth
        share = weight * seventh
        search.share[k] = share
        centre = plus(centre, scaled(share, row(search.point, k)))
        force = plus(force, scaled(share, row(search.normal, k)))
        weights += share
    total = corners + (1.0 - sunk) * apart + sunk * below
    root = ((total**0.5) ** 0.5) ** 0.5
    for k in range(count):
        search.share[k] *= root / total
    if slope > 0.0:
        # As the patch deepens, edges apart pass into sunk ones: that too changes the energy.
        search.share[deepest_apart(search, count)] += 0.125 * (below - apart) * slope * deepest * root / total
    size = dot(force, force) ** 0.5
    # Forces of all directions that cancel: every normal is as good as another.
    normal = scaled(1.0 / size, force) if size > 0.0 else (0.0, 0.0, 1.0)
    return deepest * root, scaled(1.0 / weights, centre), normal


@kernel
def spin_radii(search: Search, count: int, centre: Vector, normal: Vector) -> tuple[float, float]:
    """Return mean squared and mean distance of a patch's force from the axis through its centre along the normal."""
    square, mean, weight = 0.0, 0.0, 0.0
    if count == 1:
        return 0.0, 0.0
    for k in range(count):
        arm = minus(row(search.point, k), centre)
        arm = minus(arm, scaled(dot(arm, normal), normal))
        share = max(search.share[k], 0.0)
        square += share * dot(arm, arm)
        mean += share * dot(arm, arm) ** 0.5
        weight += share
    return square / weight, mean / weight
