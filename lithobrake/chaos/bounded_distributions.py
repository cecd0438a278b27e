"""Inputs between two finite limits: uniform, log-uniform, beta."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.chaos.abstract_distribution import Distribution, Support
from lithobrake.chaos.polynomials import Array, Recurrence, jacobi, legendre


@dataclass(frozen=True)
class Uniform(Distribution):
    """Uniform between lower and upper [unit of the input]; Legendre polynomials; lower < upper."""

    lower: float
    upper: float
    kind = "uniform"

    def __post_init__(self) -> None:
        self._ordered(self._number("lower"), self._number("upper"))

    @property
    def support(self) -> Support:
        return self.lower, self.upper

    def germ(self, x: Array) -> Array:
        # This form gives exactly -1 and 1 at the limits.
        return ((x - self.lower) - (self.upper - x)) / (self.upper - self.lower)

    def physical(self, germ: Array) -> Array:
        return self._clip(0.5 * ((1.0 - germ) * self.lower + (1.0 + germ) * self.upper))

    def ppf(self, u: ArrayLike) -> Array:
        # Through the germ, so that the median is the middle node of a grid to the last bit.
        return self.physical(2.0 * np.asarray(u, dtype=float) - 1.0)

    def cdf(self, x: Array) -> Array:
        return 0.5 * (1.0 + self.germ(x))

    def germ_derivative(self, x: Array) -> Array:
        return np.full_like(x, 2.0 / (self.upper - self.lower))

    def recurrence(self, degree: int) -> Recurrence:
        return legendre(degree)


@dataclass(frozen=True)
class LogUniform(Distribution):
    """Uniform in the logarithm between lower and upper [unit of the input], both above 0; Legendre in ln x."""

    lower: float
    upper: float
    kind = "log_uniform"

    def __post_init__(self) -> None:
        self._ordered(self._number("lower", above=0.0), self._number("upper", above=0.0))

    @property
    def support(self) -> Support:
        return self.lower, self.upper

    @property
    def _logarithms(self) -> tuple[float, float]:
        return float(np.log(self.lower)), float(np.log(self.upper))

    def germ(self, x: Array) -> Array:
        low, high = self._logarithms
        logarithm = np.log(x)
        return ((logarithm - low) - (high - logarithm)) / (high - low)

    def physical(self, germ: Array) -> Array:
        low, high = self._logarithms
        return self._clip(np.exp(0.5 * ((1.0 - germ) * low + (1.0 + germ) * high)))

    def ppf(self, u: ArrayLike) -> Array:
        return self.physical(2.0 * np.asarray(u, dtype=float) - 1.0)

    def cdf(self, x: Array) -> Array:
        return 0.5 * (1.0 + self.germ(x))

    def germ_derivative(self, x: Array) -> Array:
        low, high = self._logarithms
        return 2.0 / ((high - low) * x)

    def recurrence(self, degree: int) -> Recurrence:
        return legendre(degree)


@dataclass(frozen=True)
class Beta(Distribution):
    """Beta, density proportional to (x - lower)**(alpha - 1) (upper - x)**(beta - 1) between the limits; Jacobi."""

    alpha: float
    beta: float
    lower: float = 0.0
    upper: float = 1.0
    kind = "beta"

    def __post_init__(self) -> None:
        self._number("alpha", above=0.0)
        self._number("beta", above=0.0)
        self._ordered(self._number("lower"), self._number("upper"))

    @property
    def support(self) -> Support:
        return self.lower, self.upper

    def germ(self, x: Array) -> Array:
        return ((x - self.lower) - (self.upper - x)) / (self.upper - self.lower)

    def physical(self, germ: Array) -> Array:
        return self._clip(0.5 * ((1.0 - germ) * self.lower + (1.0 + germ) * self.upper))

    def ppf(self, u: ArrayLike) -> Array:
        fraction = special.betaincinv(self.alpha, self.beta, np.asarray(u, dtype=float))
        return self._clip(self.lower + fraction * (self.upper - self.lower))

    def cdf(self, x: Array) -> Array:
        return special.betainc(self.alpha, self.beta, 0.5 * (1.0 + self.germ(x)))

    def germ_derivative(self, x: Array) -> Array:
        return np.full_like(x, 2.0 / (self.upper - self.lower))

    def recurrence(self, degree: int) -> Recurrence:
        return jacobi(degree, self.alpha, self.beta)
