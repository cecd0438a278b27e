"""Covariances of smooth random functions of the germs, with gradients and projections on polynomials."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import ClassVar

import numpy as np

from lithobrake.chaos.basis import Indices
from lithobrake.chaos.distributions import Distribution
from lithobrake.vocabulary.array_types import Array

# Nodes of the quadrature that projects a bump on polynomials.
RULE_NODES = 160
Gradient = Callable[[Array], Array]
# The squared lengths of the Gaussians that make up a Matern covariance.
MIXTURE_NODES = 16
MIXTURE_LOG_RANGE = (-6.0, 2.0)
MATERN_ORDER = 2.5


class UnivariateCovariance(ABC):
    """Covariance of one input with two log parameters, in units of its germ; degree: highest of polynomials."""

    start: ClassVar[tuple[float, float]]
    bounds: ClassVar[tuple[tuple[float, float], tuple[float, float]]]

    def __init__(self, entry: Distribution, degree: int) -> None:
        self.entry, self.degree = entry, degree
        self.recurrence = entry.recurrence(degree)

    @abstractmethod
    def between(self, parameters: Array, first: Array, second: Array) -> Array:
        """Covariance of germs [a] and [b]; result [a, b]."""

    @abstractmethod
    def with_derivative(self, parameters: Array, germ: Array) -> tuple[Array, Array]:
        """Covariance of germs [count] with themselves and its derivative by the first parameter, each [count, count].

        By the second, the logarithm of a factor, its derivative is the covariance itself.
        """

    @abstractmethod
    def variance(self, parameters: Array, germ: Array) -> Array:
        """Covariance of each germ with itself, [count]."""

    @abstractmethod
    def means(self, parameters: Array, germ: Array) -> Array:
        """Mean over the input of p_j(t) times the covariance of t and a germ, [degree + 1, count]."""


class UnivariateGaussian(UnivariateCovariance):
    """s exp(-r**2 / (2 l**2)), parameters (ln l, ln s)."""

    start = (0.0, 0.0)
    bounds = ((-3.0, 5.0), (-10.0, 8.0))

    def between(self, parameters: Array, first: Array, second: Array) -> Array:
        squares = ((first[:, None] - second[None, :]) / np.exp(parameters[0])) ** 2
        return np.exp(parameters[1] - 0.5 * squares)

    def with_derivative(self, parameters: Array, germ: Array) -> tuple[Array, Array]:
        squares = ((germ[:, None] - germ[None, :]) / np.exp(parameters[0])) ** 2
        part = np.exp(parameters[1] - 0.5 * squares)
        return part, part * squares

    def variance(self, parameters: Array, germ: Array) -> Array:
        return np.full(len(germ), np.exp(parameters[1]))

    def means(self, parameters: Array, germ: Array) -> Array:
        return np.exp(parameters[1]) * gaussian_means(self.entry, self.degree, germ, float(np.exp(parameters[0])))


class UnivariatePolynomial(UnivariateCovariance):
    """sum_j v_j p_j(t) p_j(t'), v_j = s exp(-decay (j - 1)) from degree 1 on, parameters (ln decay, ln s)."""

    start = (0.0, -1.2)
    bounds = ((-2.0, 3.0), (-12.0, 5.0))

    def _variances(self, parameters: Array) -> tuple[Array, Array]:
        fade = -np.exp(parameters[0]) * np.arange(float(self.degree))
        variances = np.exp(parameters[1] + fade)
        return variances, fade * variances

    def _table(self, germ: Array) -> Array:
        return self.recurrence.values(germ)[1:]

    def between(self, parameters: Array, first: Array, second: Array) -> Array:
        return (self._table(first).T * self._variances(parameters)[0]) @ self._table(second)

    def with_derivative(self, parameters: Array, germ: Array) -> tuple[Array, Array]:
        table = self._table(germ)
        variances, derivatives = self._variances(parameters)
        return (table.T * variances) @ table, (table.T * derivatives) @ table

    def variance(self, parameters: Array, germ: Array) -> Array:
        return self._variances(parameters)[0] @ self._table(germ) ** 2

    def means(self, parameters: Array, germ: Array) -> Array:
        rows = self._variances(parameters)[0][:, None] * self._table(germ)
        return np.vstack([np.zeros(len(germ)), rows])


def gaussian_means(entry: Distribution, degree: int, germ: Array, length: float) -> Array:
    """Mean over the input of p_j(t) exp(-(t - germ)**2 / (2 length**2)), [degree + 1, count]."""
    nodes, table = _weighted_table(entry, degree)
    return table @ np.exp(-0.5 * ((nodes[:, None] - germ[None, :]) / length) ** 2)


@lru_cache(maxsize=64)
def _weighted_table(entry: Distribution, degree: int) -> tuple[Array, Array]:
    """Nodes [node_count] of a fine rule and polynomials times weights on them [degree + 1, node_count].

    Kept, because computed polynomials cost far more than their use.
    """
    nodes, weights = entry.rule(RULE_NODES)
    return nodes, entry.recurrence(degree).values(nodes) * weights


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
    def variance(self, theta: Array, germs: Array) -> Array:
        """Covariance of each of germs [input_count, count] with itself, [count]."""

    @abstractmethod
    def projection(self, theta: Array, germs: Array, indices: Indices, weights: Array) -> Array:
        """Coefficients [term_count] of sum_m weights_m K(., germ_m) on the orthonormal polynomials; several columns of
        weights [count, any] give [term_count, any].
        """


class ProductCovariance(Covariance):
    """s prod_k (1 + part_k): each input may act alone or in products with others.

    Source: [Durrande-2012] (ANOVA form).
    """

    name = "gaussian"

    def __init__(self, entries: Sequence[Distribution], degrees: Sequence[int]) -> None:
        super().__init__(entries, degrees)
        pairs = zip(self.entries, self.degrees, strict=True)
        self.parts: list[UnivariateCovariance] = [self.part_of(entry, degree) for entry, degree in pairs]

    def part_of(self, entry: Distribution, degree: int) -> UnivariateCovariance:
        return UnivariateGaussian(entry, degree)

    def start(self) -> tuple[Array, list[tuple[float, float]]]:
        start = [part.start[which] for which in (0, 1) for part in self.parts]
        bounds = [part.bounds[which] for which in (0, 1) for part in self.parts]
        return np.array([*start, 0.0]), [*bounds, (-8.0, 12.0)]

    def _split(self, theta: Array) -> list[tuple[UnivariateCovariance, Array]]:
        return list(zip(self.parts, theta[:-1].reshape(2, -1).T, strict=True))

    def with_gradient(self, theta: Array, germs: Array) -> tuple[Array, Gradient]:
        rows = [part.with_derivative(one, germ) for (part, one), germ in zip(self._split(theta), germs, strict=True)]
        factors = [1.0 + row[0] for row in rows]
        scale = float(np.exp(theta[-1]))
        total = scale * np.prod(factors, axis=0)

        def gradient(weight: Array) -> Array:
            # The product of all other factors is made from both sides: a factor of polynomials may be 0, by which
            # nothing can be divided.
            before = [np.full_like(total, scale)]
            for factor in factors[:-1]:
                before.append(before[-1] * factor)
            result = np.empty((2, len(factors)))
            after = weight.copy()
            for k in range(len(factors) - 1, -1, -1):
                rest = before[k] * after
                result[:, k] = np.vdot(rest, rows[k][1]), np.vdot(rest, rows[k][0])
                after *= factors[k]
            return np.append(result.ravel(), np.vdot(weight, total))

        return total, gradient

    def between(self, theta: Array, first: Array, second: Array) -> Array:
        total = np.full((first.shape[1], second.shape[1]), np.exp(theta[-1]))
        for k, (part, parameters) in enumerate(self._split(theta)):
            total *= 1.0 + part.between(parameters, first[k], second[k])
        return total

    def variance(self, theta: Array, germs: Array) -> Array:
        total = np.full(germs.shape[1], np.exp(theta[-1]))
        for (part, parameters), germ in zip(self._split(theta), germs, strict=True):
            total *= 1.0 + part.variance(parameters, germ)
        return total

    def projection(self, theta: Array, germs: Array, indices: Indices, weights: Array) -> Array:
        tables = []
        for (part, parameters), germ in zip(self._split(theta), germs, strict=True):
            table = part.means(parameters, germ)
            table[0] += 1.0
            tables.append(table)
        return float(np.exp(theta[-1])) * contracted(tables, indices, weights)


class PolynomialCovariance(ProductCovariance):
    """The product with polynomials whose variances fade geometrically with the degree, as those of smooth functions do.

    Without limits polynomials grow in the tails, and a process made of them returns to no mean far from the data, with
    a leave-one-out error far too low; unbounded inputs keep the Gaussian part.
    Source: [Xiu-2010], section 3.3 (decay of coefficients).
    """

    name = "polynomial"

    def part_of(self, entry: Distribution, degree: int) -> UnivariateCovariance:
        return UnivariatePolynomial(entry, degree) if entry.bounded else UnivariateGaussian(entry, degree)


class RadialMatern(Covariance):
    """s M(r), r**2 = sum_k (t_k - t'_k)**2 / l_k**2, Matern of order 5/2: rougher, with kinks in any direction.

    Learnt in closed form; used as a mixture of products, by the Gaussians exp(-r**2 / (2 v)) over v ~ Gamma(5/2).
    Source: [Rasmussen-2006], Eqs 4.14 to 4.17.
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
        derivative = (5.0 / 3.0) * (1.0 + distance) * fade

        def gradient(weight: Array) -> Array:
            inner = weight * derivative
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

    def variance(self, theta: Array, germs: Array) -> Array:
        return np.full(germs.shape[1], np.exp(theta[-1]))

    def projection(self, theta: Array, germs: Array, indices: Indices, weights: Array) -> Array:
        total = np.zeros((len(indices), *weights.shape[1:]))
        for v, weight in self._mixture():
            lengths = np.exp(theta[:-1]) * np.sqrt(v)
            rows = zip(self.entries, self.degrees, germs, lengths, strict=True)
            tables = [gaussian_means(entry, degree, germ, float(length)) for entry, degree, germ, length in rows]
            total += weight * contracted(tables, indices, weights)
        return float(np.exp(theta[-1])) * total


def contracted(tables: list[Array], indices: Indices, weights: Array) -> Array:
    """Sum over points m of weights_m prod_k tables[k][i_k, m] for each multi-index; weights [count] or [count, any];
    result [term_count] or [term_count, any].
    """
    result = np.empty((len(indices), *weights.shape[1:]))
    # Slices keep the products of many terms and points out of main memory.
    for start in range(0, len(indices), 1024):
        part = indices[start : start + 1024]
        product = tables[0][part[:, 0]].copy()
        for k in range(1, len(tables)):
            product *= tables[k][part[:, k]]
        result[start : start + 1024] = product @ weights
    return result
