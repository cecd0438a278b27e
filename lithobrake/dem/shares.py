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
def spread(search: Search, count: int, sunk: float, slope: float) -> tuple[float, Vector, Vector]:
    """Combine the overlaps of a patch into one, and write the share of each point in the force.

    D^8 = sum of d^8 over the corners + 1/4 (1 - sunk) sum of d^8 over edges apart + 1/4 sunk sum of d^8 over sunk
    edges + 1/4 d^8 of the way out, with `sunk` a function of the deepest overlap and `slope` [1/m] its derivative. One
    corner is Hertz exactly, four or eight equal ones are 1.5 or 1.9 times as stiff. Returns D [m], the centre of
    pressure, and the unit normal of the whole force.
    """
    if count == 1 and search.family[0] == CORNER:
        search.share[0] = 1.0
        return search.depth[0], row(search.point, 0), row(search.normal, 0)
    deepest, corners, apart, below = 0.0, 0.0, 0.0, 0.0
    for k in range(count):
        deepest = max(deepest, search.depth[k])
    for k in range(count):
        ratio = search.depth[k] / deepest
        fourth = ratio * ratio * ratio * ratio
        weight, family = 1.0, search.family[k]
        if family == CORNER:
            corners += fourth * fourth
        elif family == EDGES_APART:
            weight = EDGE_WEIGHT * (1.0 - sunk)
            apart += EDGE_WEIGHT * fourth * fourth
        else:
            # Each pair of sunk edges gives two points.
            weight = EDGE_WEIGHT * (0.5 * sunk if family == EDGES_SUNK else 1.0)
            below += (0.5 if family == EDGES_SUNK else 1.0) * EDGE_WEIGHT * fourth * fourth
        search.share[k] = weight * fourth * ratio * ratio * ratio
    total = corners + (1.0 - sunk) * apart + sunk * below
    root = ((total**0.5) ** 0.5) ** 0.5
    centre, force, weight = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0
    for k in range(count):
        search.share[k] *= root / total
        centre = plus(centre, scaled(search.share[k], row(search.point, k)))
        force = plus(force, scaled(search.share[k], row(search.normal, k)))
        weight += search.share[k]
    if slope > 0.0:
        # As the patch deepens, edges apart pass into sunk ones: that too changes the energy.
        search.share[deepest_apart(search, count)] += 0.125 * (below - apart) * slope * deepest * root / total
    size = dot(force, force) ** 0.5
    # Forces of all directions that cancel: every normal is as good as another.
    normal = scaled(1.0 / size, force) if size > 0.0 else (0.0, 0.0, 1.0)
    return deepest * root, scaled(1.0 / weight, centre), normal


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
