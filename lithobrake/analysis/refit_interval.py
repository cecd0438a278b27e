"""Interval of a share that only the emulator knows: from draws of fits to beds drawn with replacement."""

import math

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import LEVEL, IntervalEstimate, share_interval, t_quantile
from lithobrake.analysis.outcome_model import upper_limit
from lithobrake.given_numbers import numbers, whole_number


def refit_interval(counts: ArrayLike, totals: ArrayLike, bed_count: int, run_count: int) -> IntervalEstimate:
    """Share of draws that have met an event, with its interval over beds that were not in the study.

    counts, totals [refit_count]: draws of each refit that have met it, and all of its draws, at least two. bed_count,
    run_count: what the emulator was fitted to. The scatter of the refits' shares, less what finite draws add, is the
    error of the fit; an event that no draw or every draw has met is bounded by what so many runs can say.
    Raises ValueError for fewer than two refits or beds, for a refit with fewer than two draws, and for
    counts that are no part of their totals.
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
    if share in (0.0, 1.0):
        limit = upper_limit(run_count, LEVEL)
        return IntervalEstimate(share, share * (1.0 - limit), share + (1.0 - share) * limit)
    shares = met / drawn
    total_variance = float(shares.var(ddof=1))
    between = total_variance - float(np.mean(shares * (1.0 - shares) / (drawn - 1.0)))
    # What so few draws cannot tell from chance counts as its own standard error: without it bounds hold .77 to .86.
    between = max(between, total_variance * math.sqrt(2.0 / len(shares)))
    # Drawing B of B beds scatters by (B - 1) / B of what B beds scatter by.
    error = math.sqrt(between * bed_count / (bed_count - 1) + share * (1.0 - share) / total)
    lower, upper = share_interval(share, t_quantile(bed_count - 1) * error)
    return IntervalEstimate(share, lower, upper)
