"""Draws of a stochastic model weighted by one observed run: what is likely, given what was seen, of all that they have.

Each draw has everything that follows from it, so that one set of weights gives the posterior of causes and of ends.
Source: [Beaumont-2002] (weights by a kernel about what was observed).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.given_numbers import finite_number, random_numbers, without_rounding

# Of the standard deviation of the draws' coordinates: how wide the kernel may be; the narrowest that gives enough.
WIDTHS = (0.05, 0.07, 0.1, 0.14, 0.2, 0.28, 0.4)
ENOUGH, FEWEST = 400.0, 100.0
# Of fewer draws that end as the run did no density can be told.
FEWEST_POSSIBLE = 5
# Draws that are compared with what was observed, and draws of the density by which they are.
REPLICATES, DENSITY_DRAWS = 500, 4000
# An observation that fewer draws than this are as unlikely as lies outside of what was simulated.
OUTSIDE = 0.01


@dataclass(frozen=True)
class ObservedDraws:
    """Draws with weights.

    weights [draw_count], which sum to 1; width: of the kernel, in standard deviations of the draws; effective_count: of
    so many independent draws they are worth; p_value: share of the draws that are as unlikely as what was observed,
    None where no output was.
    """

    weights: Array
    width: float
    effective_count: float
    p_value: float | None

    @property
    def is_reliable(self) -> bool:
        """Whether enough draws carry weight, and draws reach as far as what was observed."""
        return self.effective_count >= FEWEST and (self.p_value is None or self.p_value >= OUTSIDE)

    def quantiles(self, values: Array, probabilities: Sequence[float]) -> list[float]:
        """Quantiles of values of the draws [draw_count]; those that are NaN do not count."""
        return weighted_quantiles(values, self.weights, probabilities)

    def taken(self, count: int, seed: int) -> NDArray[np.int64]:
        """Places of so many draws, each as often as its weight asks for but for less than one (systematic)."""
        at = (np.arange(count) + random_numbers(seed).random()) / count
        places = np.searchsorted(np.cumsum(self.weights), at)
        return np.minimum(places, len(self.weights) - 1).astype(np.int64)


def weighted_quantiles(values: Array, weights: Array, probabilities: Sequence[float]) -> list[float]:
    """Quantiles of weighted values, both [count]; NaN values do not count. NaN where nothing has weight."""
    known = np.isfinite(values) & (weights > 0.0)
    if not known.any():
        return [float("nan")] * len(probabilities)
    order = np.argsort(values[known])
    values, weights = values[known][order], weights[known][order]
    steps = (np.cumsum(weights) - 0.5 * weights) / weights.sum()
    return [float(np.interp(one, steps, values)) for one in probabilities]


def observed_draws(
    outputs: Mapping[str, Array],
    observed: Mapping[str, float],
    errors: Mapping[str, float],
    possible: NDArray[np.bool_],
    source: NDArray[np.int64],
    seed: int = 0,
) -> ObservedDraws:
    """Weigh draws by what was observed of one run.

    outputs: of the draws by name, [draw_count] each, NaN where a draw has none; observed, errors: by name, in the same
    units; an error of 0 leaves the kernel alone. possible [draw_count]: draws that end as the run did. source
    [draw_count]: what each was drawn from; draws of one source count as one.
    The kernel is normal in coordinates asinh(y / median), in which large outputs count by their ratio, and the errors
    widen it. Raises ValueError where hardly a draw is possible, for an output without draws, and for errors below 0.
    """
    for name, deviation in errors.items():
        finite_number(f"the error of {name}", deviation, at_least=0.0)
    if unknown := sorted(set(observed) - set(outputs)):
        raise ValueError(f"{unknown[0]} is observed, which no draw has; allowed: {', '.join(outputs) or 'none'}")
    there = possible & np.all([np.isfinite(outputs[name]) for name in observed], axis=0)
    if (count := int(there.sum())) < FEWEST_POSSIBLE:
        raise ValueError(
            f"{count or 'none'} of {len(possible)} draws ended as the observed run did; allowed: at least "
            f"{FEWEST_POSSIBLE}; look at its outcome"
        )
    if not observed:
        weights = there / there.sum()
        return ObservedDraws(weights, 0.0, _effective(weights, source), None)
    scaled = [_Scaled.of(outputs[name][there], float(observed[name]), errors.get(name, 0.0)) for name in observed]
    away = np.column_stack([one.draws - one.seen for one in scaled])
    error = np.array([one.error for one in scaled])
    found, width = np.zeros(len(possible)), WIDTHS[0]
    for wider in WIDTHS:
        width = wider
        found[there] = _normalised(-0.5 * np.sum(away**2 / (width**2 + error**2), axis=1))
        if _effective(found, source) >= ENOUGH:
            break
    kernel: Array = np.sqrt(width**2 + error**2)
    return ObservedDraws(found, width, _effective(found, source), _p_value(away, kernel, error, seed))


@dataclass(frozen=True)
class _Scaled:
    """One output in its coordinate, over the standard deviation of the draws: of draws, of what was seen, its error."""

    draws: Array
    seen: float
    error: float

    @classmethod
    def of(cls, values: Array, seen: float, error: float) -> "_Scaled":
        known = without_rounding(values)
        middle = float(np.median(np.abs(known))) or 1.0
        coordinate = np.arcsinh(known / middle)
        # The deviation of equal values is rounding, not 0.
        spread = float(coordinate.std()) if np.ptp(known) > 0.0 else 1.0
        slope = 1.0 / np.hypot(middle, seen)
        return cls(coordinate / spread, float(np.arcsinh(seen / middle)) / spread, error * slope / spread)


def _normalised(logarithms: Array) -> Array:
    weights: Array = np.exp(logarithms - logsumexp(logarithms))
    return weights


def _effective(weights: Array, source: NDArray[np.int64]) -> float:
    return float(1.0 / np.sum(np.bincount(source, weights) ** 2))


def _p_value(away: Array, width: Array, error: Array, seed: int) -> float:
    """Share of draws whose density, by other draws, is not above that of what was observed.

    away [draw_count, output_count]: of the draws from what was observed; width, error [output_count]: of kernel and
    observation in that unit. The kernel is as wide as the normal rule asks for at least, so that no luck shows.
    Source: [Silverman-1986], section 4.3.
    """
    random = random_numbers(seed)
    order = random.permutation(len(away))
    replicates, others = np.split(order[: REPLICATES + DENSITY_DRAWS], [min(REPLICATES, len(order) // 2)])
    seen = away[replicates] + error * random.standard_normal((len(replicates), away.shape[1]))
    width = np.maximum(width, len(others) ** (-1.0 / (away.shape[1] + 4.0)))
    centres = away[others] / width

    def density(at: Array) -> Array:
        """Of points [point_count, output_count], [point_count]."""
        return np.array([logsumexp(-0.5 * np.sum((centres - one / width) ** 2, axis=1)) for one in at])

    observed = density(np.zeros((1, away.shape[1])))
    return float(np.mean(density(seen) <= observed))
