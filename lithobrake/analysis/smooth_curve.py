"""A share and a median as smooth curves of a size that differs from bed to bed, with bounds over resampled beds."""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import LEVEL
from lithobrake.analysis.missing_runs import filled, lost_runs
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.estimate import Estimate

# Of the kernel, over the range of the logarithm of the sizes: a curve has some three independent parts.
WIDTH = 0.16
POINTS, RESAMPLES = 13, 200


def curve_sizes(size: ArrayLike) -> Array:
    """Sizes at which a curve is worked out, evenly in their logarithm from the smallest to the largest, [POINTS]."""
    values = np.asarray(size, dtype=float)
    found: Array = np.geomspace(values.min(), values.max(), POINTS)
    return found


def share_curve(
    met: ArrayLike, size: ArrayLike, bed: ArrayLike, seed: int, missing: ArrayLike | None = None
) -> list[Estimate]:
    """The share of runs that meet an event [run_count, 0 or 1, NaN: not asked] at each of curve_sizes(size).

    size: of the bed of each run [run_count], above 0; bed: label of the bed [run_count]. A mean weighted by a normal
    kernel in the logarithm of the size; bounds hold LEVEL of the curves of resampled beds. missing [run_count]: whether
    it is not known what became of a run; bounds are those with all of them at either end.
    Source: [Nadaraya-1964] (kernel regression); [Davison-1997], section 3.8 (resampling of clusters).
    """

    def curve(values: Array) -> list[Estimate]:
        known = ~np.isnan(values)
        return _curve(lambda weight: weight @ values[known] / weight.sum(axis=1), known, size, bed, seed)

    return _over_missing(curve, met, missing, (0.0, 1.0))


def median_curve(
    y: ArrayLike, size: ArrayLike, bed: ArrayLike, seed: int, missing: ArrayLike | None = None
) -> list[Estimate]:
    """The same of the median of an output y [run_count], NaN where a run has none."""

    def curve(values: Array) -> list[Estimate]:
        known = ~np.isnan(values)
        order = np.argsort(values[known])

        def medians(weight: Array) -> Array:
            below = np.cumsum(weight[:, order], axis=1)
            place = np.argmax(below >= 0.5 * below[:, -1:], axis=1)
            found: Array = values[known][order][place]
            return found

        return _curve(medians, known, size, bed, seed)

    return _over_missing(curve, y, missing, (-math.inf, math.inf))


def _over_missing(
    curve: Callable[[Array], list[Estimate]], y: ArrayLike, missing: ArrayLike | None, limits: tuple[float, float]
) -> list[Estimate]:
    """A curve whose bounds are those with missing runs at either limit; a bound beyond all values is None."""
    values = np.asarray(y, dtype=float)
    lost, found = lost_runs(missing, values), curve(values)
    if not lost.any():
        return found
    ends = [curve(one) for one in filled(values, lost, limits)]
    return [
        replace(one, lower=_finite(least.lower), upper=_finite(most.upper))
        for one, least, most in zip(found, *ends, strict=True)
    ]


def _finite(end: float | None) -> float | None:
    return end if end is not None and math.isfinite(end) else None


def _curve(
    of: Callable[[Array], Array], known: np.ndarray, size: ArrayLike, bed: ArrayLike, seed: int
) -> list[Estimate]:  # fmt: skip
    """The curve of what weights [POINTS, run_count] give, of runs that are known."""
    logarithm = np.log(np.asarray(size, dtype=float))
    at, width = np.log(curve_sizes(size)), WIDTH * np.ptp(logarithm)
    weight = np.exp(-0.5 * ((at[:, None] - logarithm[known]) / width) ** 2)
    beds, place = np.unique(np.asarray(bed), return_inverse=True)
    chance = np.random.Generator(np.random.PCG64(seed))
    drawn = chance.multinomial(len(beds), np.full(len(beds), 1.0 / len(beds)), RESAMPLES).astype(float)
    # A curve of resampled beds that leaves a size without any bed says nothing there.
    with np.errstate(invalid="ignore", divide="ignore"):
        found = np.array([of(weight * one[place[known]]) for one in drawn])
    lower, upper = np.nanquantile(found, [0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL], axis=0)
    return [
        Estimate(float(one), float(low), float(high)) for one, low, high in zip(of(weight), lower, upper, strict=True)
    ]
