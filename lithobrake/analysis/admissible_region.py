"""Which values of a parameter leave a probability as large as is required, and how sure the edge of these is."""

import math
from collections.abc import Sequence

import numpy as np
from scipy import optimize

from lithobrake.analysis.confidence import bed_components, numbered_beds, share_spread
from lithobrake.analysis.share_estimate import BED_VARIANCE_CONFIDENCE
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.estimate import LEVEL, Estimate
from lithobrake.vocabulary.requirement import AdmissibleEdge, Verdict

FEW = "fewer than two of the values have a result"
GAP = "between values with a result there are some without"
RISES_AND_FALLS = "the probability both rises and falls with it by more than its intervals allow"


def verdict(probability: Estimate, required: float) -> Verdict:
    """Whether a probability with its interval is at least as large as is required."""
    assert probability.bounds is not None
    lower, upper = probability.bounds
    return Verdict.MET if lower >= required else Verdict.NOT_MET if upper < required else Verdict.OPEN


def with_grounds(mean: Estimate, met: Array, bed: np.ndarray, level: float = LEVEL) -> Estimate:
    """A probability over grounds, with the interval of that on one of them at the level.

    mean: with the interval of the mean over grounds; met [lander_count], 0 or 1, and bed: the ground of each lander.
    The error of the mean and the spread between grounds, which stands at an upper limit, are added as independent.
    Source: [Searle-1992], section 3.6 (components of variance); [Zou-2008] (recovered variances).
    """
    assert mean.bounds is not None
    beds = numbered_beds(bed, len(met))
    components = bed_components(np.asarray(met, dtype=float), beds)
    spread = share_spread(mean.value, math.sqrt(components.variance_at(BED_VARIANCE_CONFIDENCE)), level)
    lower, upper = (
        sign * math.hypot(end - mean.value, far - mean.value)
        for sign, end, far in zip((-1.0, 1.0), mean.bounds, spread, strict=True)
    )
    return Estimate(mean.value, max(mean.value + lower, 0.0), min(mean.value + upper, 1.0), level)


def admissible_edge(values: Sequence[float], found: Sequence[Estimate | None], required: float) -> AdmissibleEdge:
    """The edge of the values of a parameter, in ascending order, at which a probability is as large as is required.

    found: the probability at each value with its interval; None where there is no result. The edge is one of the values
    with a result, and there is none where these have others between them: nothing is known across a gap. Probabilities
    and both ends of their intervals are taken as one monotone function each, the nearest in least squares, and linear
    between values. No edge where these leave the interval of a value: the admissible values then have more than one.
    Source: [Barlow-1972] (isotonic regression).
    """
    places = [(place, one, one.bounds) for place, one in enumerate(found) if one and one.bounds]
    if len(places) < 2:
        return AdmissibleEdge(False, why=FEW)
    first, last = places[0][0], places[-1][0]
    known = values[first], values[last]
    if len(places) <= last - first:
        return AdmissibleEdge(False, why=GAP, known=known)
    x, p = np.array(values[first : last + 1], dtype=float), np.array([one.value for _, one, _ in places])
    lower, upper = np.array([bounds for _, _, bounds in places]).T
    curves = np.array([p, lower, upper])
    fits = {falls: np.array([_monotone(curve, falls=falls) for curve in curves]) for falls in (True, False)}
    # Of a probability that stays, the ends of its interval may still say which way it goes.
    falls = bool(np.sum((fits[True] - curves) ** 2) <= np.sum((fits[False] - curves) ** 2))
    fit = fits[falls]
    if ((fit[0] < lower) | (fit[0] > upper)).any():
        return AdmissibleEdge(falls, why=RISES_AND_FALLS, known=known)
    value, sure, possible = (_crossing(x, curve, required, falls=falls) for curve in fit)
    return AdmissibleEdge(falls, value, sure, possible, known=known)


def _monotone(y: Array, *, falls: bool) -> Array:
    fit: Array = optimize.isotonic_regression(y, increasing=not falls).x
    return fit


def _crossing(x: Array, y: Array, required: float, *, falls: bool) -> float:
    """Where a monotone function is as large as is required, linear between values; infinite where nowhere or always."""
    if not falls:
        return -_crossing(-x[::-1], y[::-1], required, falls=True)
    enough = np.flatnonzero(y >= required)
    if not len(enough) or len(enough) == len(y):
        return math.inf if len(enough) else -math.inf
    last = int(enough[-1])
    part = (y[last] - required) / (y[last] - y[last + 1])
    return float(x[last] + part * (x[last + 1] - x[last]))
