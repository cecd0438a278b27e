"""Gravity at points near and far in one call."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lithobrake.compilation.compiled import compiled, kernel, large_kernel
from lithobrake.smallbody.gravity_table import GravityTable, level_of, read_table
from lithobrake.smallbody.multipole import SCRATCH, Multipole, series_block
from lithobrake.smallbody.polyhedron_gravity import ROWS, PolyhedronTerms, field_block
from lithobrake.smallbody.simd import LANES, WIDTH
from lithobrake.vocabulary.array_types import Floats, Integers


class Gravity(NamedTuple):
    """What the gravity of one shape is read from: its facets, its series, and a table, which may be empty."""

    polyhedron: PolyhedronTerms
    multipole: Multipole
    table: GravityTable


class Workspace(NamedTuple):
    near: Floats  # [ROWS * LANES], block of the near points
    far: Floats  # [ROWS * LANES], block of the far points
    lane: Integers  # [2 LANES], lanes of the near points, then of the far ones
    distance: Floats  # [vertex_count * LANES]
    series: Floats  # [SCRATCH]
    weight: Floats  # [3, 4], of the splines
    total: Floats  # [12], sums of the splines
    turn: Floats  # [9, LANES], the body's axes; then cosines and sines of the partner's place and attitude


@compiled
def workspace(vertex_count: int) -> Workspace:
    return Workspace(
        np.zeros(ROWS * LANES),
        np.zeros(ROWS * LANES),
        np.empty(2 * LANES, dtype=np.int64),
        np.empty(vertex_count * LANES),
        np.zeros(SCRATCH),
        np.empty((3, 4)),
        np.empty(12),
        np.empty((9, LANES)),
    )


@kernel
def _pad_block(block: Floats, count: int) -> int:
    """Repeat the first point up to a multiple of WIDTH points: points left over would be done one at a time."""
    full = (count + WIDTH - 1) // WIDTH * WIDTH
    for j in range(count, full):
        for i in range(3):
            block[i * LANES + j] = block[i * LANES]
    return full


@large_kernel
def attract(lane: Floats, count: int, scratch: Workspace, gravity: Gravity) -> None:
    """Field of one block, as field_block: lane [ROWS * LANES], reads rows X, Y, Z of `count` points, writes the others.

    A point that the table serves gets the pull only.
    """
    near, far, index = scratch.near, scratch.far, scratch.lane
    table, centre, nearest = gravity.table, gravity.multipole.centre, gravity.multipole.nearest
    # Near and far points go into blocks of their own, since either way runs over many lanes at once without a branch.
    near_count = far_count = 0
    for j in range(count):
        x, y, z = lane[j], lane[LANES + j], lane[2 * LANES + j]
        level = level_of(x, y, z, table)
        if level >= 0:
            pull = read_table(x, y, z, level, table, scratch.weight, scratch.total)
            lane[3 * LANES + j], lane[4 * LANES + j], lane[5 * LANES + j] = pull
            continue
        square = (x - centre[0]) ** 2 + (y - centre[1]) ** 2 + (z - centre[2]) ** 2
        if square < nearest * nearest:
            near[near_count], near[LANES + near_count], near[2 * LANES + near_count] = x, y, z
            index[near_count] = j
            near_count += 1
        else:
            far[far_count], far[LANES + far_count], far[2 * LANES + far_count] = x, y, z
            index[LANES + far_count] = j
            far_count += 1
    if near_count:
        field_block(near, _pad_block(near, near_count), scratch.distance, gravity.polyhedron)
        for k in range(near_count):
            for row in range(3, ROWS):
                lane[row * LANES + index[k]] = near[row * LANES + k]
    if far_count:
        series_block(far, _pad_block(far, far_count), scratch.series, gravity.multipole)
        for k in range(far_count):
            for row in range(3, ROWS):
                lane[row * LANES + index[LANES + k]] = far[row * LANES + k]


@compiled
def _evaluate(points: Floats, result: Floats, gravity: Gravity) -> None:
    lane, scratch = np.zeros(ROWS * LANES), workspace(len(gravity.polyhedron.vertices))
    for start in range(0, len(points), LANES):
        count = min(LANES, len(points) - start)
        for j in range(count):
            for i in range(3):
                lane[i * LANES + j] = points[start + j, i]
        attract(lane, count, scratch, gravity)
        for j in range(count):
            for i in range(5):
                result[start + j, i] = lane[(3 + i) * LANES + j]
            # A block holds twice the potential.
            result[start + j, 3] *= 0.5


def field(points: NDArray[np.float64], gravity: Gravity) -> NDArray[np.float64]:
    """Field sums without the factor G density, at points [m], shape [count, 3].

    Gives [count, 5]: acceleration x, y, z [m], potential (positive) [m2], and minus the Laplacian [1]: 4 pi inside,
    0 outside, 2 pi on a facet.
    """
    result = np.empty((len(points), 5))
    _evaluate(np.ascontiguousarray(points, dtype=np.float64), result, gravity)
    return result
