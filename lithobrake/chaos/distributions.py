"""Inputs whose polynomials have a name: uniform, normal and their logarithmic kinds, beta, gamma, exponential."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.chaos.abstract_distribution import Distribution, Limited, Support
from lithobrake.chaos.polynomials import Recurrence, hermite, jacobi, laguerre, legendre
from lithobrake.vocabulary.arrays import Array


@dataclass(frozen=True)
class Uniform(Limited):
    """Uniform between lower and upper [unit of the input]; Legendre polynomials; lower < upper."""

    lower: float
    upper: float
    kind = "uniform"

    def __post_init__(self) -> None:
        above = 0.0 if self.logarithmic else None
        self._ordered(self._number("lower", above), self._number("upper", above))

    @property
    def support(self) -> Support:
        return self.lower, self.upper

    def ppf(self, u: ArrayLike) -> Array:
        # Through the germ, so that the median is the middle node of a grid to the last bit.
        return self.physical(2.0 * np.asarray(u, dtype=float) - 1.0)

    def cdf(self, x: Array) -> Array:
        return 0.5 * (1.0 + self.germ(x))

    def recurrence(self, degree: int) -> Recurrence:
        return legendre(degree)


@dataclass(frozen=True)
class LogUniform(Uniform):
    """Uniform in the logarithm between lower and upper [unit of the input], both above 0; Legendre in ln x."""

    kind = "log_uniform"
    logarithmic = True


@dataclass(frozen=True)
class Beta(Limited):
    """Beta, density proportional to `(x - lower)**(alpha - 1) (upper - x)**(beta - 1)` between the limits; Jacobi."""

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

    def ppf(self, u: ArrayLike) -> Array:
        fraction = special.betaincinv(self.alpha, self.beta, np.asarray(u, dtype=float))
        return self._clip(self.lower + fraction * (self.upper - self.lower))

    def cdf(self, x: Array) -> Array:
        return special.betainc(self.alpha, self.beta, 0.5 * (1.0 + self.germ(x)))

    def recurrence(self, degree: int) -> Recurrence:
        return jacobi(degree, self.alpha, self.beta)


@dataclass(frozen=True)
class Normal(Distribution):
    """Normal with mean and standard deviation [unit of the input]; Hermite polynomials."""

    mean: float
    std: float
    kind = "normal"

    def __post_init__(self) -> None:
        self._number("mean")
        self._number("std", above=0.0)

    @property
    def support(self) -> Support:
        return 0.0 if self.logarithmic else -np.inf, np.inf

    def germ(self, x: Array) -> Array:
        return (self._scaled(x) - self.mean) / self.std

    def physical(self, germ: Array) -> Array:
        return self._unscaled(self.mean + self.std * germ)

    def ppf(self, u: ArrayLike) -> Array:
        return self.physical(special.ndtri(np.asarray(u, dtype=float)))

    def cdf(self, x: Array) -> Array:
        return special.ndtr(self.germ(x))

    def germ_derivative(self, x: Array) -> Array:
        return self._per_unit(1.0, self.std, x)

    def recurrence(self, degree: int) -> Recurrence:
        return hermite(degree)


@dataclass(frozen=True)
class LogNormal(Normal):
    """Log-normal: ln x is normal with this mean and standard deviation; Hermite in ln x."""

    kind = "log_normal"
    logarithmic = True


@dataclass(frozen=True)
class Gamma(Distribution):
    """Gamma with a shape and a scale [unit of the input]; generalised Laguerre polynomials."""

    shape: float
    scale: float
    kind = "gamma"

    def __post_init__(self) -> None:
        self._number("shape", above=0.0)
        self._number("scale", above=0.0)

    @property
    def support(self) -> Support:
        return 0.0, np.inf

    def germ(self, x: Array) -> Array:
        return x / self.scale

    def physical(self, germ: Array) -> Array:
        return self._clip(self.scale * germ)

    def ppf(self, u: ArrayLike) -> Array:
        return self.scale * special.gammaincinv(self.shape, np.asarray(u, dtype=float))

    def cdf(self, x: Array) -> Array:
        return special.gammainc(self.shape, self.germ(x))

    def germ_derivative(self, x: Array) -> Array:
        return np.full_like(x, 1.0 / self.scale)

    def recurrence(self, degree: int) -> Recurrence:
        return laguerre(degree, self.shape)


@dataclass(frozen=True)
class Exponential(Distribution):
    """Exponential with a rate [1 / unit of the input], mean 1 / rate; Laguerre polynomials."""

    rate: float
    kind = "exponential"

    def __post_init__(self) -> None:
        self._number("rate", above=0.0)

    @property
    def support(self) -> Support:
        return 0.0, np.inf

    def germ(self, x: Array) -> Array:
        return x * self.rate

    def physical(self, germ: Array) -> Array:
        return self._clip(germ / self.rate)

    def ppf(self, u: ArrayLike) -> Array:
        return -np.log1p(-np.asarray(u, dtype=float)) / self.rate

    def cdf(self, x: Array) -> Array:
        return -np.expm1(-self.germ(x))

    def germ_derivative(self, x: Array) -> Array:
        return np.full_like(x, self.rate)

    def recurrence(self, degree: int) -> Recurrence:
        return laguerre(degree, 1.0)
