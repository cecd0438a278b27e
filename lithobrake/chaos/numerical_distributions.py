"""Inputs whose orthonormal polynomials are computed, and the list of all distributions."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from lithobrake.chaos import distributions
from lithobrake.chaos.polynomials import Recurrence, discretised
from lithobrake.vocabulary.array_types import Array

# Densities below exp(-350) of the largest cannot be felt by polynomials of the degrees in use.
NEGLIGIBLE_LOG_DENSITY = 350.0
# Weights of one long Gauss rule lose digits near its ends; panels of a short rule do not.
PANEL_NODES, PANELS = 40, 20
# A mean so many standard deviations beyond the limits leaves no digits of a normal between them, but an exponential; a
# standard deviation of so many times the way between them leaves a uniform.
FARTHEST_MEAN, WIDEST = 100.0, 1e6
# Samples that a fine rule keeps for each node asked for.
SAMPLES_PER_NODE = 10
# Polynomials of samples are made up to this degree, or to where rounding spoils their orthonormality by this much: at
# a lone far value a polynomial of high degree is the small difference of huge numbers.
SAMPLE_DEGREE, SAMPLE_ERROR = 40, 1e-8


@dataclass(frozen=True)
class TruncatedNormal(distributions.Distribution):
    """Normal(mean, std) restricted to lower <= x <= upper [unit of the input]; either limit may be infinite.

    mean and std are those before truncation. Polynomials by discretisation of the density on Gauss-Legendre nodes.
    """

    mean: float
    std: float
    lower: float
    upper: float
    kind = "truncated_normal"

    def __post_init__(self) -> None:
        self._number("mean")
        self._number("std", above=0.0)
        self._ordered(self._number("lower", finite=False), self._number("upper", finite=False))
        self._normal_between_limits()

    def _normal_between_limits(self) -> None:
        """Raise ValueError where the limits leave nothing of a normal that numbers could hold."""
        low, high = self._standardised
        finite = [z for z, limit in ((low, self.lower), (high, self.upper)) if np.isfinite(limit)]
        if not np.all(np.isfinite(finite)) or low > FARTHEST_MEAN or high < -FARTHEST_MEAN:
            raise ValueError(
                f"TruncatedNormal.mean is {self.mean:g} with std {self.std:g}, but must be within {FARTHEST_MEAN:g} "
                f"std of the limits {self.lower:g} and {self.upper:g}: move it"
            )
        if high - low < 1.0 / WIDEST:
            raise ValueError(
                f"TruncatedNormal.std is {self.std:g}, but must be at most {WIDEST:g} times the way from lower "
                f"{self.lower:g} to upper {self.upper:g}: write uniform"
            )

    @property
    def _standardised(self) -> tuple[float, float]:
        """The limits as they are, counted from the mean in standard deviations."""
        return (self.lower - self.mean) / self.std, (self.upper - self.mean) / self.std

    @property
    def support(self) -> distributions.Support:
        return self.lower, self.upper

    @cached_property
    def _limits(self) -> tuple[float, float]:
        """Standardised limits beyond which the density is zero or negligible."""
        low, high = self._standardised
        mode = min(max(0.0, low), high)
        reach = float(np.sqrt(mode * mode + 2.0 * NEGLIGIBLE_LOG_DENSITY))
        return max(low, -reach), min(high, reach)

    @cached_property
    def _frame(self) -> tuple[float, float]:
        """Middle and half-width of the interval that becomes [-1, 1]."""
        low, high = self._limits
        lower = self.lower if np.isfinite(self.lower) else self.mean + self.std * low
        upper = self.upper if np.isfinite(self.upper) else self.mean + self.std * high
        return 0.5 * (lower + upper), 0.5 * (upper - lower)

    def germ(self, x: Array) -> Array:
        middle, half = self._frame
        return (x - middle) / half

    def physical(self, germ: Array) -> Array:
        middle, half = self._frame
        return self._clip(middle + half * germ)

    def ppf(self, u: ArrayLike) -> Array:
        probability = np.asarray(u, dtype=float)
        low, high = self._standardised
        # In the right tail the mirrored problem keeps all digits; logarithms keep the far tail from underflow.
        sign = -1.0 if low + high > 0.0 else 1.0
        if sign < 0.0:
            low, high, probability = -high, -low, 1.0 - probability
        with np.errstate(divide="ignore"):
            logarithm = np.logaddexp(
                special.log_ndtr(low) + np.log1p(-probability),
                special.log_ndtr(high) + np.log(probability),
            )
        return self._clip(self.mean + self.std * sign * special.ndtri_exp(logarithm))

    def cdf(self, x: Array) -> Array:
        low, high = self._standardised
        z, sign = (np.asarray(x) - self.mean) / self.std, 1.0
        # Differences of tails keep their digits only on the left side of the normal.
        if low + high > 0.0:
            low, high, z, sign = -high, -low, -z, -1.0
        start, end, here = special.log_ndtr(low), special.log_ndtr(high), special.log_ndtr(z)
        # Exponents at most 0, so that nothing overflows; at a lower limit of -infinity start - here is -infinity.
        with np.errstate(invalid="ignore"):
            below = np.where(here > start, start - here, 0.0)
        probability = np.exp(here - end) * np.expm1(below) / np.expm1(start - end) + 0.0
        return probability if sign > 0.0 else 1.0 - probability

    def germ_derivative(self, x: Array) -> Array:
        return np.full_like(x, 1.0 / self._frame[1])

    def recurrence(self, degree: int) -> Recurrence:
        low, high = self._limits
        nodes, weights = np.polynomial.legendre.leggauss(max(PANEL_NODES, degree))
        edges = np.linspace(low, high, PANELS + 1)[:, None]
        z = (0.5 * (edges[:-1] + edges[1:]) + 0.5 * (edges[1:] - edges[:-1]) * nodes).ravel()
        mode = min(max(0.0, low), high)
        # Over its largest value: (z - m)(z + m) does not underflow where the limits lie far out in a tail, as exp(-z^2
        # / 2) would.
        density = np.tile(weights, PANELS) * np.exp(-0.5 * (z - mode) * (z + mode))
        return discretised(degree, self.germ(self.mean + self.std * z), density / density.sum())


@dataclass(frozen=True)
class Empirical(distributions.Limited):
    """The samples themselves [unit of the input], equally probable; polynomials orthonormal over exactly these values.

    Quantiles are sample values (no interpolation), so that a Monte Carlo has the moments that the expansion states.
    Raises ValueError for fewer than two distinct or for non-finite samples.
    """

    samples: Sequence[float]
    kind = "empirical"

    def __post_init__(self) -> None:
        try:
            values = np.sort(np.asarray(self.samples, dtype=float).ravel())
        except (TypeError, ValueError):
            raise ValueError(
                f"Empirical.samples must be numbers, but holds others; {distributions.NO_CHOICES}"
            ) from None
        if not np.all(np.isfinite(values)) or len(np.unique(values)) < 2:
            raise ValueError(
                f"Empirical.samples holds {values.size} values, but needs finite ones, at least two of them distinct"
            )
        object.__setattr__(self, "samples", tuple(values.tolist()))

    @cached_property
    def _sorted(self) -> Array:
        return np.asarray(self.samples, dtype=float)

    @property
    def support(self) -> distributions.Support:
        return self.samples[0], self.samples[-1]

    def ppf(self, u: ArrayLike) -> Array:
        count = len(self.samples)
        place = np.ceil(np.asarray(u, dtype=float) * count).astype(int) - 1
        return self._sorted[np.clip(place, 0, count - 1)]

    def cdf(self, x: Array) -> Array:
        # The middle of the step, so that no value has probability 0 or 1.
        below, upto = (np.searchsorted(self._sorted, x, side=side) for side in ("left", "right"))
        count = len(self.samples)
        return np.clip(0.5 * (below + upto) / count, 0.5 / count, 1.0 - 0.5 / count)

    def _measure(self) -> tuple[Array, Array]:
        # Equal values share one node, so that ties do not cost orthogonality.
        nodes, repeats = np.unique(self._sorted, return_counts=True)
        return self.germ(nodes), repeats / len(self.samples)

    def gauss(self, count: int) -> tuple[Array, Array]:
        # The samples themselves are exact for any degree, only more.
        return super().gauss(count) if count <= self.highest_degree else self._measure()

    def rule(self, count: int) -> tuple[Array, Array]:
        nodes, weights = self._measure()
        if len(nodes) <= SAMPLES_PER_NODE * count:
            return nodes, weights
        # Of many samples neighbours are merged into their means: a fine rule, not the measure itself.
        starts = np.linspace(0, len(nodes), SAMPLES_PER_NODE * count, endpoint=False).astype(int)
        merged = np.add.reduceat(weights, starts)
        return np.add.reduceat(weights * nodes, starts) / merged, merged

    @cached_property
    def _polynomials(self) -> Recurrence:
        nodes, weights = self._measure()
        made = discretised(min(len(nodes) - 1, SAMPLE_DEGREE), nodes, weights)
        # Degrees beyond the usable ones may overflow; they are left out just below.
        with np.errstate(over="ignore", invalid="ignore"):
            table = made.values(nodes)
            error = np.abs((table * weights) @ table.T - np.eye(len(table)))
        worst = np.maximum.accumulate(np.tril(error).max(axis=1))
        usable = int(np.sum(worst < SAMPLE_ERROR)) - 1
        return Recurrence(made.center[:usable], made.spread[:usable])

    @property
    def highest_degree(self) -> float:
        return self._polynomials.degree

    def recurrence(self, degree: int) -> Recurrence:
        made = self._polynomials
        if degree > made.degree:
            raise ValueError(
                f"degree {degree} is asked of {len(self.samples)} samples with {len(np.unique(self._sorted))} distinct "
                f"values, which determine polynomials up to degree {made.degree}: lower the degree or give more samples"
            )
        return Recurrence(made.center[:degree], made.spread[:degree])


KINDS: dict[str, type[distributions.Distribution]] = {
    entry.kind: entry
    for entry in (
        distributions.Uniform,
        distributions.LogUniform,
        distributions.Normal,
        distributions.LogNormal,
        TruncatedNormal,
        distributions.Beta,
        distributions.Gamma,
        distributions.Exponential,
        Empirical,
    )
}


def distribution(kind: str, **parameters: Any) -> distributions.Distribution:
    """Build a distribution from its name, for instance distribution("uniform", lower=0, upper=1).

    Raises ValueError for an unknown name, a missing, a surplus or a wrong parameter.
    """
    if kind not in KINDS:
        raise ValueError(f"distribution is {kind!r}, but must be one of {', '.join(KINDS)}; {distributions.NO_CHOICES}")
    maker = KINDS[kind]
    allowed = [field.name for field in fields(maker)]  # type: ignore[arg-type]
    surplus = sorted(set(parameters) - set(allowed))
    if surplus:
        raise ValueError(f"distribution {kind!r} has no parameter {', '.join(surplus)}: it takes {', '.join(allowed)}")
    try:
        return maker(**parameters)
    except TypeError:
        missing = [name for name in allowed if name not in parameters]
        raise ValueError(f"distribution {kind!r} lacks {', '.join(missing)}: it takes {', '.join(allowed)}") from None


def checked_inputs(inputs: Any) -> dict[str, distributions.Distribution]:
    """Check a mapping of input names to distributions and give it back as an ordered dict."""
    if not hasattr(inputs, "items") or not inputs:
        raise ValueError("inputs must be a dict of at least one name with its distribution, for instance Uniform(0, 1)")
    for name, entry in inputs.items():
        if not isinstance(entry, distributions.Distribution):
            raise ValueError(
                f"input {name!r} is {entry!r}, but must be a distribution "
                f"({', '.join(known.__name__ for known in KINDS.values())}); {distributions.NO_CHOICES}"
            )
    return dict(inputs)
