"""Inputs without a limit on one or both sides: normal, log-normal, gamma, exponential."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.chaos.abstract_distribution import Distribution, Support
from lithobrake.chaos.polynomials import Array, Recurrence, hermite, laguerre


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
        return -np.inf, np.inf

    def germ(self, x: Array) -> Array:
        return (x - self.mean) / self.std

    def physical(self, germ: Array) -> Array:
        return self.mean + self.std * germ

    def ppf(self, u: ArrayLike) -> Array:
        return self.physical(special.ndtri(np.asarray(u, dtype=float)))

    def cdf(self, x: Array) -> Array:
        return special.ndtr(self.germ(x))

    def germ_derivative(self, x: Array) -> Array:
        return np.full_like(x, 1.0 / self.std)

    def recurrence(self, degree: int) -> Recurrence:
        return hermite(degree)


@dataclass(frozen=True)
class LogNormal(Distribution):
    """Log-normal: ln x is normal with this mean and standard deviation; Hermite in ln x."""

    mean: float
    std: float
    kind = "log_normal"

    def __post_init__(self) -> None:
        self._number("mean")
        self._number("std", above=0.0)

    @property
    def support(self) -> Support:
        return 0.0, np.inf

    def germ(self, x: Array) -> Array:
        return (np.log(x) - self.mean) / self.std

    def physical(self, germ: Array) -> Array:
        return np.exp(self.mean + self.std * germ)

    def ppf(self, u: ArrayLike) -> Array:
        return self.physical(special.ndtri(np.asarray(u, dtype=float)))

    def cdf(self, x: Array) -> Array:
        return special.ndtr(self.germ(x))

    def germ_derivative(self, x: Array) -> Array:
        return 1.0 / (self.std * x)

    def recurrence(self, degree: int) -> Recurrence:
        return hermite(degree)


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
