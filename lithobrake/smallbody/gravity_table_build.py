"""Filling the gravity table of a shape, measuring its error, and keeping it on disk."""

import hashlib
import io
import logging
import math
import os
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lithobrake.compilation.compiled import compiled, disk_cache
from lithobrake.smallbody import attraction
from lithobrake.smallbody.attraction import Gravity
from lithobrake.smallbody.facet_grid import Grid, near_heights, pseudonormals
from lithobrake.smallbody.gravity_table import CORE, MARGIN, RIM, GravityTable, point_mass, spline_coefficients
from lithobrake.smallbody.multipole import Multipole
from lithobrake.smallbody.polyhedron_gravity import PolyhedronTerms
from lithobrake.vocabulary.array_types import Floats

SKIN = 6  # cells below the surface over which the continued field goes over into the one inside
PIECE = 8192  # points that a thread takes at a time

log = logging.getLogger(__name__)


class TableError(NamedTuple):
    """Difference of table and facets, relative to the mean gravity on the surface, at points spread over its use."""

    median: float
    p95: float
    largest: float
    point_count: int


Levels = tuple[tuple[float, float], ...]


def gravity_table_of(
    polyhedron: PolyhedronTerms, multipole: Multipole, volume: float, levels: Levels
) -> tuple[GravityTable, TableError]:
    """The table of a shape and its error, from disk where it was built before; the name there is a hash of the mesh.

    levels: cells and reach of each grid (see gravity_table.LEVELS).
    """
    # The code has no part in the name: the folder is named by the hash of all sources.
    mesh = polyhedron.vertices.tobytes() + polyhedron.facet_corners.tobytes()
    digest = hashlib.sha256(repr(levels).encode() + mesh).hexdigest()[:24]
    disk, name = disk_cache("smallbody"), f"gravity-{digest}.npz"
    kept = disk.read(name)
    if kept is not None:
        with np.load(io.BytesIO(kept), allow_pickle=False) as stored:
            table = GravityTable(*(_plain(stored[name]) for name in GravityTable._fields))
            median, p95, largest, count = stored["error"].tolist()
            return table, TableError(median, p95, largest, int(count))
    table = _build(polyhedron, multipole, volume, levels)
    error = _measure(table, polyhedron, multipole)
    disk.write(name, _file(table, error))
    log.info(
        "gravity table of %d facets: error %.1e median, %.1e p95, %.1e largest of surface gravity at %d points; %s",
        *(len(polyhedron.facet_corners), error.median, error.p95, error.largest, error.point_count, name),
    )
    return table, error


def _plain(array: NDArray[Any]) -> Any:
    return float(array) if array.ndim == 0 else array


def _file(table: GravityTable, error: TableError) -> bytes:
    file = io.BytesIO()
    np.savez(file, error=np.array(error, dtype=np.float64), **table._asdict())
    return file.getvalue()


def _build(polyhedron: PolyhedronTerms, multipole: Multipole, volume: float, levels: Levels) -> GravityTable:
    """Sample each grid with the facets' sums or the series, continue below the surface, turn into splines."""
    # From two radii on the series is off by 1e-7 or less, far below what the splines lose, and ten times faster.
    closer = multipole._replace(nearest=min(multipole.nearest, 2.0 * multipole.radius))
    gravity = Gravity(polyhedron, closer, GravityTable.empty())
    core = CORE * (3.0 * volume / (4.0 * math.pi)) ** (1.0 / 3.0)
    lower, upper = polyhedron.vertices.min(axis=0), polyhedron.vertices.max(axis=0)
    grids: list[tuple[NDArray[np.float64], NDArray[np.int64], float]] = []
    values: list[NDArray[np.float64]] = []
    served: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
    for fineness, reach in levels:
        edge = fineness * multipole.radius
        if served is None:
            first, last = lower - MARGIN * edge, upper + MARGIN * edge
        else:
            first, last = multipole.centre - reach * multipole.radius, multipole.centre + reach * multipole.radius
            # Two of its own cells beyond the range of the finer grid, as the rim of a grid serves no points itself.
            first, last = np.minimum(first, served[0] - 2 * edge), np.maximum(last, served[1] + 2 * edge)
        size = np.ceil((last - first) / edge).astype(np.int64) + 1
        nodes = first + edge * np.indices(size).reshape(3, -1).T
        needed = np.ones(len(nodes), dtype=bool)
        if served is not None:
            # Deep inside the finer grid this one is never read.
            needed = ~((nodes > served[0] + 4 * edge) & (nodes < served[1] - 4 * edge)).all(axis=1)
        sample = np.zeros((len(nodes), 3))
        sample[needed] = _sample(nodes[needed], gravity, multipole.centre, volume, core)
        if served is None:
            sample -= 4.0 * math.pi * _continuation(nodes, polyhedron, SKIN * edge)
        values.append(spline_coefficients(sample.reshape(*size, 3)).reshape(-1))
        grids.append((first, size, edge))
        served = first + RIM * edge, first + (size - 1 - RIM) * edge
    starts = np.cumsum([0, *(len(level) for level in values[:-1])])
    corner, cells, cell = (np.array(column) for column in zip(*grids, strict=True))
    rim = RIM * cell[:, None]
    return GravityTable(
        *(multipole.centre, volume, core, corner, cell, cells, starts, np.concatenate(values)),
        first=corner + rim,
        last=corner + (cells - 1) * cell[:, None] - rim,
    )


def _sample(points: Floats, gravity: Gravity, centre: Floats, volume: float, core: float) -> Floats:
    """Field sums less the point mass at points [m], shape [count, 3], on all cores."""
    result = np.empty((len(points), 3))

    def part(first: int) -> None:
        piece = slice(first, first + PIECE)
        result[piece] = attraction.field(points[piece], gravity)[:, :3]
        _subtract(points[piece], result[piece], centre, volume, core)

    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        list(pool.map(part, range(0, len(points), PIECE)))
    return result


@compiled
def _subtract(points: Floats, sample: Floats, centre: Floats, volume: float, core: float) -> None:
    """Take the point mass out of sample [count, 3]."""
    for i in range(len(points)):
        x, y, z = point_mass(points[i, 0], points[i, 1], points[i, 2], centre, volume, core)
        sample[i, 0] -= x
        sample[i, 1] -= y
        sample[i, 2] -= z


def _continuation(nodes: NDArray[np.float64], polyhedron: PolyhedronTerms, skin: float) -> NDArray[np.float64]:
    """What density adds below the surface, over 4 pi: the depth along the normal [m], faded out over `skin`, [count,
    3].

    Outside, the field does not know the density it is near; below a plane facet the density adds 4 pi G density times
    the depth, along the normal. Without that the field goes on as if the facet were not there.
    """
    faces = polyhedron.facet_corners
    normals = polyhedron.facet_terms[:, :3]
    corner = np.ascontiguousarray(polyhedron.vertices[faces])
    grid = Grid.of(polyhedron.vertices, faces, edge=skin)
    height, facet = np.empty(len(nodes)), np.empty(len(nodes), dtype=np.int64)
    # Flights ask with points in rows, one after the other; other strides would be compiled for themselves.
    rows, outward = np.ascontiguousarray(nodes), pseudonormals(polyhedron.vertices, faces, normals)
    near_heights(grid, corner, outward, rows, height, facet)
    result = np.zeros_like(nodes)
    under = np.flatnonzero((height < 0.0) & (height > -skin))
    normal = normals[facet[under]]
    depth = np.einsum("ni,ni->n", corner[facet[under], 0] - nodes[under], normal)
    sunk = np.clip(-height[under] / skin, 0.0, 1.0)
    fade = np.where(sunk < 0.5, 1.0, 0.5 * (1.0 + np.cos(2.0 * np.pi * (sunk - 0.5))))
    result[under] = (depth * fade)[:, None] * normal
    return result


def _measure(table: GravityTable, polyhedron: PolyhedronTerms, multipole: Multipole) -> TableError:
    """Compare on points from the surface out to the last grid, most of them near the surface."""
    exact = Gravity(polyhedron, multipole, GravityTable.empty())
    random = np.random.default_rng(0)
    area = polyhedron.facet_terms[:, 3]
    facet = random.choice(len(area), 6000, p=area / area.sum())
    weight = random.dirichlet(np.ones(3), len(facet))
    ground = np.einsum("nc,nci->ni", weight, polyhedron.vertices[polyhedron.facet_corners[facet]])
    # Evenly in the logarithm, as the error is largest near the ground, where flights begin and end.
    rise = multipole.radius * 10.0 ** random.uniform(-4.0, 0.8, len(facet))
    points = ground + rise[:, None] * polyhedron.facet_terms[facet, :3]
    outside = attraction.field(points, exact)
    # Up the normal of one facet a point may lie in the ground of another.
    free = outside[:, 4] < 1e-3
    difference = attraction.field(points, Gravity(polyhedron, multipole, table))[:, :3] - outside[:, :3]
    scale = np.linalg.norm(attraction.field(ground, exact)[:, :3], axis=1).mean()
    error = np.linalg.norm(difference[free], axis=1) / scale
    return TableError(float(np.median(error)), float(np.quantile(error, 0.95)), float(error.max()), len(error))
