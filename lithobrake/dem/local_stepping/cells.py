"""In which cell of a grid each body stands, so that neighbours of one body are searched near it alone.

A body stands in the cell of where it was when its own neighbours were last searched; until the next search it moves by
half the skin at most. Bodies that are much larger than most stand in no cell and are always looked at.
"""

from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Bodies
from lithobrake.dem.bodies.vectors import minus, plus, row
from lithobrake.vocabulary.array_types import Floats, Integers, Vector

Place = tuple[int, int, int]  # numbers of a cell along the axes

# Largest bounding radius of what stands in a cell, over the median.
LARGEST = 2.0
# Most cells, for each body: costs or saves time alone.
MOST_CELLS = 8


class Cells(NamedTuple):
    """A grid of cells along the axes; what is beyond it stands in the cells at its border.

    Where the world repeats, so do the cells: a whole number of them fills a period.
    """

    corner: Floats  # [3], m
    size: Floats  # [3], m, of a cell
    numbers: Integers  # [3], cells along each axis
    lowest: Floats  # [3], number of the first cell along each axis; where the world repeats, there is none
    highest: Floats  # [3], number of the last; where the world repeats, there is none
    first: Integers  # [cells], first body in each, -1: none
    following: Integers  # [body_count], next body in the same cell, -1: none
    before: Integers  # [body_count], the one before, -1: none
    cell: Integers  # [body_count], -1: in none
    large: Integers  # [large_count], bodies in no cell
    found: Integers  # [body_count], what was last gathered
    reach: Floats  # [1], m, that a body in a cell may reach beyond where it was put there


def cells_of(bodies: Bodies, skin: float) -> Cells:
    """Return the cells for bodies, none of which stands in its cell yet; skin [m]."""
    radius, n = bodies.bounding_radius, len(bodies.mass)
    period = np.array([bodies.period.x, bodies.period.y, 0.0])
    repeats = period > 0.0
    # A lander among grains would otherwise make every cell as large as itself.
    is_large = radius > LARGEST * np.median(radius)
    reach = float(radius[~is_large].max()) + 0.5 * skin
    size = 2.0 * reach
    corner = bodies.position.min(axis=0)
    extent = np.where(repeats, period, bodies.position.max(axis=0) - corner)
    # One body that was thrown far away would otherwise spread cells over empty space.
    while np.prod(np.floor(extent / size) + 1.0) > MOST_CELLS * n:
        size *= 2.0
    count = np.where(repeats, np.maximum(np.floor(extent / size), 1.0), np.floor(extent / size) + 1.0).astype(np.int64)
    return Cells(
        corner, np.where(repeats, period / count, size), count, np.where(repeats, -np.inf, 0.0),
        np.where(repeats, np.inf, count - 1.0), np.full(int(np.prod(count)), -1), np.full(n, -1), np.full(n, -1),
        np.where(is_large, -1, 0), np.flatnonzero(is_large), np.full(n, -1),
        np.array([reach]),
    )  # fmt: skip


@kernel
def cell_along(cells: Cells, place: Vector) -> Place:
    """Return the numbers along the axes of the cell in which a place [m] lies, or of the nearest to it.

    Where the world repeats, they count on from period to period.
    """
    return (number_along(cells, 0, place[0]), number_along(cells, 1, place[1]), number_along(cells, 2, place[2]))


@kernel
def number_along(cells: Cells, axis: int, along: float) -> int:
    """Return the number of the cell at a coordinate [m], see cell_along."""
    number = (along - cells.corner[axis]) / cells.size[axis]
    return int(np.floor(min(max(number, cells.lowest[axis]), cells.highest[axis])))


@kernel
def gather_near(cells: Cells, here: Vector, reach: float) -> int:
    """Gather all bodies that may come within reach [m] of a place, and others; return how many. Writes to cells."""
    count = len(cells.large)
    for k in range(count):
        cells.found[k] = cells.large[k]
    way = reach + cells.reach[0]
    low, high = cell_along(cells, minus(here, (way, way, way))), cell_along(cells, plus(here, (way, way, way)))
    # At most once round, so that none is gathered twice.
    for i in range(low[0], min(high[0], low[0] + cells.numbers[0] - 1) + 1):
        for j in range(low[1], min(high[1], low[1] + cells.numbers[1] - 1) + 1):
            for k in range(low[2], high[2] + 1):
                body = cells.first[number_of(cells, (i, j, k))]
                while body >= 0:
                    cells.found[count] = body
                    count += 1
                    body = cells.following[body]
    return count


@kernel
def number_of(cells: Cells, place: Place) -> int:
    i, j = place[0] % cells.numbers[0], place[1] % cells.numbers[1]
    return (i * cells.numbers[1] + j) * cells.numbers[2] + place[2]


@kernel
def put_in_cell(bodies: Bodies, cells: Cells, body: int) -> None:
    """Put a body in the cell of where it is. Writes to cells."""
    cell = number_of(cells, cell_along(cells, row(bodies.position, body)))
    after = cells.first[cell]
    cells.following[body], cells.before[body], cells.cell[body] = after, -1, cell
    if after >= 0:
        cells.before[after] = body
    cells.first[cell] = body


@kernel
def move_to_cell(bodies: Bodies, cells: Cells, body: int) -> None:
    """Put a body that stands in a cell in that of where it is now. Writes to cells."""
    cell, before, after = cells.cell[body], cells.before[body], cells.following[body]
    if cell < 0:
        return
    if before >= 0:
        cells.following[before] = after
    else:
        cells.first[cell] = after
    if after >= 0:
        cells.before[after] = before
    put_in_cell(bodies, cells, body)
