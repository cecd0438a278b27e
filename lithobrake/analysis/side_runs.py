"""What small side designs say: twins of a run, a tenth of a millimetre away, and pairs with a second soil."""

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import LEVEL, IntervalEstimate, answers
from lithobrake.vocabulary.arrays import Array

# So few squares miss the rare large ones, which carry much of the effect: their own scatter says too little of it.
# Measured on normal, Ishigami's and synthetic landings: bounds hold 0.83 to 0.93 with it, 0.76 to 0.86 without.
SKEWNESS_FACTOR = 1.5


def chaos_variance(differences: ArrayLike) -> IntervalEstimate:
    """Variance that chaos alone gives an output, from differences [pair_count] of twins [unit of the output].

    Twins differ in nothing that anyone could know, so half the mean square of their difference is the variance.
    NaN: not known. Raises ValueError where no difference is known, or one is infinite.
    Source: [Searle-1992], section 3.5 (chi-square interval).
    """
    from scipy import special

    squares = _squares(differences)
    total, count = 0.5 * float(squares.sum()), len(squares)
    lower, upper = (total / float(special.chdtri(count, 0.5 - side * LEVEL)) for side in (0.5, -0.5))
    return IntervalEstimate(total / count, lower, upper)


def soil_total_effect(differences: ArrayLike, y: ArrayLike) -> IntervalEstimate:
    """Share of an output's variance that goes with its soil, interactions with bed, place and attitude included.

    differences [pair_count] between two soils of their own on the same bed, place and attitude; y [run_count]: the
    output over the input distributions, NaN where a run has none. The interval is that of a chi-square number which
    scatters as the squares of both do. Few pairs may show more than the whole variance: value and bounds are cut at 1,
    and an interval that reaches from near 0 to 1 says that so many pairs cannot tell. Raises ValueError where fewer
    than two differences or runs are known, or all runs are alike.
    Source: [Jansen-1999]; [Searle-1992] (Satterthwaite's degrees of freedom).
    """
    from scipy import special

    halves, known = 0.5 * _squares(differences), answers("y", y)
    known = known[np.isfinite(known)]
    if len(halves) < 2 or len(known) < 2 or np.ptp(known) == 0.0:
        raise ValueError(f"{len(halves)} pairs and {len(known)} runs, or runs all alike; give two or more that differ")
    deviations = (known - known.mean()) ** 2
    effect = min(float(halves.mean() * len(known) / ((len(known) - 1) * deviations.mean())), 1.0)
    if effect == 0.0:
        return IntervalEstimate(0.0, 0.0, 0.0)
    error = sum(float(one.var(ddof=1) / (len(one) * one.mean() ** 2)) for one in (halves, deviations))
    freedom = 2.0 / (SKEWNESS_FACTOR * error)
    lower, upper = (effect * freedom / float(special.chdtri(freedom, 0.5 - side * LEVEL)) for side in (0.5, -0.5))
    return IntervalEstimate(effect, lower, min(upper, 1.0))


def _squares(differences: ArrayLike) -> Array:
    known = answers("differences", differences)
    known = known[np.isfinite(known)]
    if len(known) == 0:
        raise ValueError("no difference is known; give those of at least one pair in which both runs have the output")
    squares: Array = known**2
    return squares
