"""A fraction of the landings, over the input distributions and over beds that were not in the study."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.analysis import confidence
from lithobrake.analysis.control_variate import control_variate
from lithobrake.analysis.unseen_event import HALF_RUN, limit_of_counts, part_that_counts
from lithobrake.chaos.training_data import one_thread
from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.given_numbers import numbers, numbers_or_nan
from lithobrake.vocabulary.landing_fraction import LandingFraction

ONE_BED = (
    "all runs landed on one bed; another bed would change this number, and these runs cannot show by how much: set "
    "bed.bed_count to 12 or more"
)
# Fewer landings that resemble those without an outcome say less of them than all landings do.
FEWEST_LIKE = 5
# The variance of beds is taken at its upper limit of this confidence: few beds say little of it, and its plain estimate
# is 0 in half of the studies where beds differ little.
BED_VARIANCE_CONFIDENCE = 0.7


class _Mean(NamedTuple):
    """A mean over landings: values less what the inputs explain, of which it is the plain mean, and beds from 0.

    part: of the landings that counts, as `part_that_counts` gives it; is_event: whether each meets an event or not, and
    has no share of its flights.
    """

    value: float
    values: Array
    beds: Labels
    part: float
    is_event: bool

    @property
    def bed_count(self) -> int:
        """Number of beds, the independent units of the interval."""
        return int(self.beds.max()) + 1

    @property
    def error(self) -> float:
        """Standard error over beds."""
        return standard_error(self.values, self.beds)


@one_thread()
def share_estimate(
    shares: ArrayLike,
    bed: ArrayLike,
    *,
    terms: tuple[Array, Labels] | None = None,
    explained: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    like_missing: ArrayLike | None = None,
    why: str | None = None,
) -> LandingFraction:
    """Estimate the mean of `shares` over the input distributions, with its interval from beds.

    shares [run_count]        0 to 1 for each landing, as the share of its flights that return; NaN without an outcome
    bed [run_count]           label of the bed of each landing: the units of the interval
    terms                     what `regression_terms` gives for the inputs of all landings; None: plain mean
    explained [run_count]     of mean 0 over the input distributions, taken off in place of what a regression on terms
                              explains, where every landing has an outcome; None: nothing
    weights [run_count]       density of the input distribution over that the landings were drawn from; None: 1
    like_missing [run_count]  whether each landing resembles those without an outcome, as one that left across the edge
                              of the bed: where at least five of these have an outcome, the point estimate takes their
                              mean for those without, else that of all. It moves no bound but to hold the estimate
    why                       a reason why these landings give no interval, as one impact point or one attitude

    The mean of what is left when a regression on the inputs is taken off; its error is that of the sums over beds,
    never below that of independent landings, with Student's t of one less than the beds. The interval reaches from the
    mean with 0 for every landing without an outcome to that with 1, and beyond either by a sampling error that holds
    each fraction between at the level; it is never narrower than the interval of the landings with an outcome.
    Raises ValueError where nothing has an outcome, for shares outside [0, 1] and for weights that are not above 0.
    Source: [Saerndal-1992], section 6.3 (difference estimator); [Cameron-2008] (errors from few clusters);
    [Manski-2003] (bounds of a mean with missing data); [Imbens-2004] (their sampling error).
    """
    h, w, like = _checked(shares, weights, like_missing)
    if terms is not None and len(terms[0]) != len(h):
        raise ValueError(f"terms are of {len(terms[0])} runs and shares of {len(h)}; give those of the same runs")
    beds, answered = confidence.numbered_beds(bed, len(h)), np.isfinite(h)
    left = _less_inputs(h, terms, w, beds) if explained is None else h - numbers("explained", explained)
    is_event = bool(np.isin(h[answered], (0.0, 1.0)).all())
    known = _mean_of(left[answered], w[answered], beds[answered], is_event)
    ends = known, known
    if not answered.all():
        filled = (np.where(answered, h, end) for end in (0.0, 1.0))
        least, most = (_mean_of(_less_inputs(values, terms, w, beds), w, beds, is_event) for values in filled)
        ends = least, most
    why = why or (ONE_BED if known.bed_count == 1 else None)
    share = _point(left, w, answered, like)
    # A regression of its own for each end may leave the estimate just outside.
    if_missing = min(max(ends[0].value, 0.0), share), max(min(ends[1].value, 1.0), share)
    bounds = None if why is not None else _outer(if_missing, _interval(known, known), _interval(*ends))
    next_bed = None if bounds is None else _next_bed(known, ends, bounds)
    lower, upper = bounds or (None, None)
    source, missing = _source(answered, known.bed_count), float(np.mean(~answered))
    return LandingFraction(Estimate(share, lower, upper, why_missing=why), source, next_bed, if_missing, missing)


def plain_interval(shares: ArrayLike, bed: ArrayLike) -> confidence.Bounds | None:
    """The interval of `share_estimate` of shares alone, quickly; None on one bed, or without an outcome."""
    h = numbers_or_nan("shares", shares)
    beds, answered, w = confidence.numbered_beds(bed, len(h)), np.isfinite(h), np.ones_like(h)
    if len(np.unique(beds[answered])) < 2:
        return None
    is_event = bool(np.isin(h[answered], (0.0, 1.0)).all())
    known = _mean_of(h[answered], w[answered], beds[answered], is_event)
    if answered.all():
        return _interval(known, known)
    ends = (_mean_of(np.where(answered, h, end), w, beds, is_event) for end in (0.0, 1.0))
    return _outer(_interval(known, known), _interval(*ends))


def standard_error(values: Array, bed: Labels) -> float:
    """Standard error of the mean of values [run_count] on beds numbered from 0, in their unit.

    From the sums over beds, and never below that of independent runs: few beds may differ less than chance would have
    it. Source: [Cameron-2008], with B / (B - 1).
    """
    deviations, bed_count = values - values.mean(), int(bed.max()) + 1
    sums = np.bincount(bed, weights=deviations)
    from_beds = bed_count / (bed_count - 1) * float(np.sum(sums**2)) / len(values) ** 2
    return math.sqrt(max(from_beds, float(values.var(ddof=1)) / len(values)))


def _checked(
    shares: ArrayLike, weights: ArrayLike | None, like_missing: ArrayLike | None
) -> tuple[Array, Array, NDArray[np.bool_]]:
    h = numbers_or_nan("shares", shares)
    w = np.ones_like(h) if weights is None else numbers("weights", weights)
    like = np.zeros(h.shape) if like_missing is None else numbers("like_missing", like_missing)
    if h.ndim != 1 or not np.isfinite(h).any():
        raise ValueError(f"shares has shape {h.shape} and no outcome; give one for each run, some of them known")
    if np.nanmin(h) < 0.0 or np.nanmax(h) > 1.0:
        raise ValueError(f"shares reaches from {np.nanmin(h):g} to {np.nanmax(h):g}; each must lie between 0 and 1")
    if w.shape != h.shape or not np.all((w > 0.0) & np.isfinite(w)):
        raise ValueError(f"weights have shape {w.shape}; give one finite number above 0 for each of {len(h)} runs")
    if like.shape != h.shape or not np.isin(like, (0.0, 1.0)).all():
        raise ValueError(f"like_missing has shape {like.shape}; give true or false for each of {len(h)} runs")
    return h, w, like == 1.0


def _less_inputs(h: Array, terms: tuple[Array, Labels] | None, weights: Array, beds: Labels) -> Array:
    """Shares less what a regression on the inputs explains of them [run_count]; NaN where a run has none."""
    if terms is None:
        return h
    left: Array = h - control_variate(terms[0], terms[1].sum(axis=1), h, beds)
    known = np.isfinite(h)
    # Where hardly a run returns a regression may promise less than none.
    return left if 0.0 < _mean(left[known], weights[known]) < 1.0 else h


def _mean(values: Array, weights: Array) -> float:
    return float(np.sum(weights * values) / np.sum(weights))


def _mean_of(values: Array, weights: Array, beds: Labels, is_event: bool) -> _Mean:
    """The weighted mean as a plain one, with its error. Source: [Saerndal-1992], section 5.5."""
    mean = _mean(values, weights)
    numbered, part = confidence.numbered_beds(beds, len(values)), part_that_counts(weights)
    return _Mean(mean, mean + weights / weights.mean() * (values - mean), numbered, part, is_event)


def _point(left: Array, weights: Array, answered: NDArray[np.bool_], like: NDArray[np.bool_]) -> float:
    """The mean of what is left of the inputs, with that of similar runs for those without an outcome."""
    similar = answered & like if (answered & like).sum() >= FEWEST_LIKE else answered
    share = _mean(np.where(answered, left, _mean(left[similar], weights[similar])), weights)
    return min(max(share, 0.0), 1.0)


def _interval(least: _Mean, most: _Mean) -> confidence.Bounds:
    """Interval that holds each number between two means at the level; that of Student where both are one."""
    lower, upper = (min(max(one.value, 0.0), 1.0) for one in (least, most))
    errors = least.error, most.error
    freedom, width, error = least.bed_count - 1, max(upper - lower, 0.0), max(errors)
    quantile = confidence.partial_quantile(width, error, freedom) if error > 0.0 else confidence.t_quantile(freedom)
    low, high = _bounds(lower, least, quantile * errors[0]), _bounds(upper, most, quantile * errors[1])
    return low[0], high[1]


def _bounds(share: float, of: _Mean, half_width: float) -> confidence.Bounds:
    """Bounds of one mean; where hardly a landing differs from the others they follow from how many there are."""
    lower, upper = confidence.share_interval(share, half_width)
    runs = of.part * len(of.values)
    # Few that have met an event leave no less open than none; and shares of flights that add up to less than half a
    # landing do not show how many landings would differ wholly.
    is_open = of.is_event or min(share, 1.0 - share) * runs < HALF_RUN
    far = limit_of_counts(np.bincount(of.beds), of.part) if is_open else 0.0
    near = _of_one_run(runs) if _differs_alone(of.values) else 1.0
    if share < 0.5:
        return min(lower, near), max(upper, far)
    return min(lower, 1.0 - far), max(upper, 1.0 - near)


def _differs_alone(values: Array) -> bool:
    """Whether all values but one are alike."""
    ordered = np.sort(values)
    return bool(ordered[0] < ordered[-1] and (ordered[0] == ordered[-2] or ordered[1] == ordered[-1]))


def _of_one_run(run_count: float) -> float:
    """Least probability of an event that one of so many runs has met: its error from beds says nothing of it.

    Source: [Clopper-1934], at a count of 1.
    """
    return -math.expm1(math.log(0.5 + 0.5 * confidence.LEVEL) / run_count)


def _next_bed(known: _Mean, ends: tuple[_Mean, _Mean], bounds: confidence.Bounds) -> confidence.Bounds | None:
    """Prediction interval of the mean on a new bed; it holds the interval of the mean over all beds."""
    if known.value in (0.0, 1.0) or len(known.values) == known.bed_count:
        return None
    # One bed more is never better known than the mean over all, however alike a few beds are.
    return _outer(bounds, _spread(known), (_spread(ends[0])[0], _spread(ends[1])[1]))


def _spread(one: _Mean) -> confidence.Bounds:
    share = min(max(one.value, 0.0), 1.0)
    return confidence.share_spread(
        share, _next_bed_deviation(confidence.bed_components(one.values, one.beds), one.error)
    )


def _outer(*bounds: confidence.Bounds) -> confidence.Bounds:
    return min(one[0] for one in bounds), max(one[1] for one in bounds)


def _source(answered: NDArray[np.bool_], bed_count: int) -> str:
    """How many landings with an outcome, of how many, on how many beds."""
    known, total = int(answered.sum()), len(answered)
    on_beds = f"landing{'s' if total > 1 else ''} on {bed_count} bed{'s' if bed_count > 1 else ''}"
    return f"{total} {on_beds}" if known == total else f"{known} of {total} {on_beds}"


def _next_bed_deviation(components: confidence.BedComponents, standard_error: float) -> float:
    """Standard deviation of the next bed's mean about an estimate [unit of the runs].

    Error of the estimate and difference of the bed together, the variance of beds at an upper limit: measured to
    hold more evenly than draws of both mean squares (generalised pivots, [Krishnamoorthy-2009]) and than the plain
    estimate cut at 0; see docs/estimates.md. Source: [Wald-1947] (upper limit).
    """
    return math.sqrt(components.variance_at(BED_VARIANCE_CONFIDENCE) + standard_error**2)
