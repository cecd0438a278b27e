"""The gravity of a body of constant density whose surface is plane triangles, exactly.

Source: [Werner-1996], Eqs 10-17.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lithobrake.compilation.compiled import compiled
from lithobrake.smallbody.simd import LANES, angle, fma, log_ratio
from lithobrake.vocabulary.array_types import Floats

# Rows of a block of points: `lane[row * LANES + j]` belongs to point j. The first three are read, the others written.
X, Y, Z, PULL_X, PULL_Y, PULL_Z, POTENTIAL, SOLID_ANGLE = 0, 1, 2, 3, 4, 5, 6, 7
ROWS = 8
# A height over the plane of a facet is known to this part of the coordinates that it is made of.
ROUNDING = 16.0 * 2.0**-52


class PolyhedronTerms(NamedTuple):
    """What the kernels read of a shape, all lengths [m].

    vertices          [vertex_count, 3]
    edge_ends         vertex indices, [edge_count, 2]
    edge_terms        length, then the dyad xx, yy, zz, xy, xz, yz of Eq 12, [edge_count, 7]
    facet_corners     vertex indices, counter-clockwise from outside, [facet_count, 3]
    facet_terms       outward unit normal, then twice the area [m2], [facet_count, 4]
    """

    vertices: NDArray[np.float64]
    edge_ends: NDArray[np.int64]
    edge_terms: NDArray[np.float64]
    facet_corners: NDArray[np.int64]
    facet_terms: NDArray[np.float64]

    @classmethod
    def of(cls, vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> "PolyhedronTerms":
        """Precompute normals and edge dyads of a closed, outward oriented surface of triangles."""
        corner = vertices[faces]
        doubled = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        area = np.linalg.norm(doubled, axis=1)
        normal = doubled / area[:, None]
        directed = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        owner = np.tile(np.arange(len(faces)), 3)
        forward = directed[:, 0] < directed[:, 1]
        # Each edge occurs once in either direction; sorted by its ends, the two lists run in step.
        there, back = directed[forward], directed[~forward][:, ::-1]
        order, order_back = np.lexsort(there.T[::-1]), np.lexsort(back.T[::-1])
        ends, left, right = there[order], owner[forward][order], owner[~forward][order_back]
        along = vertices[ends[:, 1]] - vertices[ends[:, 0]]
        length = np.linalg.norm(along, axis=1)
        unit = along / length[:, None]
        dyad = np.einsum("ei,ej->eij", normal[left], np.cross(unit, normal[left]))
        dyad += np.einsum("ei,ej->eij", normal[right], np.cross(-unit, normal[right]))
        six = [dyad[:, 0, 0], dyad[:, 1, 1], dyad[:, 2, 2]]
        # Rounding leaves the dyad not quite symmetric.
        six += [0.5 * (dyad[:, i, j] + dyad[:, j, i]) for i, j in ((0, 1), (0, 2), (1, 2))]
        return cls(
            np.ascontiguousarray(vertices),
            np.ascontiguousarray(ends),
            np.ascontiguousarray(np.stack([length, *six], axis=1)),
            np.ascontiguousarray(faces),
            np.ascontiguousarray(np.column_stack([normal, area])),
        )

    def field(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Sums of Eqs 10, 15 and 16 without the factor G density, at points [m], shape [count, 3].

        Gives [count, 5]: acceleration x, y, z [m], potential (positive) [m2], and minus the Laplacian [1]: 4 pi inside,
        0 outside, 2 pi on a facet.
        """
        result = np.empty((len(points), 5))
        _field(np.ascontiguousarray(points, dtype=np.float64), result, self)
        return result


@compiled
def _distances(lane: Floats, count: int, distance: Floats, vertices: Floats) -> None:
    """Write the distance of every vertex to every point of the block, [vertex_count * LANES]."""
    # Once for each vertex: some six edges and six facets meet there, and share its distance.
    for v in range(len(vertices)):
        vx, vy, vz = vertices[v, 0], vertices[v, 1], vertices[v, 2]
        row = distance[v * LANES : v * LANES + LANES]
        for j in range(count):
            x, y, z = vx - lane[X * LANES + j], vy - lane[Y * LANES + j], vz - lane[Z * LANES + j]
            row[j] = np.sqrt(fma(x, x, fma(y, y, z * z)))


@compiled
def _add_edges(lane: Floats, count: int, distance: Floats, polyhedron: PolyhedronTerms) -> None:
    """Add the edge sums: E r L to the pull (sign turned), r E r L to the potential."""
    vertices, ends, terms = polyhedron.vertices, polyhedron.edge_ends, polyhedron.edge_terms
    for e in range(len(ends)):
        a, b = ends[e, 0], ends[e, 1]
        vx, vy, vz = vertices[a, 0], vertices[a, 1], vertices[a, 2]
        length = terms[e, 0]
        xx, yy, zz = terms[e, 1], terms[e, 2], terms[e, 3]
        xy, xz, yz = terms[e, 4], terms[e, 5], terms[e, 6]
        first = distance[a * LANES : a * LANES + LANES]
        second = distance[b * LANES : b * LANES + LANES]
        for j in range(count):
            x, y, z = vx - lane[X * LANES + j], vy - lane[Y * LANES + j], vz - lane[Z * LANES + j]
            line = log_ratio(first[j] + second[j], length)
            px = line * fma(xx, x, fma(xy, y, xz * z))
            py = line * fma(xy, x, fma(yy, y, yz * z))
            pz = line * fma(xz, x, fma(yz, y, zz * z))
            lane[PULL_X * LANES + j] -= px
            lane[PULL_Y * LANES + j] -= py
            lane[PULL_Z * LANES + j] -= pz
            lane[POTENTIAL * LANES + j] += fma(x, px, fma(y, py, z * pz))


@compiled
def _add_facets(lane: Floats, count: int, distance: Floats, polyhedron: PolyhedronTerms) -> None:
    """Add the facet sums with the solid angle of Eq 27, which is 2 atan2(r1.(r2 x r3), ...)."""
    vertices, corners, terms = polyhedron.vertices, polyhedron.facet_corners, polyhedron.facet_terms
    for f in range(len(corners)):
        a, b, c = corners[f, 0], corners[f, 1], corners[f, 2]
        ax, ay, az = vertices[a, 0], vertices[a, 1], vertices[a, 2]
        bx, by, bz = vertices[b, 0], vertices[b, 1], vertices[b, 2]
        cx, cy, cz = vertices[c, 0], vertices[c, 1], vertices[c, 2]
        nx, ny, nz, area = terms[f, 0], terms[f, 1], terms[f, 2], terms[f, 3]
        size = abs(ax) + abs(ay) + abs(az)
        first = distance[a * LANES : a * LANES + LANES]
        second = distance[b * LANES : b * LANES + LANES]
        third = distance[c * LANES : c * LANES + LANES]
        for j in range(count):
            x, y, z = lane[X * LANES + j], lane[Y * LANES + j], lane[Z * LANES + j]
            x1, y1, z1 = ax - x, ay - y, az - z
            x2, y2, z2 = bx - x, by - y, bz - z
            x3, y3, z3 = cx - x, cy - y, cz - z
            d1, d2, d3 = first[j], second[j], third[j]
            height = fma(nx, x1, fma(ny, y1, nz * z1))
            below = d1 * fma(x2, x3, fma(y2, y3, fma(z2, z3, d2 * d3)))
            below = fma(d2, fma(x3, x1, fma(y3, y1, z3 * z1)), below)
            below = fma(d3, fma(x1, x2, fma(y1, y2, z1 * z2)), below)
            # r1.(r2 x r3) is the height over the facet's plane times twice the area. In that plane the angle jumps
            # between two values; their mean, zero, makes the sum on a facet the mean of inside and outside.
            solid = 2.0 * angle(height * area, below) if height != 0.0 else 0.0
            # Of a point on a facet that is no plane of the axes rounding leaves a height, which counts as none.
            filled = solid if abs(height) > ROUNDING * (size + d1) else 0.0
            pull = solid * height
            lane[PULL_X * LANES + j] = fma(pull, nx, lane[PULL_X * LANES + j])
            lane[PULL_Y * LANES + j] = fma(pull, ny, lane[PULL_Y * LANES + j])
            lane[PULL_Z * LANES + j] = fma(pull, nz, lane[PULL_Z * LANES + j])
            lane[POTENTIAL * LANES + j] -= pull * height
            lane[SOLID_ANGLE * LANES + j] += filled


@compiled
def field_block(lane: Floats, count: int, distance: Floats, polyhedron: PolyhedronTerms) -> None:
    """Field of one block. lane [ROWS * LANES]: reads X, Y, Z of the first `count` points, writes the other rows.

    distance [vertex_count * LANES] is scratch. The pull is acceleration / (G density), POTENTIAL twice the potential.
    """
    for row in range(PULL_X, ROWS):
        for j in range(count):
            lane[row * LANES + j] = 0.0
    _distances(lane, count, distance, polyhedron.vertices)
    _add_edges(lane, count, distance, polyhedron)
    _add_facets(lane, count, distance, polyhedron)


@compiled
def _field(points: Floats, result: Floats, polyhedron: PolyhedronTerms) -> None:
    lane = np.zeros(ROWS * LANES)
    distance = np.empty(len(polyhedron.vertices) * LANES)
    for start in range(0, len(points), LANES):
        count = min(LANES, len(points) - start)
        for j in range(count):
            for i in range(3):
                lane[i * LANES + j] = points[start + j, i]
        field_block(lane, count, distance, polyhedron)
        for j in range(count):
            for i in range(3):
                result[start + j, i] = lane[(PULL_X + i) * LANES + j]
            result[start + j, 3] = 0.5 * lane[POTENTIAL * LANES + j]
            result[start + j, 4] = lane[SOLID_ANGLE * LANES + j]
