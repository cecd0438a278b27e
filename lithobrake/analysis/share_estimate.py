"""The share of landers that stay, over the law of the inputs and over beds nobody has poured yet."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.bed_components import bed_components
from lithobrake.analysis.confidence import (
    LEVEL,
    Array,
    Labels,
    normal_quantile,
    numbered_beds,
    share_interval,
    share_spread,
    t_quantile,
)
from lithobrake.analysis.control_variate import control_variate
from lithobrake.analysis.next_bed import next_bed_deviation
from lithobrake.analysis.outcome_model import upper_limit
from lithobrake.chaos.threads import one_thread
from lithobrake.given_numbers import numbers, numbers_or_nan, whole_number

Bounds = tuple[float, float]
ONE_BED = (
    "all runs came down on one bed; another bed gives another share, and these runs cannot say how different: set "
    "bed.bed_count to 12 or more"
)


@dataclass(frozen=True)
class ShareEstimate:
    """A share with what its runs say of it; shares are fractions of 1.

    share                  over the law of the inputs, on beds that were not in the study
    lower, upper           its interval; None where the runs cannot give one, and `why` says why not
    level                  probability that each interval stands for
    source                 how many landings on how many beds it comes from
    next_bed               interval of the share on one bed more; None without an interval, where all runs end alike, or
                           with one run a bed
    if_missing             the share if none, and if all, of the runs without an answer stayed
    if_missing_interval    the same two, each moved outward by its own sampling error; None without an interval
    flight_sampling        half the interval that the number of flights of each run alone gives; None where not said
    emulator               the share by the emulator, as the caller gave it
    why                    why there is no interval; None where there is one
    """

    share: float
    lower: float | None
    upper: float | None
    level: float
    source: str
    next_bed: Bounds | None
    if_missing: Bounds
    if_missing_interval: Bounds | None
    flight_sampling: float | None
    emulator: float | None
    why: str | None

    def summary(self) -> dict[str, Any]:
        """The estimate as `summary.json` holds it."""
        return {
            "share": self.share,
            "lower": self.lower,
            "upper": self.upper,
            "level": self.level,
            "from": self.source,
            "next_bed": None if self.next_bed is None else list(self.next_bed),
            "if_missing": list(self.if_missing),
            "flight_sampling": self.flight_sampling,
            "emulator": self.emulator,
            "why": self.why,
        }


@one_thread()
def share_estimate(
    stays: ArrayLike,
    bed: ArrayLike,
    *,
    terms: tuple[Array, Labels] | None = None,
    weights: ArrayLike | None = None,
    beds_differ: bool = True,
    flight_count: int | None = None,
    emulator: float | None = None,
    why: str | None = None,
) -> ShareEstimate:
    """Estimate the mean of `stays` over the law of the inputs, with its interval from beds.

    stays [run_count]    share of its flights for which each run stays, 0 to 1; NaN where the run has no answer
    bed [run_count]      label of the bed of each run: the units of the interval
    terms                what `regression_terms` gives for the inputs of all runs; None: plain mean
    weights [run_count]  density of the law over that the runs were drawn from; None: drawn from the law
    beds_differ          whether beds matter; where no run, or every run, stays this cannot be seen, and an interval
                         takes beds as its units where they do, runs where they do not
    flight_count         flights behind each entry of stays, each of its own draw
    why                  a reason why these runs give no interval, as one place or one attitude

    The mean of what is left when a regression on the inputs is taken off; its error is that of the beds' sums, never
    below that of independent runs, with Student's t of one less than the beds. Raises ValueError where nothing has an
    answer, for shares outside [0, 1] and for weights that are not above 0.
    Source: [Saerndal-1992], section 6.3 (difference estimator); [Cameron-2008] (errors from few clusters).
    """
    h, w = _checked(stays, weights)
    if terms is not None and len(terms[0]) != len(h):
        raise ValueError(f"terms are of {len(terms[0])} runs and stays of {len(h)}; give those of the same runs")
    if flight_count is not None:
        whole_number("flight_count", flight_count, 1)
    beds, answered = numbered_beds(bed, len(h)), np.isfinite(h)
    told = np.zeros(len(h)) if terms is None else control_variate(terms[0], terms[1].sum(axis=1), h, beds)
    share = _mean((h - told)[answered], w[answered])
    if not 0.0 < share < 1.0:
        # Where hardly a run stays a regression may promise less than none.
        told = np.zeros(len(h))
        share = _mean(h[answered], w[answered])
    own = numbered_beds(beds[answered], int(answered.sum()))
    bed_count = int(own.max()) + 1
    why = why or (ONE_BED if bed_count == 1 else None)
    bounds = next_bed = None
    if why is None and share in (0.0, 1.0):
        bounds = _without_event(share, bed_count if beds_differ else len(own))
    elif why is None:
        bounds, next_bed = _intervals(_scaled((h - told)[answered], w[answered]), own)
    ends, ends_interval = _if_missing(h, told, w, beds, share, bounds)
    lower, upper = bounds or (None, None)
    sampling = None if flight_count is None else _flight_sampling(h[answered], w[answered], flight_count)
    source = f"{len(own)} landing{'s' if len(own) > 1 else ''} on {bed_count} bed{'s' if bed_count > 1 else ''}"
    return ShareEstimate(share, lower, upper, LEVEL, source, next_bed, ends, ends_interval, sampling, emulator, why)


def standard_error(values: Array, bed: Labels) -> float:
    """Standard error of the mean of values [run_count] on beds numbered from 0, in their unit.

    From the sums over beds, and never below that of independent runs: few beds may differ less than chance would have
    it. Source: [Cameron-2008], with B / (B - 1).
    """
    deviations, bed_count = values - values.mean(), int(bed.max()) + 1
    sums = np.bincount(bed, weights=deviations)
    from_beds = bed_count / (bed_count - 1) * float(np.sum(sums**2)) / len(values) ** 2
    return math.sqrt(max(from_beds, float(values.var(ddof=1)) / len(values)))


def _checked(stays: ArrayLike, weights: ArrayLike | None) -> tuple[Array, Array]:
    h = numbers_or_nan("stays", stays)
    w = np.ones_like(h) if weights is None else numbers("weights", weights)
    if h.ndim != 1 or not np.isfinite(h).any():
        raise ValueError(f"stays has shape {h.shape} and no answer; give one share for each run, some of them known")
    if np.nanmin(h) < 0.0 or np.nanmax(h) > 1.0:
        raise ValueError(f"stays reaches from {np.nanmin(h):g} to {np.nanmax(h):g}; each must lie between 0 and 1")
    if w.shape != h.shape or not np.all((w > 0.0) & np.isfinite(w)):
        raise ValueError(f"weights have shape {w.shape}; give one finite number above 0 for each of {len(h)} runs")
    return h, w


def _mean(values: Array, weights: Array) -> float:
    return float(np.sum(weights * values) / np.sum(weights))


def _scaled(values: Array, weights: Array) -> Array:
    """Values whose plain mean, with its error, is the weighted mean. Source: [Saerndal-1992], section 5.5."""
    mean = _mean(values, weights)
    scaled: Array = mean + weights / weights.mean() * (values - mean)
    return scaled


def _without_event(share: float, unit_count: int) -> Bounds:
    limit = upper_limit(unit_count, LEVEL)
    return (0.0, limit) if share == 0.0 else (1.0 - limit, 1.0)


def _intervals(values: Array, bed: Labels) -> tuple[Bounds, Bounds | None]:
    """Interval of the mean of values [run_count], and of that on the next bed where a bed has more than one run."""
    share, error, bed_count = float(values.mean()), standard_error(values, bed), int(bed.max()) + 1
    half = t_quantile(bed_count - 1) * error
    bounds = share_interval(share, half)
    if len(values) == bed_count:
        return bounds, None
    # One bed more is never better known than the mean over all, however alike a few beds are.
    lower, upper = share_spread(share, next_bed_deviation(bed_components(values, bed), error))
    return bounds, (min(lower, bounds[0]), max(upper, bounds[1]))


def _if_missing(
    h: Array, told: Array, weights: Array, beds: Labels, share: float, bounds: Bounds | None
) -> tuple[Bounds, Bounds | None]:
    """Share if none and if all without an answer stay, and the interval about both; both hold the share itself.

    Source: [Manski-2003] (bounds of a mean with missing data).
    """
    if np.isfinite(h).all():
        return (share, share), bounds
    ends, outer = [], []
    for filling in (0.0, 1.0):
        values = _scaled(np.where(np.isfinite(h), h, filling) - told, weights)
        ends.append(min(max(float(values.mean()), 0.0), 1.0))
        half = t_quantile(int(beds.max())) * standard_error(values, beds) if bounds else 0.0
        outer.append(share_interval(ends[-1], half))
    # What a regression takes off differs between runs with and without an answer, so the share may lie just outside.
    around = (min(share, ends[0]), max(share, ends[1]))
    return around, (min(bounds[0], outer[0][0]), max(bounds[1], outer[1][1])) if bounds else None


def _flight_sampling(h: Array, weights: Array, flight_count: int) -> float:
    """Half the interval by the luck of flights alone; each entry of h is a share of so many draws.

    Source: [Cochran-1977], section 3.2 (unbiased variance of a sample's proportion).
    """
    variances = h * (1.0 - h) / max(flight_count - 1, 1)
    return normal_quantile() * float(np.sqrt(np.sum(weights**2 * variances)) / np.sum(weights))
