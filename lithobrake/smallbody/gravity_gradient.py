"""How gravity changes from place to place: the second derivatives of the potential, near and far.

Source: [Werner-1996], Eq 17's companion for the gradient matrix (sum of edge dyads and logarithms less facet dyads and
solid angles); far away the harmonics of multipole.py, whose derivative is a series again, with shifted moments.
"""

import numpy as np
from numpy.typing import NDArray

from lithobrake.compilation.compiled import compiled
from lithobrake.smallbody.arrays import Floats
from lithobrake.smallbody.multipole import Multipole
from lithobrake.smallbody.polyhedron_gravity import PolyhedronTerms
from lithobrake.smallbody.simd import angle, log_ratio

# Place of xx, yy, zz, xy, xz, yz in a 3 x 3 matrix.
MATRIX = np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])


def gradient(points: NDArray[np.float64], polyhedron: PolyhedronTerms, multipole: Multipole) -> NDArray[np.float64]:
    """Derivatives of the field sums without the factor G density, at points [m], shape [count, 3]: [count, 3, 3].

    On an edge they grow without bound; there, and nearer than 1e-16 of its length, a large finite value is given. On a
    facet it is the mean of the two sides.
    """
    result = np.empty((len(points), 3, 3))
    far = np.linalg.norm(points - multipole.centre, axis=1) >= multipole.nearest
    six = np.zeros((int((~far).sum()), 6))
    _near(np.ascontiguousarray(points[~far]), six, polyhedron)
    result[~far] = six[:, MATRIX]
    for axis, part in enumerate(_acceleration_series(multipole)):
        result[far, axis] = part.field(points[far])[:, :3] / multipole.radius
    # Each of the two ways to a mixed derivative rounds on its own.
    return 0.5 * (result + result.transpose(0, 2, 1))


def _acceleration_series(multipole: Multipole) -> list[Multipole]:
    """The series whose potentials are the accelerations x, y, z of a series, in units of its radius.

    The acceleration from moment (n - 1, m) is a sum of harmonics (n, m - 1), (n, m), (n, m + 1), as in
    multipole._add_harmonic; read as the potential of moments of degree n, it has an acceleration of its own.
    """
    top, wide = multipole.real.shape
    moment = np.zeros((top + 1, wide + 2), dtype=complex)
    # One place to the left of order 0, which stays empty: the code of the series has nothing there either.
    moment[1:, 1:-1] = multipole.real + 1j * multipole.imaginary
    below, level, above = moment[:, :-2], moment[:, 1:-1], moment[:, 2:]
    weight = np.where(np.arange(wide) == 0, 1.0, 2.0)
    parts = ((below - above) / weight, -1j * (below + above) / weight, -level)
    for part in parts:
        # The harmonics of order 0 are real, so nothing has asked for this half of their moments yet.
        part[:, 0] = part[:, 0].real
    pad = ((0, 0), (0, 1))
    return [
        Multipole(
            multipole.centre,
            multipole.radius,
            np.ascontiguousarray(np.pad(part.real, pad)),
            np.ascontiguousarray(np.pad(part.imag, pad)),
            multipole.nearest,
            multipole.error,
        )
        for part in parts
    ]


@compiled
def _near(points: Floats, result: Floats, polyhedron: PolyhedronTerms) -> None:
    """Add to result [count, 6], point by point, the edges' sums E L less the facets' sums n n omega."""
    vertices, ends, edge_terms = polyhedron.vertices, polyhedron.edge_ends, polyhedron.edge_terms
    corners, facet_terms = polyhedron.facet_corners, polyhedron.facet_terms
    distance, offset = np.empty(len(vertices)), np.empty((len(vertices), 3))
    for p in range(len(points)):
        for v in range(len(vertices)):
            for i in range(3):
                offset[v, i] = vertices[v, i] - points[p, i]
            distance[v] = np.sqrt(offset[v, 0] ** 2 + offset[v, 1] ** 2 + offset[v, 2] ** 2)
        for e in range(len(ends)):
            line = log_ratio(distance[ends[e, 0]] + distance[ends[e, 1]], edge_terms[e, 0])
            for k in range(6):
                result[p, k] += line * edge_terms[e, 1 + k]
        for f in range(len(corners)):
            a, b, c = corners[f, 0], corners[f, 1], corners[f, 2]
            height = below = 0.0
            for i in range(3):
                height += facet_terms[f, i] * offset[a, i]
                below += distance[a] * offset[b, i] * offset[c, i] + distance[b] * offset[c, i] * offset[a, i]
                below += distance[c] * offset[a, i] * offset[b, i]
            below += distance[a] * distance[b] * distance[c]
            solid = 2.0 * angle(height * facet_terms[f, 3], below) if height != 0.0 else 0.0
            nx, ny, nz = facet_terms[f, 0], facet_terms[f, 1], facet_terms[f, 2]
            result[p, 0] -= solid * nx * nx
            result[p, 1] -= solid * ny * ny
            result[p, 2] -= solid * nz * nz
            result[p, 3] -= solid * nx * ny
            result[p, 4] -= solid * nx * nz
            result[p, 5] -= solid * ny * nz
