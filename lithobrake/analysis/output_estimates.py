"""Mean and quantiles of an output over the law of the inputs, on beds nobody has poured yet."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import Array, IntervalEstimate, Labels, answered_runs, t_quantile
from lithobrake.analysis.share_estimate import standard_error


def mean_estimate(y: ArrayLike, bed: ArrayLike) -> IntervalEstimate:
    """Mean of an output y [run_count], NaN where a run has none, with its interval from beds [run_count].

    Raises ValueError for runs on one bed. Source: [Cameron-2008] (errors from few clusters).
    """
    values, beds = _known(y, bed)
    mean, half = float(values.mean()), t_quantile(int(beds.max())) * standard_error(values, beds)
    return IntervalEstimate(mean, mean - half, mean + half)


def quantile_estimates(
    y: ArrayLike, bed: ArrayLike, probabilities: Sequence[float] = (0.05, 0.5, 0.95)
) -> list[IntervalEstimate]:
    """Quantiles of an output y [run_count], NaN where a run has none, with their intervals from beds [run_count].

    The share of runs below a quantile has an interval from beds; the bounds are the quantiles at its ends, so they
    follow the skewness of the output and stay among its values. Raises ValueError for runs on one bed, and for
    probabilities outside 0 to 1.
    Source: [Woodruff-1952] (intervals of quantiles); [Hyndman-1996], definition 5 (a run in the middle of its step).
    """
    if not all(0.0 < probability < 1.0 for probability in probabilities):
        raise ValueError(f"probabilities are {list(probabilities)}; each must lie between 0 and 1")
    values, beds = _known(y, bed)
    ordered, places = np.sort(values), (np.arange(len(values)) + 0.5) / len(values)
    found = []
    for probability in probabilities:
        quantile = float(np.interp(probability, places, ordered))
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
