"""Quantiles and mean of an output, and mean direction of an angle, on beds that were not in the study."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import optimize, special

from lithobrake.analysis.confidence import (
    LEVEL,
    Bounds,
    answered_runs,
    answers,
    normal_quantile,
    numbered_beds,
    partial_quantile,
    t_quantile,
)
from lithobrake.analysis.missing_runs import Limits, filled, lost_runs, none_bounds, open_end
from lithobrake.analysis.share_estimate import ONE_BED, standard_error
from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.constants import FEWEST_BEDS_OF_TAIL
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.given_numbers import numbers_or_nan
from lithobrake.vocabulary.number_words import QUANTILES

# Quantiles of less than this probability, or more than 1 less it, take so many beds for an interval: on fewer beds a
# handful of runs beyond the quantile lie on one or two of them (measured: docs/estimates.md).
TAIL = 0.1


def mean_estimate(
    y: ArrayLike,
    bed: ArrayLike,
    *,
    level: float = LEVEL,
    missing: ArrayLike | None = None,
    limits: Limits | None = None,
) -> Estimate:
    """Mean of an output y [run_count], NaN where a run has none, with its interval of a level from beds [run_count].

    missing [run_count]: whether it is not known what became of a run, so that it may have the output or not; limits:
    least and most that a run may have, each a number or [run_count], infinite where nothing limits it. The interval
    reaches from the mean with the least for every missing run to that with the most, and beyond by a sampling error;
    an end that nothing limits is None.
    For an output with a heavy tail, as the contact time, read the quantiles: a few rare runs carry much of its mean,
    and where a study has none of them the interval promises too much (0.73 to 0.93 at a tail index of 1.9). Raises
    ValueError for runs on one bed. Source: [Cameron-2008] (errors from few clusters); [Manski-2003] (missing runs).
    """
    values, beds = _known(y, bed)
    mean, half = float(values.mean()), t_quantile(int(beds.max()), level) * standard_error(values, beds)
    lost = lost_runs(missing, y)
    if not lost.any():
        return Estimate(mean, mean - half, mean + half, level)
    kept = lost | np.isfinite(answers("y", y))
    beds = numbered_beds(np.asarray(bed)[kept], int(kept.sum()))
    ends = filled_ends(y, lost, limits)
    means, known = mean_ends(y, missing, limits), [bool(np.isfinite(one).all()) for one in ends]
    errors = [standard_error(one, beds) if told else 0.0 for one, told in zip(ends, known, strict=True)]
    # Of one end alone a number can be missed on one side only; with both that follows from how far they are apart.
    width = max(means[1] - means[0], 0.0) if all(known) else math.inf
    reach = partial_quantile(width, max(errors), int(beds.max()), level) if max(errors) > 0.0 else 0.0
    lower = min(means[0] - reach * errors[0], mean - half) if known[0] else None
    upper = max(means[1] + reach * errors[1], mean + half) if known[1] else None
    return Estimate(mean, lower, upper, level, why_missing=None if all(known) else none_bounds(lost, "the mean"))


def mean_ends(y: ArrayLike, missing: ArrayLike | None, limits: Limits | None) -> Bounds:
    """The mean of an output y [run_count] with every missing run at either of its limits, without sampling error.

    missing, limits: as for `mean_estimate`. Infinite where nothing limits a missing run. Source: [Manski-2003].
    """
    least, most = filled_ends(y, lost_runs(missing, y), limits)
    return float(least.mean()), float(most.mean())


def filled_ends(y: ArrayLike, lost: NDArray[np.bool_], limits: Limits | None) -> tuple[Array, Array]:
    """Values of the runs that have the output, or may have it, with the missing ones at either limit, [kept_count]."""
    output = answers("y", y)
    kept = lost | np.isfinite(output)
    least, most = filled(output, lost, (-math.inf, math.inf) if limits is None else limits)
    return least[kept], most[kept]


def quantile_estimates(
    y: ArrayLike,
    bed: ArrayLike,
    probabilities: Sequence[float] = QUANTILES,
    *,
    missing: ArrayLike | None = None,
    limits: Limits | None = None,
) -> list[Estimate]:
    """Quantiles of an output y [run_count], NaN where a run has none, with their intervals from beds [run_count].

    The share of runs below a quantile has an interval from beds; the bounds are the quantiles at its ends, so they
    follow the skewness of the output and stay among its values. Below 0.1 and above 0.9 fewer than ten beds give no
    interval. missing [run_count], limits: as for `quantile_estimate`. Raises ValueError for runs on one bed, and for
    probabilities outside 0 to 1.
    Source: [Woodruff-1952] (intervals of quantiles); [Hyndman-1996], definition 5 (a run in the middle of its step).
    """
    if not all(0.0 < probability < 1.0 for probability in probabilities):
        raise ValueError(f"probabilities are {list(probabilities)}; each must lie between 0 and 1")
    values, beds = _known(y, bed)
    if lost_runs(missing, y).any():
        return [quantile_estimate(y, bed, one, missing=missing, limits=limits) for one in probabilities]
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
    y: ArrayLike,
    bed: ArrayLike,
    probability: float,
    *,
    counts: bool = False,
    why: str | None = None,
    missing: ArrayLike | None = None,
    limits: Limits | None = None,
) -> Estimate:
    """Estimate a quantile of an output y [run_count], NaN where a run has none, with its interval where there is one.

    bed      of each run [run_count]: the units of the interval
    counts   the output is a count: value and bounds are values that occur, none lies between two
    why      a reason why these runs give no interval, as one impact point
    missing  whether it is not known what became of a run [run_count], so that it may have the output or not: its value
             may lie below or above all others, so the bounds are those of the quantile with either, each with a
             sampling error that holds each quantile between at the level
    limits   least and most that a run may have, as for `mean_estimate`: where missing runs leave an end beyond all
             values, it is the least or the most of all runs

    The share of runs below the true quantile scatters about the probability by its error from beds, as a beta law does;
    the bounds are the quantiles at the ends of that law's interval. One beyond the middle of the last step is None: the
    largest of few values bounds no quantile. So are both on one bed, and of a tail on fewer than ten beds.
    Raises ValueError for a probability outside 0 to 1.
    Source: [Woodruff-1952] (intervals of quantiles); [Korn-1998] (effective size in a binomial law); [Manski-2003],
    section 1.2 (bounds of a quantile with missing data); [Imbens-2004] (their sampling error).
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
    lost = lost_runs(missing, y)
    lower, upper = _quantile_bounds(y, bed, lost, (quantile, probability, counts))
    if lost.any() and limits is not None:
        least, most = (numbers_or_nan("limits", end) for end in limits)
        lower = _finite(float(least.min())) if lower is None else lower
        upper = _finite(float(most.max())) if upper is None else upper
    ends = [name for name, end in (("lower", lower), ("upper", upper)) if end is None]
    beyond = f"the {' and the '.join(ends)} end lies beyond all {len(values)} values" if ends else None
    return Estimate(quantile, lower, upper, why_missing=open_end(lost, beyond))


def _finite(end: float) -> float | None:
    return end if math.isfinite(end) else None


def quantile_ends(
    y: ArrayLike, probability: float, missing: ArrayLike | None, *, counts: bool = False
) -> tuple[float | None, float | None]:
    """A quantile of an output y [run_count] with every missing run below all values, and above, without sampling error.

    Of the runs that have it; missing [run_count], counts: as for `quantile_estimate`. None where it lies beyond all
    values. Source: [Manski-2003], section 1.2.
    """
    lost, values = lost_runs(missing, y), answers("y", y)
    values = values[np.isfinite(values)]
    part, step = float(lost.sum()) / (len(values) + int(lost.sum())), 0.5 / len(values)
    places = (probability - part) / (1.0 - part), probability / (1.0 - part)
    least, most = (_at(values, one, counts) if step <= one <= 1.0 - step else None for one in places)
    return (_at(values, probability, counts),) * 2 if part == 0.0 else (least, most)


def _quantile_bounds(
    y: ArrayLike, bed: ArrayLike, lost: NDArray[np.bool_], of: tuple[float, float, bool]
) -> tuple[float | None, float | None]:
    """Bounds of a quantile whatever the lost runs have; of: the quantile, its probability, whether it is of counts.

    A lost run counts below every value for the lower bound, and above every value for the upper one.
    """
    (quantile, probability, counts), output = of, answers("y", y)
    kept = lost | np.isfinite(output)
    output, lost, beds = output[kept], lost[kept], numbered_beds(np.asarray(bed)[kept], int(kept.sum()))
    values, part, freedom = output[~lost], float(lost.mean()), int(beds.max())
    found, step = [], 0.5 / len(values)
    for is_below in (True, False):
        # Many runs may lie on the quantile of a count itself.
        at_most = np.where(lost, is_below, output <= quantile).astype(float)
        below = np.where(lost, is_below, output < quantile).astype(float)
        effect = max(_design_effect(one, beds) for one in ((at_most, below) if counts else (at_most,)))
        error = math.sqrt(effect * probability * (1.0 - probability) / len(output))
        reach = partial_quantile(part, error, freedom)
        size = len(output) / effect * (_normal_reach(reach, freedom) / reach) ** 2
        share = _scatter(probability, size, float(special.stdtr(freedom, -reach)))[0 if is_below else 1]
        # Of the runs that are known so many lie below the bound.
        own = (share - (part if is_below else 0.0)) / (1.0 - part)
        found.append(_at(values, own, counts) if step <= own <= 1.0 - step else None)
    return found[0], found[1]


def _normal_reach(reach: float, freedom: int) -> float:
    """Standard deviations of a normal law beyond which as much lies as beyond a reach of Student's t."""
    return -float(special.ndtri(special.stdtr(freedom, -reach)))


def _at(values: Array, share: float, counts: bool) -> float:
    """The value that this share of values lies below. Source: [Hyndman-1996], definition 5, of counts definition 1."""
    return float(np.quantile(values, share, method="inverted_cdf" if counts else "hazen"))


def _design_effect(below: Array, beds: Labels) -> float:
    """Variance of the mean of below [run_count], each 0 or 1, over that of independent runs; at least 1."""
    independent = float(below.var(ddof=1)) / len(below)
    return standard_error(below, beds) ** 2 / independent if independent > 0.0 else 1.0


def _scatter(probability: float, run_count: float, tail: float) -> Bounds:
    """Bounds of the share of so many independent runs, in effect, that meet an event of this probability.

    By the beta law with the mean and the variance of the binomial one; tail: probability beyond each.
    """
    size = max(run_count - 1.0, 1e-3)
    ends = (tail, 1.0 - tail)
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


def direction_estimate(
    angle: ArrayLike, bed: ArrayLike, *, why: str | None = None, missing: ArrayLike | None = None
) -> DirectionEstimate:
    """Estimate the mean direction of an angle [run_count] in rad, NaN where a run has none, on beds [run_count].

    why: a reason why these runs give no interval, as one impact point; on one bed there is none either. The interval of
    the direction m is m -+ arcsin(t se / R), with R the resultant length and se the standard error of the mean of
    sin(angle - m) from beds; that of R comes from the noncentral chi-square distribution with the error of the mean of
    cos(angle - m), or the larger of both where m may be any direction, so it reaches 0 where none is preferred. Its
    upper end is at least that of the median length without a preferred direction. missing [run_count]: whether it is
    not known what became of a run; each may have any angle, and moves the mean vector by so much.
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
    # A part u of missing runs adds a vector of a length up to u / (1 - u) to that of the others.
    lost = int(lost_runs(missing, angle).sum()) / len(values)
    # Where the error of the mean vector is as long as the vector itself it may point anywhere.
    half = math.asin((across + lost) / length) if across + lost < length else math.pi
    # Which way a vector points that may be 0 is chance, and so is which error is the one along it.
    error = max(across, along) if half == math.pi else along
    least, most = _length_bounds(length, error / normal_quantile())
    # The mean over all is that vector and the other, over 1 + lost.
    lengths = Estimate(length, max(least - lost, 0.0) / (1.0 + lost), min((most + lost) / (1.0 + lost), 1.0))
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
