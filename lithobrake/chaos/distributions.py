"""Uncertain inputs: the interface of a distribution, and the kinds whose orthonormal polynomials have a name."""

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.chaos.polynomials import Recurrence, hermite, jacobi, laguerre, legendre
from lithobrake.vocabulary.array_types import Array

Support = tuple[float, float]
NO_CHOICES = "discrete choices are not supported: fit one expansion for each choice"


class Distribution(ABC):
    """One uncertain input. Subclasses are frozen dataclasses whose fields are the parameters."""

    kind: ClassVar[str]
    # Whether the germ is a function of ln x.
    logarithmic: ClassVar[bool] = False

    @property
    @abstractmethod
    def support(self) -> Support:
        """Smallest and largest possible value [unit of the input]; infinite where unbounded."""

    @abstractmethod
    def germ(self, x: Array) -> Array:
        """Germ of values x [any shape]."""

    @abstractmethod
    def physical(self, germ: Array) -> Array:
        """Values x of a germ [any shape]; never outside the support because of rounding."""

    @abstractmethod
    def ppf(self, u: ArrayLike) -> Array:
        """Quantiles at probabilities u [any shape], 0 <= u <= 1."""

    @abstractmethod
    def cdf(self, x: Array) -> Array:
        """Probabilities of not exceeding values x [any shape] inside the support."""

    @abstractmethod
    def recurrence(self, degree: int) -> Recurrence:
        """Polynomials in the germ, orthonormal in this distribution, up to a degree."""

    @abstractmethod
    def germ_derivative(self, x: Array) -> Array:
        """Derivative of the germ with respect to x [1 / unit of the input]."""

    def gauss(self, count: int) -> tuple[Array, Array]:
        """Germ nodes and weights (summing to 1), exact for polynomials up to degree 2 count - 1; at most `count`
        unless samples determine fewer.
        """
        return self.recurrence(count).gauss_rule()

    def rule(self, count: int) -> tuple[Array, Array]:
        """Germ nodes and weights (summing to 1) of a fine quadrature over this distribution, about `count` of each."""
        return self.gauss(count)

    @property
    def highest_degree(self) -> float:
        """Highest degree of polynomials that the distribution determines: infinite unless it is made of samples."""
        return np.inf

    @property
    def bounded(self) -> bool:
        """Whether both ends of the support are finite."""
        return bool(np.all(np.isfinite(self.support)))

    @property
    def median(self) -> float:
        """Value that is exceeded with probability one half."""
        return float(self.ppf(0.5))

    def to_json(self) -> dict[str, Any]:
        """Kind and parameters as plain JSON values; an infinite limit is the text "inf", as JSON has no such number."""
        content: dict[str, Any] = {"kind": self.kind}
        for field in fields(self):  # type: ignore[arg-type]
            value = getattr(self, field.name)
            as_it_is = list(value) if isinstance(value, tuple) else value
            content[field.name] = as_it_is if np.all(np.isfinite(value)) else str(value)
        return content

    def _clip(self, x: Array) -> Array:
        return np.clip(x, *self.support)

    def _scaled(self, x: Array) -> Array:
        return np.log(x) if self.logarithmic else x

    def _unscaled(self, values: Array) -> Array:
        return np.exp(values) if self.logarithmic else values

    def _per_unit(self, germ: float, scaled: float, x: Array) -> Array:
        """Derivative by x of a germ that grows by so much over so much of x, or of ln x."""
        return germ / (scaled * (x if self.logarithmic else np.ones_like(x)))

    def _number(self, name: str, above: float | None = None, finite: bool = True) -> float:
        """Check a parameter, store it as a float and give it back."""
        value = getattr(self, name)
        where = f"{type(self).__name__}.{name}"
        try:
            number = float(value)
        except (TypeError, ValueError):
            raise ValueError(f"{where} is {value!r}, but must be a number") from None
        if np.isnan(number) or (finite and np.isinf(number)):
            raise ValueError(f"{where} is {number}, but must be {'finite' if finite else 'a number'}")
        if above is not None and number <= above:
            raise ValueError(f"{where} is {number}, but must be greater than {above:g}")
        object.__setattr__(self, name, number)
        return number

    def _ordered(self, lower: float, upper: float) -> None:
        if not lower < upper:
            raise ValueError(
                f"{type(self).__name__} has lower {lower:g} and upper {upper:g}, but lower must be less than upper; "
                "give a certain input as a plain number instead"
            )


class Limited(Distribution):
    """An input between two finite limits, which are -1 and 1 of the germ."""

    lower: float
    upper: float

    @property
    def support(self) -> Support:
        return self.lower, self.upper

    @property
    def _limits(self) -> tuple[float, float]:
        """The limits, or their logarithms."""
        lower, upper = self.support
        return (float(np.log(lower)), float(np.log(upper))) if self.logarithmic else (lower, upper)

    def germ(self, x: Array) -> Array:
        (low, high), value = self._limits, self._scaled(x)
        # This form gives exactly -1 and 1 at the limits.
        return ((value - low) - (high - value)) / (high - low)

    def physical(self, germ: Array) -> Array:
        low, high = self._limits
        # The germs -1 and 1 give the limits without rounding, but the exponential of a logarithm may miss them.
        return self._clip(self._unscaled(0.5 * ((1.0 - germ) * low + (1.0 + germ) * high)))

    def germ_derivative(self, x: Array) -> Array:
        low, high = self._limits
        return self._per_unit(2.0, high - low, x)


@dataclass(frozen=True)
class Uniform(Limited):
    """Uniform between lower and upper [unit of the input]; Legendre polynomials; lower < upper."""

    lower: float
    upper: float
    kind = "uniform"

    def __post_init__(self) -> None:
        above = 0.0 if self.logarithmic else None
        self._ordered(self._number("lower", above), self._number("upper", above))

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
        # log1p and expm1 keep the digits of small probabilities, which 1 - u would lose.
        return -np.log1p(-np.asarray(u, dtype=float)) / self.rate

    def cdf(self, x: Array) -> Array:
        return -np.expm1(-self.germ(x))

    def germ_derivative(self, x: Array) -> Array:
        return np.full_like(x, self.rate)

    def recurrence(self, degree: int) -> Recurrence:
        return laguerre(degree, 1.0)
