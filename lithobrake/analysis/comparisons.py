"""Which of several choices is best."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import special

from lithobrake.analysis.confidence import LEVEL, share_interval, t_quantile
from lithobrake.analysis.unseen_event import RunCounts, limit_of_runs
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.given_numbers import finite_number, numbers, whole_number


@dataclass(frozen=True)
class BestChoice:
    """The option with the largest mean, its bias-corrected fraction, and the options not distinguishable from it.

    best, runner_up  places among the choices; runner_up is None where only one was allowed
    shares           of refits in which each choice is the best, [choice_count]; 0 of those not allowed. No probability
                     that it is: refits scatter about one fit, whose own error they share
    difference       of the best over the runner-up
    own              how often the best meets the event, less what its selection adds: the mean of the best of many is
                     too high by several points. A little of the excess is left where many are alike; the interval
                     holds it (docs/aiming.md has the coverage)
    not_worse        places of the best and of all that cannot be told from it; they hold the true best at the level
    """

    best: int
    runner_up: int | None
    shares: Array
    difference: Estimate | None
    own: Estimate
    not_worse: tuple[int, ...]


def best_choice(
    met: ArrayLike, bed_count: int, allowed: ArrayLike, *, run_count: RunCounts | None = None
) -> BestChoice:  # fmt: skip
    """Find the choice that meets an event most often, met [choice_count, refit_count, draw_count], of those allowed.

    bed_count, run_count: beds and runs that the emulator was fitted to, as for `refit_interval`. The same
    place in two choices is the same draw of all but the choice, so differences are taken draw by draw. Refits scatter
    by what beds do and by what so few draws add; their distances from the mean are scaled to the first, and to what all
    draws together leave of the second.
    Raises ValueError for fewer than two refits, draws or beds, and where nothing is allowed.
    Source: [Sun-2011] (variance between, freed of that within); [Efron-1983] (what selection adds); [Hsu-1981] (all
    that cannot be told from the best).
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
    not_worse = _not_worse(values, best, open_to, bed_count)
    limit = limit_of_runs(bed_count if run_count is None else run_count, bed_count)
    own = _own(values, best, open_to, not_worse, bed_count, limit)
    if runner_up is None:
        return BestChoice(best, None, shares, None, own, not_worse)
    between = values[best] - values[runner_up]
    half = t_quantile(bed_count - 1) * math.sqrt(_error_variance(between, bed_count))
    value = float(between.mean())
    return BestChoice(best, runner_up, shares, Estimate(value, value - half, value + half), own, not_worse)


def quantile_within(values: ArrayLike, probability: float, levels: tuple[float, float]) -> tuple[float, float, float]:
    """Quantile of values [count], with bounds at the ends of the interval of the fraction below it.

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


def _own(
    values: Array, best: int, allowed: NDArray[np.intp], near: tuple[int, ...], bed_count: int, limit: float
) -> Estimate:  # fmt: skip
    """The mean of the best less its optimism, with the error that those which cannot be distinguished from it have.

    That the best is chosen among them chooses a small error of its own, too. So the variance is theirs together, as a
    part of p (1 - p), on the logit scale near 0 and 1. limit: of what the runs have not shown.
    """
    value = min(max(float(values[best].mean()) - _optimism(values[allowed], bed_count), 0.0), 1.0)
    means = values[list(near)].mean(axis=(1, 2))
    spread = float((means * (1.0 - means)).sum())
    # Where no draw scatters so many runs bound what was never seen.
    if value in (0.0, 1.0) or spread <= 0.0:
        return Estimate(value, value * (1.0 - limit), value + (1.0 - value) * limit)
    part = sum(_error_variance(values[one], bed_count) for one in near) / spread
    lower, upper = share_interval(value, t_quantile(bed_count - 1) * math.sqrt(part * value * (1.0 - value)))
    return Estimate(value, lower, upper)


def _optimism(values: Array, bed_count: int) -> float:
    """How far the best of a refit lies above its own mean over all refits, of [choice_count, refit_count, draw_count].

    Choices scatter alike, so what refits and draws add is told from all of them together: that of one choice alone is
    told so roughly from few draws that too much would be taken off.
    """
    means = values.mean(axis=2)
    centres = means.mean(axis=1, keepdims=True)
    total = float(means.var(axis=1, ddof=1).mean())
    within = float(values.var(axis=2, ddof=1).mean()) / values.shape[2]
    error = max(total - within, 0.0) * bed_count / (bed_count - 1) + within / values.shape[1]
    deviations = math.sqrt(error / total) * (means - centres) if total > 0.0 else means - centres
    winners = (centres + deviations).argmax(axis=0)
    return float(deviations[winners, np.arange(len(winners))].mean())


def _not_worse(values: Array, best: int, allowed: NDArray[np.intp], bed_count: int) -> tuple[int, ...]:
    """Places of the best and of those whose difference to it is within its error, all together (Bonferroni)."""
    others = [int(one) for one in allowed if one != best]
    reach = float(special.stdtrit(bed_count - 1, 1.0 - (1.0 - LEVEL) / max(len(others), 1)))
    differences = {one: values[best] - values[one] for one in others}
    near = [one for one, gap in differences.items() if gap.mean() <= reach * math.sqrt(_error_variance(gap, bed_count))]
    return tuple(sorted([best, *near]))


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
    return means.mean() + scale * deviations
