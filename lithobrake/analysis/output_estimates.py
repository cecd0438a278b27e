"""Quantiles and mean of an output over the input distributions, on beds that were not in the study."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import IntervalEstimate, answered_runs, t_quantile
from lithobrake.analysis.share_estimate import standard_error
from lithobrake.vocabulary.arrays import Array, Labels

# Quantiles of less than this probability, or more than 1 less it, take so many beds for an interval: on fewer beds a
# handful of runs beyond the quantile lie on one or two of them (measured: docs/estimates.md).
TAIL, FEWEST_BEDS_OF_TAIL = 0.1, 10


def mean_estimate(y: ArrayLike, bed: ArrayLike) -> IntervalEstimate:
    """Mean of an output y [run_count], NaN where a run has none, with its interval from beds [run_count].

    For an output with a heavy tail, as the contact time, read the quantiles: a few rare runs carry much of its mean,
    and where a study has none of them the interval promises too much (0.73 to 0.93 at a tail index of 1.9). Raises
    ValueError for runs on one bed. Source: [Cameron-2008] (errors from few clusters).
    """
    values, beds = _known(y, bed)
    mean, half = float(values.mean()), t_quantile(int(beds.max())) * standard_error(values, beds)
    return IntervalEstimate(mean, mean - half, mean + half)


def quantile_estimates(
    y: ArrayLike, bed: ArrayLike, probabilities: Sequence[float] = (0.05, 0.5, 0.95)
) -> list[IntervalEstimate]:
    """Quantiles of an output y [run_count], NaN where a run has none, with their intervals from beds [run_count].

    The share of runs below a quantile has an interval from beds; the bounds are the quantiles at its ends, so they
    follow the skewness of the output and stay among its values. Below 0.1 and above 0.9 fewer than ten beds give no
    interval: the bounds are infinite. Raises ValueError for runs on one bed, and for probabilities outside 0 to 1.
    Source: [Woodruff-1952] (intervals of quantiles); [Hyndman-1996], definition 5 (a run in the middle of its step).
    """
    if not all(0.0 < probability < 1.0 for probability in probabilities):
        raise ValueError(f"probabilities are {list(probabilities)}; each must lie between 0 and 1")
    values, beds = _known(y, bed)
    ordered, places = np.sort(values), (np.arange(len(values)) + 0.5) / len(values)
    found = []
    for probability in probabilities:
        quantile = float(np.interp(probability, places, ordered))
        if not TAIL <= probability <= 1.0 - TAIL and beds.max() + 1 < FEWEST_BEDS_OF_TAIL:
            found.append(IntervalEstimate(quantile, -math.inf, math.inf))
            continue
        error = standard_error((values <= quantile).astype(float), beds)
        half = t_quantile(int(beds.max())) * error
        lower, upper = np.interp([probability - half, probability + half], places, ordered).tolist()
        found.append(IntervalEstimate(quantile, lower, upper))
    return found


def _known(y: ArrayLike, bed: ArrayLike) -> tuple[Array, Labels]:
    values, beds = answered_runs(y, bed)
    if len(np.unique(beds)) < 2:
        raise ValueError(
            f"{len(beds)} runs with the output came down on {len(np.unique(beds))} bed; other beds give other values, "
            "and these runs cannot say how different: set bed.bed_count to 12 or more"
        )
    return values, beds
