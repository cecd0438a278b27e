"""The mean of an output over the grounds that a study allows, with the interval of that on one of them."""

import math

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis import confidence
from lithobrake.analysis.ground_spread import FEW
from lithobrake.analysis.missing_runs import Limits, lost_runs
from lithobrake.analysis.output_estimates import filled_ends, mean_estimate
from lithobrake.analysis.share_estimate import BED_VARIANCE_CONFIDENCE, ONE_BED, standard_error
from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.estimate import Estimate


def mean_over_beds(
    y: ArrayLike,
    bed: ArrayLike,
    *,
    why: str | None = None,
    level: float = confidence.LEVEL,
    missing: ArrayLike | None = None,
    limits: Limits | None = None,
) -> Estimate:
    """`mean_estimate`, without an interval where there is a reason `why`, and on one bed; NaN where no run has y."""
    values, beds = confidence.answered_runs(y, bed)
    if not len(values):
        return Estimate(math.nan, None, None, why_missing=why)
    if why is not None or len(np.unique(beds)) < 2:
        return Estimate(float(values.mean()), None, None, why_missing=why or ONE_BED)
    return mean_estimate(y, bed, level=level, missing=missing, limits=limits)


def mean_over_grounds(
    y: ArrayLike,
    bed: ArrayLike,
    *,
    why: str | None = None,
    level: float = confidence.LEVEL,
    missing: ArrayLike | None = None,
    limits: Limits | None = None,
) -> Estimate:
    """The mean of an output y [run_count], NaN where a run has none, with the interval of its mean on one ground.

    bed: the ground of each run [run_count]. why: a reason why these runs give no interval. missing, limits: as for
    `mean_estimate`. The output is taken as the sum of what the ground and what all else adds, each with one variance;
    that of grounds stands at an upper limit, as in share_estimate. Source: [Searle-1992], section 3.6 (components of
    variance).
    """
    mean = mean_over_beds(y, bed, why=why, level=level, missing=missing, limits=limits)
    if mean.lower is None or mean.upper is None:
        return mean
    values, beds = confidence.answered_runs(y, bed)
    if len(values) - len(np.unique(beds)) < 1:
        return Estimate(mean.value, None, None, why_missing=FEW)
    lost = lost_runs(missing, y)
    kept = confidence.numbered_beds(
        np.asarray(bed)[lost | np.isfinite(np.asarray(y, dtype=float))], len(values) + lost.sum()
    )
    ends = [(one, _half_width(one, kept, level)) for one in filled_ends(y, lost, limits)]
    # The mean of one ground is known no better than that over all.
    lower, upper = (float(one.mean()) + sign * half for (one, half), sign in zip(ends, (-1.0, 1.0), strict=True))
    return Estimate(mean.value, min(lower, mean.lower), max(upper, mean.upper), level)


def _half_width(values: Array, beds: Labels, level: float) -> float:
    """Of the mean on one ground."""
    variance = confidence.bed_components(values, beds).variance_at(BED_VARIANCE_CONFIDENCE)
    return confidence.normal_quantile(level) * math.sqrt(variance + standard_error(values, beds) ** 2)
