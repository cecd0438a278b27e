"""Probabilities of rare failures, by subset simulation: from level to level, each a tenth of the one before.

Source: [Au-2001] (subset simulation, and its coefficient of variation); [Papaioannou-2015] (conditional sampling).
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.analysis.confidence import LEVEL, Array, normal_quantile

# Share of the points of a level that make the next one.
LEVEL_SHARE = 0.1
# Share of moves to aim for. Source: [Papaioannou-2015], section 3.3.
BEST_ACCEPTANCE = 0.44
# How far a first move goes, as a part of the standard deviation of the seeds.
FIRST_STEP = 0.6
# Correlation of the errors of two levels, whose chains have ancestors in common: without it bounds of 90 % hold .81 to
# .89 of the probabilities of docs/reliability.md, with it .88 to .96.
CORRELATION_OF_LEVELS = 0.15
# Levels after which a probability is below 1e-20 and the model is more likely wrong than that rare.
MOST_LEVELS = 20

Margin = Callable[[Array], ArrayLike]
Flags = NDArray[np.bool_]


@dataclass(frozen=True)
class SubsetResult:
    """What subset simulation found.

    probability, lower, upper   of failure, its bounds from the coefficient of variation on the logarithmic scale
    coefficient_of_variation    standard deviation of the probability over itself, as the chains tell it
    thresholds [level_count]    margins that the levels lay below; the last is 0
    failing [count, dimension]  points that fail, standard normal: which inputs make it, and where
    evaluation_count            how many margins were asked for
    reached                     whether a level had failing points; without, probability is 0 and upper a rough bound
    """

    probability: float
    lower: float
    upper: float
    coefficient_of_variation: float
    thresholds: Array
    failing: Array
    evaluation_count: int
    reached: bool = True
    level: float = LEVEL


def subset_simulation(
    margin: Margin,
    dimension: int,
    *,
    points_per_level: int = 1000,
    kept: Sequence[int] = (),
    most_levels: int = MOST_LEVELS,
    seed: int = 0,
) -> SubsetResult:
    """Estimate the probability that a margin is at most 0, over independent standard normal inputs.

    margin: of points [count, dimension], shape [count]; the same point has the same margin, so whatever is random in a
    model is an input of its own. kept: inputs that a chain keeps from its start, as those that pick a bed: a model that
    jumps when they change would refuse nearly every move. points_per_level: a multiple of ten, 20 at least.
    most_levels: after which a failure that no point has shown is not looked for further.
    Raises ValueError for other counts, and for margins that are no numbers.
    """
    chain_count = _checked(dimension, points_per_level, kept)
    random = np.random.default_rng(seed)
    points = random.standard_normal((points_per_level, dimension))
    values = _margins(margin, points)
    moved = np.setdiff1d(np.arange(dimension), np.asarray(kept, dtype=int))
    # At the first level points are independent; later ones stand in chains.
    probability, step, count = 1.0, FIRST_STEP, points_per_level
    thresholds: list[float] = []
    variations: list[float] = []
    for number in range(most_levels + 1):
        order = np.argsort(values, kind="stable")
        threshold = max(0.5 * float(values[order[chain_count - 1]] + values[order[chain_count]]), 0.0)
        below = values <= (threshold if number < most_levels else 0.0)
        share = float(below.mean())
        if share == 0.0:
            break
        chains = below.reshape(-1, chain_count) if number else below[None]
        variations.append(_variation(chains, share))
        probability *= share
        thresholds.append(threshold if number < most_levels else 0.0)
        # Where many points have one margin a level may hold all of them and lead nowhere.
        if threshold == 0.0 or share == 1.0 or number == most_levels:
            break
        seeds = random.permutation(np.flatnonzero(below))[:chain_count]
        points, values, step = _chains(margin, points[seeds], values[seeds], threshold, moved, step, random)
        # A level may keep some points more than its share, where margins are equal.
        count += len(points) - chain_count
    failing = points[values <= 0.0]
    reached = len(failing) > 0
    return _result(probability if reached else 0.0, probability, variations, thresholds, failing, count, reached)


def _chains(
    margin: Margin,
    points: Array,
    values: Array,
    threshold: float,
    moved: NDArray[np.int64],
    step: float,
    random: np.random.Generator,
) -> tuple[Array, Array, float]:
    """Walk from seeds [chain_count, dimension] below a threshold, all chains at once, ten points each.

    Gives points [10 chain_count, dimension], the first of all chains first, their margins, and the step as learnt.
    """
    spread = np.minimum(step * np.maximum(points[:, moved].std(axis=0), 1e-3), 1.0)
    all_points, all_values = [points], [values]
    for place in range(1, round(1.0 / LEVEL_SHARE)):
        proposed = points.copy()
        shift = spread * random.standard_normal((len(points), len(moved)))
        # Keeps the standard normal law, so that only the margin decides whether a move is taken.
        proposed[:, moved] = np.sqrt(1.0 - spread**2) * points[:, moved] + shift
        found = _margins(margin, proposed)
        taken = found <= threshold
        points, values = np.where(taken[:, None], proposed, points), np.where(taken, found, values)
        all_points.append(points)
        all_values.append(values)
        step *= math.exp((float(taken.mean()) - BEST_ACCEPTANCE) / math.sqrt(place))
        spread = np.minimum(step * np.maximum(all_points[0][:, moved].std(axis=0), 1e-3), 1.0)
    return np.concatenate(all_points), np.concatenate(all_values), step


def _variation(below: Flags, share: float) -> float:
    """Coefficient of variation of the share of a level, from chains [chain_length, chain_count] of its points.

    Source: [Au-2001], Eqs 25 to 29.
    """
    length = len(below)
    if not 0.0 < share < 1.0:
        return 0.0
    deviations = below - share
    variance = share * (1.0 - share)
    inefficiency = 0.0
    for lag in range(1, length):
        correlation = float(np.mean(deviations[:-lag] * deviations[lag:])) / variance
        inefficiency += 2.0 * (1.0 - lag / length) * correlation
    return math.sqrt((1.0 - share) / (share * below.size) * max(1.0 + inefficiency, 1.0 / length))


def _result(
    probability: float,
    rarest: float,
    variations: list[float],
    thresholds: list[float],
    failing: Array,
    count: int,
    reached: bool,
) -> SubsetResult:
    """The result with its bounds; rarest: probability of the last level that was reached."""
    variance = (1.0 - CORRELATION_OF_LEVELS) * sum(one**2 for one in variations)
    variance += CORRELATION_OF_LEVELS * sum(variations) ** 2
    half = normal_quantile() * math.sqrt(math.log1p(variance))
    lower, upper = (probability * math.exp(-half), min(probability * math.exp(half), 1.0)) if reached else (0.0, rarest)
    margins = np.array(thresholds)
    return SubsetResult(probability, lower, upper, math.sqrt(variance), margins, failing, count, reached)


def _margins(margin: Margin, points: Array) -> Array:
    """Margins of points [count, dimension]. Raises ValueError for other shapes and for what is no number."""
    values = np.asarray(margin(points), dtype=float)
    if values.shape != (len(points),) or np.isnan(values).any():
        raise ValueError(
            f"margin gave shape {values.shape} with {int(np.isnan(values).sum())} NaN for {len(points)} points; it "
            "must give one number for each: a large one where nothing failed"
        )
    return values


def _checked(dimension: int, points_per_level: int, kept: Sequence[int]) -> int:
    """How many chains a level has. Raises ValueError for counts and inputs that cannot be."""
    length = round(1.0 / LEVEL_SHARE)
    if points_per_level < 2 * length or points_per_level % length:
        raise ValueError(
            f"points_per_level is {points_per_level}; allowed: multiples of {length} from {2 * length}; take 1000"
        )
    if dimension < 1 or not set(kept) < set(range(dimension)):
        raise ValueError(f"kept is {list(kept)} of {dimension} inputs; allowed: some of them, counted from 0, not all")
    return points_per_level // length
