"""The mean over many landings on one bed more: how far it may lie from the mean over all beds."""

import math

from lithobrake.analysis.bed_components import BedComponents

# The variance of beds is taken at its upper limit of this confidence: few beds say little of it, and its plain estimate
# is 0 in half of the studies where beds differ little.
BED_VARIANCE_CONFIDENCE = 0.7


def next_bed_deviation(components: BedComponents, standard_error: float) -> float:
    """Standard deviation of the next bed's mean about an estimate [unit of the runs].

    Error of the estimate and difference of the bed together, the variance of beds at an upper limit: measured to
    hold more evenly than draws of both mean squares (generalised pivots, [Krishnamoorthy-2009]) and than the plain
    estimate cut at 0; see docs/estimates.md. Source: [Wald-1947] (upper limit).
    """
    bed_variance = components.variance_at(BED_VARIANCE_CONFIDENCE)
    return math.sqrt(bed_variance + standard_error**2)
