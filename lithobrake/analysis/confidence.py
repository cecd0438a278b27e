"""A number with the interval that stands for it, at the one level of confidence, and what intervals are made of."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.vocabulary.arrays import Array, Labels
from lithobrake.vocabulary.given_numbers import LARGEST, finite_number, labels, numbers_or_nan, whole_number
from lithobrake.vocabulary.percentages import LEVEL as LEVEL

Bounds = tuple[float, float]

# Shares nearer than this to 0 or 1 have skewed errors: their intervals are made on the logit scale.
NEAR_CERTAIN = 0.1
NORMAL_QUANTILE_95 = 1.959963984540054
# Probabilities beyond this quantile are below the smallest float.
MOST_QUANTILE = 40.0


@dataclass(frozen=True)
class IntervalEstimate:
    """A number, the bounds that hold the truth with probability `level`, all in the unit of the number."""

    value: float
    lower: float
    upper: float
    level: float = LEVEL


def t_quantile(freedom: float) -> float:
    """Quantile of Student's t that a two-sided interval of the level reaches to."""
    from scipy import special

    return float(special.stdtrit(freedom, 0.5 + 0.5 * LEVEL))


def partial_quantile(width: float, error: float, freedom: float) -> float:
    """Errors to add outside of both ends of an identified range, so that each number within it is held at the level.

    width: of the range, at least 0; error: standard error of its ends, the larger one, above 0, in the same unit. From
    the two-sided quantile of Student's t where the range has no width down to the one-sided one where it is wide, since
    the number then can be missed at one end only.
    Source: [Imbens-2004], Eq 6 and 7, valid for ends that cannot cross by [Stoye-2009], Lemma 3; Student's t for beds.
    """
    from scipy import optimize, special

    def excess(quantile: float) -> float:
        return float(special.stdtr(freedom, quantile + width / error) - special.stdtr(freedom, -quantile)) - LEVEL

    two_sided = t_quantile(freedom)
    # Without a width rounding alone decides the sign.
    if excess(two_sided) <= 0.0:
        return two_sided
    return float(optimize.brentq(excess, 0.99 * float(special.stdtrit(freedom, LEVEL)), two_sided))


def normal_quantile() -> float:
    """Quantile of the standard normal distribution that a two-sided interval of the level reaches to."""
    from scipy import special

    return float(special.ndtri(0.5 + 0.5 * LEVEL))


def share_interval(share: float, half_width: float) -> tuple[float, float]:
    """Bounds of a share, within [0, 1]; the half width is laid on the logit scale where the share is near 0 or 1.

    Source: [Agresti-2013] (delta method: the logit's error is that of the share over p (1 - p)).
    """
    if NEAR_CERTAIN <= share <= 1.0 - NEAR_CERTAIN or share in (0.0, 1.0):
        return max(share - half_width, 0.0), min(share + half_width, 1.0)
    odds, half = share / (1.0 - share), half_width / (share * (1.0 - share))
    # Odds of exp(600) are a share of 1 to the last bit, and much larger ones overflow.
    lower, upper = odds * math.exp(-min(half, 600.0)), odds * math.exp(min(half, 600.0))
    return lower / (1.0 + lower), upper / (1.0 + upper)


def share_spread(share: float, deviation: float) -> tuple[float, float]:
    """Bounds that hold a share that varies about its mean by a standard deviation, within [0, 1].

    Near 0 or 1 the far one is a quantile of the beta law with both, as the logit of a share that reaches its end has
    none; the near one is that end, which few landings cannot tell from a share just short of it.
    """
    if NEAR_CERTAIN <= share <= 1.0 - NEAR_CERTAIN or share in (0.0, 1.0) or deviation == 0.0:
        return share_interval(share, normal_quantile() * deviation)
    from scipy import special

    # No share has a larger variance than one that is 0 or 1.
    size = share * (1.0 - share) / deviation**2 - 1.0
    if size <= 0.0:
        return 0.0, 1.0
    tail = 0.5 + 0.5 * LEVEL if share < 0.5 else 0.5 - 0.5 * LEVEL
    far = float(special.betaincinv(share * size, (1.0 - share) * size, tail))
    return (0.0, max(far, share)) if share < 0.5 else (min(far, share), 1.0)


def wilson_interval(count: int, total: int, quantile: float = NORMAL_QUANTILE_95) -> tuple[float, float]:
    """Interval of the true share when `count` of `total` independent draws have a property.

    quantile: of the standard normal distribution (1.96: 95 %). The interval stays within [0, 1] and holds near 0 and
    1, where the usual plus-minus does not. Raises ValueError for counts that cannot be, and for
    a quantile below 0.
    Source: [Wilson-1927].
    """
    count = whole_number("count", count, 0, whole_number("total", total, 1))
    finite_number("quantile", quantile, at_least=0.0, at_most=MOST_QUANTILE)
    share = count / total
    spread = quantile**2 / total
    middle = (share + spread / 2) / (1 + spread)
    half = quantile / (1 + spread) * math.sqrt(share * (1 - share) / total + spread / (4 * total))
    # The ends at nobody and at everybody are exact; rounding would leave them a hair away.
    return (0.0 if count == 0 else max(middle - half, 0.0)), (1.0 if count == total else min(middle + half, 1.0))


def numbered_beds(bed: ArrayLike, run_count: int) -> Labels:
    """Beds of the runs, [run_count], of any labels, renumbered from 0; raises ValueError for another shape."""
    beds = labels("bed", bed, run_count, "each run")
    return np.unique(beds, return_inverse=True)[1].astype(np.int64)


def answers(name: str, values: ArrayLike) -> Array:
    """Values of runs [run_count], NaN where a run has none or it is masked; raises ValueError for infinite ones."""
    known = numbers_or_nan(name, values)
    beyond = int((np.abs(known) > LARGEST).sum())
    if known.ndim != 1 or beyond:
        raise ValueError(
            f"{name} has shape {known.shape} and {beyond} infinite values or beyond {LARGEST:g}, but must be a number "
            "for each run: NaN where a run has none"
        )
    return known


def answered_runs(values: ArrayLike, bed: ArrayLike) -> tuple[Array, Labels]:
    """Values of the runs that have one, of values [run_count] with NaN, and their beds numbered from 0, [count]."""
    of_all = answers("values", values)
    known = np.isfinite(of_all)
    beds = numbered_beds(bed, len(of_all))[known]
    return of_all[known], numbered_beds(beds, len(beds))
