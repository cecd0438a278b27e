"""Orthonormal polynomials of one variable, held as the coefficients of their three-term recurrence.

Every family, classical or computed from data, is the same two arrays, so one evaluation routine serves all.
"""

from dataclasses import dataclass

import numpy as np

from lithobrake.vocabulary.array_types import Array


@dataclass(frozen=True)
class Recurrence:
    """Polynomials p_0 = 1, p_(k+1) = ((t - center_k) p_k - spread_(k-1) p_(k-1)) / spread_k, orthonormal in a measure.

    center: a_k, shape [degree]; spread: sqrt(b_(k+1)), shape [degree]; both in units of the germ t.
    Source: [Gautschi-2004], Eq 1.3.13.
    """

    center: Array
    spread: Array

    @property
    def degree(self) -> int:
        return len(self.center)

    def values(self, germ: Array) -> Array:
        """Evaluate all degrees at germ values [count]; result [degree + 1, count]."""
        table = np.ones((self.degree + 1, germ.size))
        for k in range(self.degree):
            np.multiply(germ - self.center[k], table[k], out=table[k + 1])
            if k > 0:
                table[k + 1] -= self.spread[k - 1] * table[k - 1]
            table[k + 1] /= self.spread[k]
        return table

    def derivatives(self, germ: Array) -> Array:
        """Evaluate the first derivatives of all degrees at germ values [count]; result [degree + 1, count]."""
        table, derivatives = self.values(germ), np.zeros((self.degree + 1, germ.size))
        for k in range(self.degree):
            derivatives[k + 1] = table[k] + (germ - self.center[k]) * derivatives[k]
            if k > 0:
                derivatives[k + 1] -= self.spread[k - 1] * derivatives[k - 1]
            derivatives[k + 1] /= self.spread[k]
        return derivatives

    def gauss_rule(self) -> tuple[Array, Array]:
        """Nodes [degree] and weights [degree] (summing to 1) of the Gauss rule, exact up to degree 2 degree - 1.

        Source: [Golub-1969].
        """
        from scipy.linalg import eigh_tridiagonal

        nodes = eigh_tridiagonal(self.center, self.spread[:-1], eigvals_only=True)
        # Eigenvectors give tiny weights with no correct digit; this sum keeps them all (an overflow is a weight of 0).
        with np.errstate(over="ignore"):
            return nodes, 1.0 / (self.values(nodes)[:-1] ** 2).sum(axis=0)


def legendre(degree: int) -> Recurrence:
    """Polynomials of the uniform measure on [-1, 1]. Source: [Xiu-2002], Table 4.1."""
    k = np.arange(1.0, degree + 1)
    return Recurrence(np.zeros(degree), k / np.sqrt(4.0 * k * k - 1.0))


def hermite(degree: int) -> Recurrence:
    """Polynomials of the standard normal measure. Source: [Xiu-2002], Table 4.1."""
    return Recurrence(np.zeros(degree), np.sqrt(np.arange(1.0, degree + 1)))


def laguerre(degree: int, shape: float) -> Recurrence:
    """Polynomials of the gamma measure t**(shape - 1) exp(-t) / Gamma(shape) on t >= 0.

    Source: [Xiu-2002], Table 4.1; recurrence of [Gautschi-2004], Table 1.1.
    """
    k = np.arange(float(degree))
    return Recurrence(2.0 * k + shape, np.sqrt((k + 1.0) * (k + shape)))


def jacobi(degree: int, left: float, right: float) -> Recurrence:
    """Polynomials of the beta measure on [-1, 1], density proportional to (1 + t)**(left - 1) (1 - t)**(right - 1).

    Source: [Gautschi-2004], Table 1.1, with exponents right - 1 of (1 - t) and left - 1 of (1 + t).
    """
    a, b = right - 1.0, left - 1.0
    center, square = np.empty(degree), np.empty(degree)
    for k in range(degree):
        total = 2.0 * k + a + b
        # The general formulas are 0 / 0 at the first one or two indices for some exponents.
        center[k] = (b - a) / (a + b + 2.0) if k == 0 else (b * b - a * a) / (total * (total + 2.0))
        n, total = k + 1.0, 2.0 * (k + 1.0) + a + b
        if k == 0:
            square[k] = 4.0 * (1.0 + a) * (1.0 + b) / ((2.0 + a + b) ** 2 * (3.0 + a + b))
        else:
            square[k] = 4.0 * n * (n + a) * (n + b) * (n + a + b) / (total**2 * (total + 1.0) * (total - 1.0))
    return Recurrence(center, np.sqrt(square))


def discretised(degree: int, nodes: Array, weights: Array) -> Recurrence:
    """Polynomials orthonormal in the discrete measure of nodes [count] and weights [count] (summing to 1).

    The Lanczos vectors are orthogonalised twice against all earlier ones, or orthogonality is lost at high degree.
    Raises ValueError when the measure has too few distinct nodes for the degree.
    Source: [Gautschi-2004], section 2.2.3 (Stieltjes and Lanczos).
    """
    distinct = len(np.unique(nodes))
    if distinct <= degree:
        raise ValueError(
            f"degree {degree} needs more than {degree} distinct values of the input, but only {distinct} are there: "
            "lower the degree or give more samples"
        )
    root = np.sqrt(weights)
    vectors = np.zeros((degree + 1, len(nodes)))
    vectors[0] = root / np.linalg.norm(root)
    center, spread = np.empty(degree), np.empty(degree)
    for k in range(degree):
        center[k] = vectors[k] @ (nodes * vectors[k])
        following = nodes * vectors[k]
        for _ in range(2):
            following -= vectors[: k + 1].T @ (vectors[: k + 1] @ following)
        spread[k] = float(np.linalg.norm(following))
        vectors[k + 1] = following / spread[k]
    return Recurrence(center, spread)
