"""Quantiles and mean of an output, and mean direction of an angle, on beds that were not in the study."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import optimize, special

from lithobrake.analysis.confidence import LEVEL, Bounds, answered_runs, normal_quantile, t_quantile
from lithobrake.analysis.share_estimate import ONE_BED, standard_error
from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.constants import FEWEST_BEDS_OF_TAIL
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.number_words import QUANTILES

# Quantiles of less than this probability, or more than 1 less it, take so many beds for an interval: on fewer beds a
# handful of runs beyond the quantile lie on one or two of them (measured: docs/estimates.md).
TAIL = 0.1


def mean_estimate(y: ArrayLike, bed: ArrayLike, *, level: float = LEVEL) -> Estimate:
    """Mean of an output y [run_count], NaN where a run has none, with its interval of a level from beds [run_count].

    For an output with a heavy tail, as the contact time, read the quantiles: a few rare runs carry much of its mean,
    and where a study has none of them the interval promises too much (0.73 to 0.93 at a tail index of 1.9). Raises
    ValueError for runs on one bed. Source: [Cameron-2008] (errors from few clusters).
    """
    values, beds = _known(y, bed)
    mean, half = float(values.mean()), t_quantile(int(beds.max()), level) * standard_error(values, beds)
    return Estimate(mean, mean - half, mean + half, level)


def quantile_estimates(y: ArrayLike, bed: ArrayLike, probabilities: Sequence[float] = QUANTILES) -> list[Estimate]:
    """Quantiles of an output y [run_count], NaN where a run has none, with their intervals from beds [run_count].

    The share of runs below a quantile has an interval from beds; the bounds are the quantiles at its ends, so they
    follow the skewness of the output and stay among its values. Below 0.1 and above 0.9 fewer than ten beds give no
    interval. Raises ValueError for runs on one bed, and for probabilities outside 0 to 1.
    Source: [Woodruff-1952] (intervals of quantiles); [Hyndman-1996], definition 5 (a run in the middle of its step).
    """
    if not all(0.0 < probability < 1.0 for probability in probabilities):
        raise ValueError(f"probabilities are {list(probabilities)}; each must lie between 0 and 1")
    values, beds = _known(y, bed)
    ordered, places = np.sort(values), (np.arange(len(values)) + 0.5) / len(values)
    found = []
    for probability in probabilities:
        quantile = float(np.interp(probability, places, ordered))
        if _few_beds_of_tail(probability, beds):
            found.append(Estimate(quantile, None, None))
            continue
        error = standard_error((values <= quantile).astype(float), beds)
        half = t_quantile(int(beds.max())) * error
        lower, upper = np.interp([probability - half, probability + half], places, ordered).tolist()
        found.append(Estimate(quantile, lower, upper))
    return found


def quantile_estimate(
    y: ArrayLike, bed: ArrayLike, probability: float, *, counts: bool = False, why: str | None = None
) -> Estimate:
    """Estimate a quantile of an output y [run_count], NaN where a run has none, with its interval where there is one.

    bed     of each run [run_count]: the units of the interval
    counts  the output is a count: value and bounds are values that occur, none lies between two
    why     a reason why these runs give no interval, as one impact point

    The share of runs below the true quantile scatters about the probability by its error from beds, as a beta law does;
    the bounds are the quantiles at the ends of that law's interval. One beyond the middle of the last step is None: the
    largest of few values bounds no quantile. So are both on one bed, and of a tail on fewer than ten beds.
    Raises ValueError for a probability outside 0 to 1.
    Source: [Woodruff-1952] (intervals of quantiles); [Korn-1998] (effective size in a binomial law).
    """
    if not 0.0 < probability < 1.0:
        raise ValueError(f"probability is {probability}; it must lie between 0 and 1")
    values, beds = answered_runs(y, bed)
    if len(values) == 0:
        return Estimate(math.nan, None, None, why_missing=why or "no run has this output")
    quantile = _at(values, probability, counts)
    if why is None and beds.max() == 0:
        why = ONE_BED
    if why is None and _few_beds_of_tail(probability, beds):
        why = f"{beds.max() + 1} beds give no interval of a quantile so far out: {FEWEST_BEDS_OF_TAIL} are needed"
    if why is not None:
        return Estimate(quantile, None, None, why_missing=why)
    # Many runs may lie on the quantile of a count itself.
    below = (values <= quantile, values < quantile) if counts else (values <= quantile,)
    effect = max(_design_effect(one.astype(float), beds) for one in below)
    bounds = _scatter(probability, len(values) / effect * (normal_quantile() / t_quantile(int(beds.max()))) ** 2)
    step = 0.5 / len(values)
    lower, upper = (_at(values, one, counts) if step <= one <= 1.0 - step else None for one in bounds)
    missing = [name for name, end in (("lower", lower), ("upper", upper)) if end is None]
    beyond = f"the {' and the '.join(missing)} end lies beyond all {len(values)} values" if missing else None
    return Estimate(quantile, lower, upper, why_missing=beyond)


def _at(values: Array, share: float, counts: bool) -> float:
    """The value that this share of values lies below. Source: [Hyndman-1996], definition 5, of counts definition 1."""
    return float(np.quantile(values, share, method="inverted_cdf" if counts else "hazen"))


def _design_effect(below: Array, beds: Labels) -> float:
    """Variance of the mean of below [run_count], each 0 or 1, over that of independent runs; at least 1."""
    independent = float(below.var(ddof=1)) / len(below)
    return standard_error(below, beds) ** 2 / independent if independent > 0.0 else 1.0


def _scatter(probability: float, run_count: float) -> Bounds:
    """Bounds of the share of so many independent runs, in effect, that meet an event of this probability.

    By the beta law with the mean and the variance of the binomial one.
    """
    size = max(run_count - 1.0, 1e-3)
    ends = (0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL)
    lower, upper = (float(special.betaincinv(probability * size, (1.0 - probability) * size, one)) for one in ends)
    return lower, upper


def _few_beds_of_tail(probability: float, beds: Labels) -> bool:
    return not TAIL <= probability <= 1.0 - TAIL and beds.max() + 1 < FEWEST_BEDS_OF_TAIL


def _known(y: ArrayLike, bed: ArrayLike) -> tuple[Array, Labels]:
    values, beds = answered_runs(y, bed)
    if len(np.unique(beds)) < 2:
        raise ValueError(
            f"{len(beds)} runs with the output landed on {len(np.unique(beds))} bed; other beds would change this "
            "number, and these runs cannot show by how much: set bed.bed_count to 12 or more"
        )
    return values, beds


@dataclass(frozen=True)
class DirectionEstimate:
    """Mean direction and resultant length of an angle over the input distributions and over new beds.

    mean_direction    [rad], above -pi and at most pi; its bounds the direction less and plus at most pi [rad], so they
                      may lie outside -pi to pi; a whole turn where the landings have no preferred direction
    resultant_length  0 where directions cancel, 1 where all are alike; its interval within 0 to 1
    """

    mean_direction: Estimate
    resultant_length: Estimate


def direction_estimate(angle: ArrayLike, bed: ArrayLike, *, why: str | None = None) -> DirectionEstimate:
    """Estimate the mean direction of an angle [run_count] in rad, NaN where a run has none, on beds [run_count].

    why: a reason why these runs give no interval, as one impact point; on one bed there is none either. The interval of
    the direction m is m -+ arcsin(t se / R), with R the resultant length and se the standard error of the mean of
    sin(angle - m) from beds; that of R comes from the noncentral chi-square distribution with the error of the mean of
    cos(angle - m), or the larger of both where m may be any direction, so it reaches 0 where none is preferred. Its
    upper end is at least that of the median length without a preferred direction.
    Raises ValueError where no run has the angle.
    Source: [Mardia-2000], sections 2.3 (mean direction, resultant length) and 4.8.1 (their large-sample distribution);
    [Cameron-2008] (errors from few clusters).
    """
    values, beds = answered_runs(angle, bed)
    if len(values) == 0:
        raise ValueError("no run has the angle; give one in radians for each run, some of them known")
    cosine, sine = float(np.cos(values).mean()), float(np.sin(values).mean())
    direction, length = math.atan2(sine, cosine), math.hypot(cosine, sine)
    bed_count = int(beds.max()) + 1
    if why is not None or bed_count == 1:
        return DirectionEstimate(Estimate(direction, None, None), Estimate(length, None, None))
    quantile = t_quantile(bed_count - 1)
    across, along = (quantile * standard_error(wave(values - direction), beds) for wave in (np.sin, np.cos))
    # Where the error of the mean vector is as long as the vector itself it may point anywhere.
    half = math.asin(across / length) if across < length else math.pi
    # Which way a vector points that may be 0 is chance, and so is which error is the one along it.
    error = max(across, along) if half == math.pi else along
    lengths = Estimate(length, *_length_bounds(length, error / normal_quantile()))
    return DirectionEstimate(Estimate(direction, direction - half, direction + half), lengths)


def _length_bounds(length: float, error: float) -> Bounds:
    """Bounds of the length of a mean vector in the plane, each component of which has this standard error.

    The square of the length over that of the error is chi-square with two degrees of freedom, and the square of the
    true ratio is its noncentrality. Source: [Mardia-2000], section 4.8.1.
    """
    if error == 0.0:
        return length, length

    def bound(length: float, probability: float) -> float:
        square = (length / error) ** 2

        def excess(ratio: float) -> float:
            return float(special.chndtr(square, 2.0, ratio**2)) - probability

        # Six errors beyond the length nothing is left of the tail.
        return error * float(optimize.brentq(excess, 0.0, length / error + 6.0)) if excess(0.0) > 0.0 else 0.0

    lower = bound(length, 0.5 + 0.5 * LEVEL)
    # A length that chance alone made so short is no proof of none: the upper end is that of its median without any.
    upper = bound(max(length, error * math.sqrt(2.0 * math.log(2.0))), 0.5 - 0.5 * LEVEL)
    return min(lower, length), min(max(upper, length), 1.0)
