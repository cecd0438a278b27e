"""Which of several choices is best by draws of refits, how sure that is, and a quantile with its interval."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.analysis.confidence import Array, IntervalEstimate, t_quantile
from lithobrake.given_numbers import finite_number, numbers, whole_number


@dataclass(frozen=True)
class BestChoice:
    """The choice of the largest mean.

    best, runner_up: places among the choices; runner_up is None where only one was allowed. shares [choice_count]: of
    refits in which each choice is the best; 0 of those not allowed. difference: of the best over the runner-up.
    """

    best: int
    runner_up: int | None
    shares: Array
    difference: IntervalEstimate | None


def best_choice(met: ArrayLike, bed_count: int, allowed: ArrayLike) -> BestChoice:
    """Say which choice has met an event most often, met [choice_count, refit_count, draw_count], of those allowed.

    bed_count: beds that the emulator was fitted to. The same place in two choices is the same draw of all but the
    choice, so differences are taken draw by draw. Refits scatter by what beds do and by what so few draws add; their
    distances from the mean are scaled to the first, and to what all draws together leave of the second.
    Raises ValueError for fewer than two refits, draws or beds, and where nothing is allowed.
    Source: [Sun-2011] (variance between, freed of that within).
    """
    values, open_to = numbers("met", met), np.flatnonzero(np.asarray(allowed, dtype=bool))
    if values.ndim != 3 or np.shape(allowed) != values.shape[:1] or not np.isfinite(values).all():
        raise ValueError(
            f"met has shape {values.shape} and allowed {np.shape(allowed)}, but must be finite numbers [choice_count, "
            "refit_count, draw_count], and whether each choice is allowed [choice_count]"
        )
    if min(values.shape[1:]) < 2 or whole_number("bed_count", bed_count, 0) < 2 or not len(open_to):
        raise ValueError(
            f"draws have shape {values.shape} on {bed_count} beds, and {len(open_to)} choices are allowed; give at "
            "least two refits, two draws of each and two beds, and allow one choice"
        )
    means = values.mean(axis=(1, 2))
    order = open_to[np.argsort(-means[open_to], kind="stable")]
    best, runner_up = int(order[0]), int(order[1]) if len(order) > 1 else None
    scaled = np.array([_scaled(one, bed_count) for one in values[open_to]])
    # Choices that are alike in a refit share it.
    wins = scaled >= scaled.max(axis=0)
    shares = np.zeros(len(values))
    shares[open_to] = (wins / wins.sum(axis=0)).mean(axis=1)
    if runner_up is None:
        return BestChoice(best, None, shares, None)
    between = values[best] - values[runner_up]
    half = t_quantile(bed_count - 1) * math.sqrt(_error_variance(between, bed_count))
    value = float(between.mean())
    return BestChoice(best, runner_up, shares, IntervalEstimate(value, value - half, value + half))


def quantile_within(values: ArrayLike, probability: float, levels: tuple[float, float]) -> tuple[float, float, float]:
    """Quantile of values [count] and its bounds, those at the levels that the share below it may have.

    A bound beyond the outermost value is minus or plus infinity: so few values do not tell it. Raises ValueError for no
    value, one that is not finite, and a probability or levels outside 0 to 1.
    Source: [Woodruff-1952]; [Hyndman-1996], definition 5.
    """
    finite_number("probability", probability, at_least=0.0, at_most=1.0)
    first, second = (finite_number("levels", one, at_least=0.0, at_most=1.0) for one in levels)
    ordered = np.sort(numbers("values", values))
    if ordered.ndim != 1 or not len(ordered) or not np.isfinite(ordered).all() or first > second:
        raise ValueError(
            f"values have shape {ordered.shape}, levels are {first} and {second}; give at least one value, all of them "
            "finite, and the lower level first"
        )
    places = (np.arange(len(ordered)) + 0.5) / len(ordered)
    lower, middle, upper = np.interp([first, probability, second], places, ordered).tolist()
    return middle, lower if first >= places[0] else -math.inf, upper if second <= places[-1] else math.inf


def _error_variance(draws: Array, bed_count: int) -> float:
    """Variance of the error of the mean of draws [refit_count, draw_count], over other beds and draws."""
    refit_count, draw_count = draws.shape
    total = float(draws.mean(axis=1).var(ddof=1))
    within = float(draws.var(axis=1, ddof=1).mean()) / draw_count
    # What so few draws cannot tell from chance counts as its own standard error, as in refit_interval.
    between = max(total - within, total * math.sqrt(2.0 / refit_count))
    # Drawing B of B beds scatters by (B - 1) / B of what B beds scatter by.
    return between * bed_count / (bed_count - 1) + within / refit_count


def _scaled(draws: Array, bed_count: int) -> NDArray[np.float64]:
    """Means of refits [refit_count], scattered about that of all as far as that may be wrong."""
    means = draws.mean(axis=1)
    deviations = means - means.mean()
    total = float(means.var(ddof=1))
    scale = math.sqrt(_error_variance(draws, bed_count) / total) if total > 0.0 else 0.0
    scaled: NDArray[np.float64] = means.mean() + scale * deviations
    return scaled
