"""What one ground among those that a study allows would give: intervals of a share and of a median over grounds.

Each bed of the runs is a ground of its own. An interval holds the share, or the median, of a ground that is drawn like
these with the probability of the level; that of few runs on each ground is taken out.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis import confidence
from lithobrake.analysis.output_estimates import quantile_estimate
from lithobrake.analysis.share_estimate import BED_VARIANCE_CONFIDENCE, share_estimate, standard_error
from lithobrake.vocabulary.estimate import Estimate

FEW = "each ground has one run with the output: how far grounds differ is not known"


def share_over_grounds(met: ArrayLike, bed: ArrayLike, *, why: str | None = None) -> Estimate:
    """The mean share of runs that meet an event [run_count, 0 or 1], with the interval of the share on one ground.

    bed: the ground of each run [run_count]. why: a reason why these runs give no interval. Where no run or every run
    meets the event the interval is that of the mean over grounds: none of them was seen to differ.
    """
    found = share_estimate(met, bed, why=why)
    if found.share.lower is None or found.share.value in (0.0, 1.0):
        return found.share
    if found.next_bed is None:
        return Estimate(found.share.value, None, None, why_missing=FEW)
    return Estimate(found.share.value, *found.next_bed)


def median_over_grounds(y: ArrayLike, bed: ArrayLike, *, why: str | None = None) -> Estimate:
    """The median of an output y [run_count] above 0, NaN where a run has none, with the interval of that on one ground.

    bed: the ground of each run [run_count]. why: as above. The logarithm is taken as the sum of what the ground and
    what all else adds, each with one variance; that of grounds stands at an upper limit, as in share_estimate.
    Source: [Searle-1992], section 3.6 (components of variance).
    """
    middle = quantile_estimate(y, bed, 0.5, why=why)
    if middle.lower is None and middle.upper is None:
        return middle
    values, beds = confidence.answered_runs(y, bed)
    if len(values) - len(np.unique(beds)) < 1 or values.min() <= 0.0:
        return Estimate(middle.value, None, None, why_missing=FEW)
    logarithm = np.log(values)
    components = confidence.bed_components(logarithm, beds)
    variance = components.variance_at(BED_VARIANCE_CONFIDENCE) + standard_error(logarithm, beds) ** 2
    factor = math.exp(confidence.normal_quantile() * math.sqrt(variance))
    # The median of one ground is known no better than that over all.
    lower, upper = middle.value / factor, middle.value * factor
    return Estimate(middle.value, min(lower, middle.lower or lower), max(upper, middle.upper or upper))
