"""Covariances of smooth random functions of the germs, each with its gradient and its projection on polynomials.

All are sums of products over inputs, so that their mean over a polynomial of each input is a product of
one-dimensional means: a Gaussian process with such a covariance turns into an expansion without any sampling.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import ClassVar

import numpy as np

from lithobrake.chaos.germ import Distribution
from lithobrake.chaos.polynomials import Array
from lithobrake.chaos.terms import Indices

Gradient = Callable[[Array], Array]
RULE_NODES = 160
# The squared lengths of the Gaussians that make up a Matern covariance.
MIXTURE_NODES = 16
MIXTURE_LOG_RANGE = (-6.0, 2.0)
MATERN_ORDER = 2.5


class Covariance(ABC):
    """A covariance with logarithms of its parameters in a vector theta; lengths are in units of the germ.

    entries: distributions of the inputs; degrees: highest degree of each input, [input_count].
    """

    name: ClassVar[str]

    def __init__(self, entries: Sequence[Distribution], degrees: Sequence[int]) -> None:
        self.entries, self.degrees = list(entries), list(degrees)

    @abstractmethod
    def start(self) -> tuple[Array, list[tuple[float, float]]]:
        """First theta and its bounds."""

    @abstractmethod
    def with_gradient(self, theta: Array, germs: Array) -> tuple[Array, Gradient]:
        """Covariance of germs [input_count, count] with themselves, and W -> sum(W * dK / dtheta)."""

    @abstractmethod
    def between(self, theta: Array, first: Array, second: Array) -> Array:
        """Covariance of germs [input_count, a] and [input_count, b]; result [a, b]."""

    @abstractmethod
    def projection(self, theta: Array, germs: Array, indices: Indices, weights: Array) -> Array:
        """Coefficients [term_count] of sum_m weights_m K(., germ_m) on the orthonormal polynomials."""


def _product_gradient(scale: float, factors: list[Array], slopes: list[list[Array]], total: Array) -> Gradient:
    """Gradient of scale * prod_k factor_k; slopes[parameter kind][input]; the last entry is that of log scale."""

    def gradient(weight: Array) -> Array:
        before = [np.full_like(total, scale)]
        for factor in factors[:-1]:
            before.append(before[-1] * factor)
        result = np.empty((len(slopes), len(factors)))
        after = weight.copy()
        for k in range(len(factors) - 1, -1, -1):
            rest = before[k] * after
            for kind, family in enumerate(slopes):
                result[kind, k] = np.vdot(rest, family[k])
            after *= factors[k]
        return np.append(result.ravel(), np.vdot(weight, total))

    return gradient


class AdditiveGaussian(Covariance):
    """s prod_k (1 + a_k exp(-r_k**2 / (2 l_k**2))): each input may act alone or in products with others.

    Source: Durrande, Ginsbourger and Roustant, 2012, "Additive covariance kernels" (ANOVA form).
    """

    name = "gaussian"

    def start(self) -> tuple[Array, list[tuple[float, float]]]:
        count = len(self.entries)
        bounds = [(-3.0, 5.0)] * count + [(-10.0, 8.0)] * count + [(-8.0, 12.0)]
        return np.zeros(2 * count + 1), bounds

    def with_gradient(self, theta: Array, germs: Array) -> tuple[Array, Gradient]:
        count = len(germs)
        factors, by_length, by_share = [], [], []
        for k, germ in enumerate(germs):
            squares = ((germ[:, None] - germ[None, :]) / np.exp(theta[k])) ** 2
            part = np.exp(theta[count + k] - 0.5 * squares)
            factors.append(1.0 + part)
            by_length.append(part * squares)
            by_share.append(part)
        scale = float(np.exp(theta[-1]))
        total = scale * np.prod(factors, axis=0)
        return total, _product_gradient(scale, factors, [by_length, by_share], total)

    def between(self, theta: Array, first: Array, second: Array) -> Array:
        count = len(first)
        total = np.full((first.shape[1], second.shape[1]), np.exp(theta[-1]))
        for k in range(count):
            squares = ((first[k][:, None] - second[k][None, :]) / np.exp(theta[k])) ** 2
            total *= 1.0 + np.exp(theta[count + k] - 0.5 * squares)
        return total

    def projection(self, theta: Array, germs: Array, indices: Indices, weights: Array) -> Array:
        count = len(germs)
        tables = []
        for k, entry in enumerate(self.entries):
            table = _gaussian_means(entry, self.degrees[k], germs[k], float(np.exp(theta[k])))
            table *= np.exp(theta[count + k])
            table[0] += 1.0
            tables.append(table)
        return float(np.exp(theta[-1])) * contracted(tables, indices, weights)


class PolynomialPrior(Covariance):
    """s prod_k (1 + a_k sum_j exp(-d_k (j - 1)) p_j(t) p_j(t')): coefficients that fade geometrically with the degree.

    Source: Xiu, 2010, "Numerical Methods for Stochastic Computations", section 3.3 (decay of the coefficients of
    smooth functions), used here as prior variances.
    """

    name = "polynomial"

    def start(self) -> tuple[Array, list[tuple[float, float]]]:
        count = len(self.entries)
        start = np.concatenate([np.full(count, np.log(0.3)), np.zeros(count), [0.0]])
        return start, [(-12.0, 5.0)] * count + [(-2.0, 3.0)] * count + [(-5.0, 8.0)]

    def _variances(self, theta: Array, k: int) -> tuple[Array, Array]:
        steps = np.arange(float(self.degrees[k]))
        decay = np.exp(theta[len(self.entries) + k])
        variances = np.exp(theta[k] - decay * steps)
        return variances, -decay * steps * variances

    def with_gradient(self, theta: Array, germs: Array) -> tuple[Array, Gradient]:
        factors, by_share, by_decay = [], [], []
        for k, table in enumerate(self._tables(germs)):
            variances, slopes = self._variances(theta, k)
            part = (table.T * variances) @ table
            factors.append(1.0 + part)
            by_share.append(part)
            by_decay.append((table.T * slopes) @ table)
        scale = float(np.exp(theta[-1]))
        total = scale * np.prod(factors, axis=0)
        return total, _product_gradient(scale, factors, [by_share, by_decay], total)

    def _tables(self, germs: Array) -> list[Array]:
        pairs = zip(self.entries, self.degrees, germs, strict=True)
        return [entry.recurrence(degree).values(germ)[1:] for entry, degree, germ in pairs]

    def between(self, theta: Array, first: Array, second: Array) -> Array:
        total = np.full((first.shape[1], second.shape[1]), np.exp(theta[-1]))
        for k, (left, right) in enumerate(zip(self._tables(first), self._tables(second), strict=True)):
            total *= 1.0 + (left.T * self._variances(theta, k)[0]) @ right
        return total

    def projection(self, theta: Array, germs: Array, indices: Indices, weights: Array) -> Array:
        tables = []
        for k, table in enumerate(self._tables(germs)):
            tables.append(np.vstack([np.ones(germs.shape[1]), self._variances(theta, k)[0][:, None] * table]))
        return float(np.exp(theta[-1])) * contracted(tables, indices, weights)


class RadialMatern(Covariance):
    """s M(r), r**2 = sum_k (t_k - t'_k)**2 / l_k**2, Matern of order 5/2: rougher, with kinks in any direction.

    Learnt in closed form; used as a mixture of products, by the Gaussians exp(-r**2 / (2 v)) over v ~ Gamma(5/2).
    Source: Rasmussen and Williams, 2006, Eqs 4.14 to 4.17.
    """

    name = "matern"

    def start(self) -> tuple[Array, list[tuple[float, float]]]:
        count = len(self.entries)
        return np.append(np.full(count, 0.5), 0.0), [(-3.0, 6.0)] * count + [(-8.0, 12.0)]

    def with_gradient(self, theta: Array, germs: Array) -> tuple[Array, Gradient]:
        squares = [((g[:, None] - g[None, :]) / np.exp(one)) ** 2 for g, one in zip(germs, theta[:-1], strict=True)]
        distance = np.sqrt(5.0 * np.sum(squares, axis=0))
        fade = np.exp(theta[-1] - distance)
        total = (1.0 + distance + distance**2 / 3.0) * fade
        slope = (5.0 / 3.0) * (1.0 + distance) * fade

        def gradient(weight: Array) -> Array:
            inner = weight * slope
            return np.array([*(np.vdot(inner, one) for one in squares), np.vdot(weight, total)])

        return total, gradient

    def _mixture(self) -> list[tuple[float, float]]:
        # In the logarithm of v the trapezoidal rule converges fast and also resolves the short lengths of a kink.
        v = np.exp(np.linspace(*MIXTURE_LOG_RANGE, MIXTURE_NODES))
        weights = (v * np.exp(-v)) ** MATERN_ORDER
        return list(zip(v.tolist(), (weights / weights.sum()).tolist(), strict=True))

    def between(self, theta: Array, first: Array, second: Array) -> Array:
        squares = np.zeros((first.shape[1], second.shape[1]))
        for k in range(len(first)):
            squares += ((first[k][:, None] - second[k][None, :]) / np.exp(theta[k])) ** 2
        parts = (weight * np.exp(-0.5 * squares / v) for v, weight in self._mixture())
        return np.exp(theta[-1]) * np.sum(list(parts), axis=0)

    def projection(self, theta: Array, germs: Array, indices: Indices, weights: Array) -> Array:
        total = np.zeros(len(indices))
        for v, share in self._mixture():
            lengths = np.exp(theta[:-1]) * np.sqrt(v)
            rows = zip(self.entries, self.degrees, germs, lengths, strict=True)
            tables = [_gaussian_means(entry, degree, germ, float(length)) for entry, degree, germ, length in rows]
            total += share * contracted(tables, indices, weights)
        return float(np.exp(theta[-1])) * total


def _gaussian_means(entry: Distribution, degree: int, germ: Array, length: float) -> Array:
    """Mean over the input of p_j(t) exp(-(t - germ)**2 / (2 length**2)), [degree + 1, count]."""
    nodes, weights = entry.rule(RULE_NODES)
    bumps = np.exp(-0.5 * ((nodes[:, None] - germ[None, :]) / length) ** 2)
    return (entry.recurrence(degree).values(nodes) * weights) @ bumps


def contracted(tables: list[Array], indices: Indices, weights: Array) -> Array:
    """Sum over points m of weights_m prod_k tables[k][i_k, m] for each multi-index; result [term_count]."""
    result = np.empty(len(indices))
    # Slices keep the products of many terms and points out of main memory.
    for start in range(0, len(indices), 1024):
        part = indices[start : start + 1024]
        product = tables[0][part[:, 0]].copy()
        for k in range(1, len(tables)):
            product *= tables[k][part[:, k]]
        result[start : start + 1024] = product @ weights
    return result
