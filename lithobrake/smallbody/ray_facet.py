"""Where a straight line meets the facets of a shape.

Source: [Moeller-1997].
"""

import numpy as np

from lithobrake.compilation.compiled import compiled, kernel, large_kernel
from lithobrake.smallbody.arrays import Floats, Integers
from lithobrake.smallbody.grid import Grid, cell_of

RIM = 1e-9  # part of a facet by which it is widened, so that a line through a common edge meets at least one facet


@kernel
def intersect_facet(corner: Floats, f: int, origin: Floats, along: Floats) -> tuple[float, float]:
    """Multiple of `along` at which the line meets facet f (nan: it does not), and the side it comes from.

    corner: vertices of the facets [m], [facet_count, 3, 3]; the side is positive where the line goes from outside
    inwards.
    """
    ax, ay, az = corner[f, 0, 0], corner[f, 0, 1], corner[f, 0, 2]
    ux, uy, uz = corner[f, 1, 0] - ax, corner[f, 1, 1] - ay, corner[f, 1, 2] - az
    vx, vy, vz = corner[f, 2, 0] - ax, corner[f, 2, 1] - ay, corner[f, 2, 2] - az
    px, py, pz = along[1] * vz - along[2] * vy, along[2] * vx - along[0] * vz, along[0] * vy - along[1] * vx
    side = ux * px + uy * py + uz * pz
    if side == 0.0:
        return np.nan, 0.0
    tx, ty, tz = origin[0] - ax, origin[1] - ay, origin[2] - az
    u = (tx * px + ty * py + tz * pz) / side
    if not -RIM <= u <= 1.0 + RIM:
        return np.nan, side
    qx, qy, qz = ty * uz - tz * uy, tz * ux - tx * uz, tx * uy - ty * ux
    v = (along[0] * qx + along[1] * qy + along[2] * qz) / side
    if not (v >= -RIM and u + v <= 1.0 + RIM):
        return np.nan, side
    return (vx * qx + vy * qy + vz * qz) / side, side


@large_kernel
def first_entry(grid: Grid, corner: Floats, origin: Floats, along: Floats) -> tuple[float, int]:
    """Where the chord from origin to origin + along first goes from outside inwards: fraction of the chord, and facet.

    The facet is -1 where it does not. Meant for chords no longer than a few cells.
    """
    size, start, facets = grid.size, grid.start, grid.facets
    i, j, k = cell_of(grid, origin[0], origin[1], origin[2])
    u, v, w = cell_of(grid, origin[0] + along[0], origin[1] + along[1], origin[2] + along[2])
    best, hit = np.inf, -1
    for a in range(max(min(i, u), 0), min(max(i, u), size[0] - 1) + 1):
        for b in range(max(min(j, v), 0), min(max(j, v), size[1] - 1) + 1):
            for c in range(max(min(k, w), 0), min(max(k, w), size[2] - 1) + 1):
                cell = (a * size[1] + b) * size[2] + c
                for entry in range(start[cell], start[cell + 1]):
                    fraction, side = intersect_facet(corner, facets[entry], origin, along)
                    if side > 0.0 and 0.0 <= fraction <= 1.0 and fraction < best:
                        best, hit = fraction, facets[entry]
    return best, hit


@compiled
def outermost_hit(corner: Floats, directions: Floats, distance: Floats, facet: Integers) -> None:
    """Write the farthest hit of rays from the origin along `directions` [count, 3]: distance [m] (nan: none), facet."""
    origin = np.zeros(3)
    for r in range(len(directions)):
        distance[r], facet[r] = np.nan, -1
        for f in range(len(corner)):
            t, side = intersect_facet(corner, f, origin, directions[r])
            # Going outwards the line leaves the body: the side is negative.
            if side < 0.0 and t > 0.0 and not t <= distance[r]:
                distance[r], facet[r] = t, f
