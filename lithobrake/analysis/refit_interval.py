"""Interval of a share that only the emulator knows: from draws of fits to beds drawn with replacement."""

import math

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import LEVEL, IntervalEstimate, share_interval, t_quantile
from lithobrake.analysis.outcome_model import upper_limit
from lithobrake.vocabulary.given_numbers import numbers, whole_number


def refit_interval(counts: ArrayLike, totals: ArrayLike, bed_count: int) -> IntervalEstimate:
    """Share of draws that have met an event, with its interval over beds that were not in the study.

    counts, totals [refit_count]: draws of each refit that have met it, and all of its draws, at least two. bed_count:
    beds that the emulator was fitted to. The scatter of the refits' shares, less what finite draws add, is the error of
    the fit. An event that no draw or every draw has met is bounded by what so many beds can say (`unseen_limit`), and
    one that few have met has no wider bounds than that, or than its error on the plain scale.
    Raises ValueError for fewer than two refits or beds, for a refit with fewer than two draws, and for counts that are
    no part of their totals.
    Source: [Sun-2011] (variance between, freed of that within); [Field-2007] (groups drawn whole).
    """
    met, drawn = numbers("counts", counts), numbers("totals", totals)
    if met.shape != drawn.shape or len(met) < 2 or whole_number("bed_count", bed_count, 0) < 2 or drawn.min() < 2:
        raise ValueError(
            f"{len(met)} refits to {bed_count} beds, the least with {drawn.min(initial=0):g} draws; give at least two "
            "of each"
        )
    if not ((met >= 0.0) & (met <= drawn)).all():
        raise ValueError("counts must lie between 0 and totals in every refit: draws that have met the event, of all")
    share, total = float(met.sum() / drawn.sum()), float(drawn.sum())
    limit = upper_limit(bed_count, LEVEL)
    if share in (0.0, 1.0):
        return IntervalEstimate(share, share * (1.0 - limit), share + (1.0 - share) * limit)
    shares = met / drawn
    total_variance = float(shares.var(ddof=1))
    between = total_variance - float(np.mean(shares * (1.0 - shares) / (drawn - 1.0)))
    # What so few draws cannot tell from chance counts as its own standard error: without it bounds hold 0.77 to 0.86.
    between = max(between, total_variance * math.sqrt(2.0 / len(shares)))
    # Drawing B of B beds scatters by (B - 1) / B of what B beds scatter by.
    error = math.sqrt(between * bed_count / (bed_count - 1) + share * (1.0 - share) / total)
    half = t_quantile(bed_count - 1) * error
    lower, upper = share_interval(share, half)
    # On the logit scale a few draws with the event could pass for anything.
    if share < 0.5:
        return IntervalEstimate(share, lower, min(upper, max(share + half, limit)))
    return IntervalEstimate(share, max(lower, min(share - half, 1.0 - limit)), upper)
