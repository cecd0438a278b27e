"""What one ground among those that a study allows would give: intervals of a share and of a median over grounds.

Each bed of the runs is a ground of its own. An interval holds the share, or the median, of a ground that is drawn like
these with the probability of the level; that of few runs on each ground is taken out.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis import confidence
from lithobrake.analysis.output_estimates import quantile_ends, quantile_estimate
from lithobrake.analysis.share_estimate import BED_VARIANCE_CONFIDENCE, share_estimate, standard_error
from lithobrake.vocabulary.estimate import Estimate

FEW = "each ground has one run with the output: how far grounds differ is not known"


def share_over_grounds(met: ArrayLike, bed: ArrayLike, *, why: str | None = None) -> Estimate:
    """The mean share of runs that meet an event [run_count: 1, 0, or NaN where nobody knows], on one ground.

    Its interval is that of the share on one ground, whatever the runs do of which nobody knows.
    bed: the ground of each run [run_count]. why: a reason why these runs give no interval. Where no run or every run
    meets the event the interval is that of the mean over grounds: none of them was seen to differ.
    """
    found = share_estimate(met, bed, why=why)
    if found.share.lower is None or found.share.value in (0.0, 1.0):
        return found.share
    if found.next_bed is None:
        return Estimate(found.share.value, None, None, why_missing=FEW)
    return Estimate(found.share.value, *found.next_bed)


def median_over_grounds(
    y: ArrayLike, bed: ArrayLike, *, why: str | None = None, missing: ArrayLike | None = None
) -> Estimate:
    """The median of an output y [run_count] above 0, NaN where a run has none, with the interval of that on one ground.

    bed: the ground of each run [run_count]. why: as above. missing [run_count]: whether it is not known what became of
    a run, so that its value may lie below or above all others. The logarithm is taken as the sum of what the ground and
    what all else adds, each with one variance; that of grounds stands at an upper limit, as in share_estimate.
    Source: [Searle-1992], section 3.6 (components of variance).
    """
    middle = quantile_estimate(y, bed, 0.5, why=why, missing=missing)
    if middle.lower is None and middle.upper is None:
        return middle
    values, beds = confidence.answered_runs(y, bed)
    if len(values) - len(np.unique(beds)) < 1 or values.min() <= 0.0:
        return Estimate(middle.value, None, None, why_missing=FEW)
    logarithm = np.log(values)
    components = confidence.bed_components(logarithm, beds)
    variance = components.variance_at(BED_VARIANCE_CONFIDENCE) + standard_error(logarithm, beds) ** 2
    factor = math.exp(confidence.normal_quantile() * math.sqrt(variance))
    least, most = quantile_ends(y, 0.5, missing)
    # The median of one ground is known no better than that over all.
    lower = None if least is None else min(least / factor, middle.lower or least / factor)
    upper = None if most is None else max(most * factor, middle.upper or most * factor)
    return Estimate(middle.value, lower, upper, why_missing=middle.why_missing if None in (lower, upper) else None)
