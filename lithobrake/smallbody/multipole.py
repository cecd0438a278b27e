"""Gravity far from a body as a series of solid harmonics, where the sums over facets lose their digits.

Far away the facets' terms cancel to ever fewer digits, while a series needs ever fewer terms. Sources:
[Dehnen-2014], appendix A (harmonics, their recursions and derivatives); [Werner-1997] (cones from the centre reduce the
integrals to facets).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lithobrake.compilation.compiled import compiled
from lithobrake.smallbody.polyhedron_gravity import POTENTIAL, PULL_X, PULL_Y, PULL_Z, PolyhedronTerms
from lithobrake.smallbody.simd import LANES
from lithobrake.vocabulary.array_types import Floats

DEGREE = 20
# Flights need 1e-9, but a user who compares codes at two or three radii would find that a hundred times the difference
# of two sums over facets.
LARGEST_ERROR = 2e-11  # of the acceleration, at the radius from which the series is used
RADII = (1.15, 1.3, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 6.0)  # tried as that radius, in radii of the body
# Rows of scratch: position over the body's radius and 1/r**2, then harmonic of order m, the last two of rising degree.
_X, _Y, _Z, _W, _DIAGONAL, _NEW, _OLD = 0, 1, 2, 3, 4, 6, 8
SCRATCH = 10 * LANES
BLOCK = 48  # points whose regular harmonics are raised side by side


class Multipole(NamedTuple):
    """Moments of a body of unit density about its centroid.

    centre    centroid of the volume [m], [3]
    radius    of the farthest vertex from it [m]
    real, imaginary   moments over radius**3, [DEGREE + 2, DEGREE + 3], zero beyond order and degree
    nearest   distance from the centre from which the series is used [m]
    error     largest relative error of the acceleration found there
    """

    centre: NDArray[np.float64]
    radius: float
    real: NDArray[np.float64]
    imaginary: NDArray[np.float64]
    nearest: float
    error: float

    @classmethod
    def of(cls, polyhedron: PolyhedronTerms, centre: NDArray[np.float64]) -> "Multipole":
        """Moments of a polyhedron, and the radius from which they are as good as the polyhedron itself."""
        offset = polyhedron.vertices - centre
        radius = float(np.linalg.norm(offset, axis=1).max())
        corner = np.ascontiguousarray(offset[polyhedron.facet_corners] / radius)
        # Exact for harmonics of the highest degree, with the one power more of the folded square.
        node, weight = np.polynomial.legendre.leggauss(DEGREE // 2 + 2)
        real, imaginary = np.zeros((DEGREE + 2, DEGREE + 3)), np.zeros((DEGREE + 2, DEGREE + 3))
        _moments(corner, 0.5 * (node + 1.0), 0.5 * weight, real, imaginary)
        for fraction in RADII:
            trial = cls(centre, radius, real, imaginary, fraction * radius, 0.0)
            error = trial._error(polyhedron)
            if error < LARGEST_ERROR:
                break
        return cls(centre, radius, real, imaginary, fraction * radius, error)

    @classmethod
    def unused(cls, centre: NDArray[np.float64]) -> "Multipole":
        """Without moments, for points so near that the facets are summed over for each of them."""
        none = np.zeros((DEGREE + 2, DEGREE + 3))
        return cls(centre, 1.0, none, none, np.inf, 0.0)

    def field(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """As PolyhedronTerms.field (the Laplacian is zero), at points [m], [count, 3], outside the body's sphere."""
        result = np.empty((len(points), 5))
        _series(np.ascontiguousarray(points, dtype=np.float64), result, self)
        return result

    def _error(self, polyhedron: PolyhedronTerms) -> float:
        """Largest relative difference of the two accelerations over a sphere of the nearest radius."""
        # Points of a golden spiral: even over the sphere, and the same each time.
        index = np.arange(400) + 0.5
        height, turn = 1.0 - index / 200.0, np.pi * (1.0 + np.sqrt(5.0)) * index
        across = np.sqrt(1.0 - height**2)
        sphere = np.stack([across * np.cos(turn), across * np.sin(turn), height], axis=1)
        points = self.centre + self.nearest * sphere
        exact = polyhedron.field(points)[:, :3]
        difference = np.linalg.norm(self.field(points)[:, :3] - exact, axis=1)
        return float((difference / np.linalg.norm(exact, axis=1)).max())


@compiled
def _moments(corner: Floats, node: Floats, weight: Floats, real: Floats, imaginary: Floats) -> None:
    """Add to real and imaginary the moments: conjugate regular harmonics integrated over cones from the centre to
    facets.

    corner [facet_count, 3, 3] about the centre; node, weight: Gauss-Legendre on 0 to 1. A facet is a folded square;
    along a cone a harmonic of degree n grows as the n-th power, which leaves the factor 1/(n + 3). The harmonics of
    BLOCK points are raised side by side, and summed point after point.
    """
    point = np.zeros((5, BLOCK))
    x, y, z, square, part = point[0], point[1], point[2], point[3], point[4]
    harmonic = np.zeros((8, BLOCK))
    diagonal, diagonal_i, new, new_i = harmonic[0], harmonic[1], harmonic[2], harmonic[3]
    old, old_i, term, term_i = harmonic[4], harmonic[5], harmonic[6], harmonic[7]
    point_count = len(corner) * len(node) ** 2
    for start in range(0, point_count, BLOCK):
        count = min(BLOCK, point_count - start)
        for j in range(count):
            _place(point, j, start + j, corner, node, weight)
        diagonal[:], diagonal_i[:] = 1.0, 0.0
        for m in range(len(real) - 1):
            for j in range(BLOCK if m else 0):
                re, im = diagonal[j], diagonal_i[j]
                diagonal[j] = -(x[j] * re - y[j] * im) / (2.0 * m)
                diagonal_i[j] = -(x[j] * im + y[j] * re) / (2.0 * m)
            new[:], new_i[:], old[:], old_i[:] = diagonal, diagonal_i, 0.0, 0.0
            for n in range(m, len(real) - 1):
                ahead, below = 2.0 * n - 1.0, float((n - m) * (n + m))
                for j in range(BLOCK if n > m else 0):
                    re, im = new[j], new_i[j]
                    new[j] = ahead * z[j] * re / below - square[j] * old[j] / below
                    new_i[j] = ahead * z[j] * im / below - square[j] * old_i[j] / below
                    old[j], old_i[j] = re, im
                for j in range(BLOCK):
                    term[j], term_i[j] = part[j] * new[j] / (n + 3.0), part[j] * new_i[j] / (n + 3.0)
                re, im = real[n, m], imaginary[n, m]
                for j in range(count):
                    re += term[j]
                    im -= term_i[j]
                real[n, m], imaginary[n, m] = re, im


@compiled
def _place(point: Floats, j: int, number: int, corner: Floats, node: Floats, weight: Floats) -> None:
    """Write column j of point [5, BLOCK]: place, squared distance and weight of a point of the quadrature of facets."""
    f, p, q = number // len(node) ** 2, number // len(node) % len(node), number % len(node)
    a, b, c = corner[f, 0], corner[f, 1], corner[f, 2]
    six = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
    s, t = node[p], node[p] * node[q]
    x = a[0] + s * (b[0] - a[0]) + t * (c[0] - b[0])
    y = a[1] + s * (b[1] - a[1]) + t * (c[1] - b[1])
    z = a[2] + s * (b[2] - a[2]) + t * (c[2] - b[2])
    point[0, j], point[1, j], point[2, j] = x, y, z
    point[3, j] = x * x + y * y + z * z
    point[4, j] = six * weight[p] * weight[q] * node[p]


@compiled
def series_block(lane: Floats, count: int, scratch: Floats, multipole: Multipole) -> None:
    """As field_block, by the series: reads the first three rows of lane, writes pull, potential. scratch [SCRATCH]."""
    # In units of the radius, in which no power of a distance overflows or underflows.
    centre, radius = multipole.centre, multipole.radius
    for i in range(3):
        for j in range(count):
            scratch[(_X + i) * LANES + j] = (lane[i * LANES + j] - centre[i]) / radius
    for j in range(count):
        x, y, z = scratch[_X * LANES + j], scratch[_Y * LANES + j], scratch[_Z * LANES + j]
        scratch[_W * LANES + j] = 1.0 / (x * x + y * y + z * z)
        scratch[_DIAGONAL * LANES + j] = np.sqrt(scratch[_W * LANES + j])
        scratch[(_DIAGONAL + 1) * LANES + j] = 0.0
        for row in (PULL_X, PULL_Y, PULL_Z, POTENTIAL):
            lane[row * LANES + j] = 0.0
    top = len(multipole.real) - 1
    for m in range(top + 1):
        if m > 0:
            _raise_order(scratch, count, m)
        for j in range(2 * LANES):
            scratch[_NEW * LANES + j] = scratch[_DIAGONAL * LANES + j]
            scratch[_OLD * LANES + j] = 0.0
        for n in range(m, top + 1):
            if n > m:
                _raise_degree(scratch, count, n, m)
            _add_harmonic(lane, count, scratch, n, m, multipole)
    for j in range(count):
        for i in range(3):
            lane[(PULL_X + i) * LANES + j] *= radius
        # A block holds twice the potential.
        lane[POTENTIAL * LANES + j] *= 2.0 * radius * radius


@compiled
def _raise_order(scratch: Floats, count: int, m: int) -> None:
    """Turn the harmonic of degree and order m - 1 into that of m."""
    for j in range(count):
        x, y, w = scratch[_X * LANES + j], scratch[_Y * LANES + j], scratch[_W * LANES + j]
        re, im = scratch[_DIAGONAL * LANES + j], scratch[(_DIAGONAL + 1) * LANES + j]
        scratch[_DIAGONAL * LANES + j] = -(2 * m - 1) * w * (x * re - y * im)
        scratch[(_DIAGONAL + 1) * LANES + j] = -(2 * m - 1) * w * (x * im + y * re)


@compiled
def _raise_degree(scratch: Floats, count: int, n: int, m: int) -> None:
    """Turn the harmonics of degrees n - 1 (new) and n - 2 (old) into those of n and n - 1."""
    ahead, back = 2.0 * n - 1.0, (n - 1.0) ** 2 - m * m
    for j in range(count):
        z, w = scratch[_Z * LANES + j], scratch[_W * LANES + j]
        re, im = scratch[_NEW * LANES + j], scratch[(_NEW + 1) * LANES + j]
        scratch[_NEW * LANES + j] = w * (ahead * z * re - back * scratch[_OLD * LANES + j])
        scratch[(_NEW + 1) * LANES + j] = w * (ahead * z * im - back * scratch[(_OLD + 1) * LANES + j])
        scratch[_OLD * LANES + j], scratch[(_OLD + 1) * LANES + j] = re, im


@compiled
def _add_harmonic(lane: Floats, count: int, scratch: Floats, n: int, m: int, multipole: Multipole) -> None:
    """Add what the irregular harmonic (n, m) gives: potential of moment (n, m), pulls of moments of degree n - 1."""
    real, imaginary, weight = multipole.real, multipole.imaginary, 1.0 if m == 0 else 2.0
    a, b = weight * real[n, m], weight * imaginary[n, m]
    c = d = e = f = g = h = 0.0
    if n > 0:
        c, d = weight * real[n - 1, m], weight * imaginary[n - 1, m]
        g, h = real[n - 1, m + 1], imaginary[n - 1, m + 1]
        if m > 0:
            e, f = real[n - 1, m - 1], imaginary[n - 1, m - 1]
    for j in range(count):
        re, im = scratch[_NEW * LANES + j], scratch[(_NEW + 1) * LANES + j]
        lane[POTENTIAL * LANES + j] += a * re - b * im
        lane[PULL_Z * LANES + j] -= c * re - d * im
        lane[PULL_X * LANES + j] += (e - g) * re - (f - h) * im
        lane[PULL_Y * LANES + j] += (e + g) * im + (f + h) * re


@compiled
def _series(points: Floats, result: Floats, multipole: Multipole) -> None:
    lane, scratch = np.zeros(8 * LANES), np.zeros(SCRATCH)
    for start in range(0, len(points), LANES):
        count = min(LANES, len(points) - start)
        for j in range(count):
            for i in range(3):
                lane[i * LANES + j] = points[start + j, i]
        series_block(lane, count, scratch, multipole)
        for j in range(count):
            for i in range(3):
                result[start + j, i] = lane[(PULL_X + i) * LANES + j]
            result[start + j, 3] = 0.5 * lane[POTENTIAL * LANES + j]
            result[start + j, 4] = 0.0
