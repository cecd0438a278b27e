"""Covariances of one input, the factors of products over inputs: Gaussian bumps, or polynomials that fade."""

from abc import ABC, abstractmethod
from functools import lru_cache
from typing import ClassVar

import numpy as np

from lithobrake.chaos.abstract_distribution import Distribution
from lithobrake.vocabulary.arrays import Array

# Nodes of the quadrature that projects a bump on polynomials.
RULE_NODES = 160


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
    def with_derivatives(self, parameters: Array, germ: Array) -> tuple[Array, Array, Array]:
        """Covariance of germs [count] with themselves and its derivatives by both parameters, each [count, count]."""

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

    def with_derivatives(self, parameters: Array, germ: Array) -> tuple[Array, Array, Array]:
        squares = ((germ[:, None] - germ[None, :]) / np.exp(parameters[0])) ** 2
        part = np.exp(parameters[1] - 0.5 * squares)
        return part, part * squares, part

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

    def with_derivatives(self, parameters: Array, germ: Array) -> tuple[Array, Array, Array]:
        table = self._table(germ)
        variances, derivatives = self._variances(parameters)
        part = (table.T * variances) @ table
        return part, (table.T * derivatives) @ table, part

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
