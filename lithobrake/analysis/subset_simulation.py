"""Which landings meet a limit state, and the probability of rare ones by subset simulation."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.analysis.confidence import t_quantile
from lithobrake.vocabulary.array_types import Array, Labels
from lithobrake.vocabulary.estimate import Estimate
from lithobrake.vocabulary.given_numbers import labels, numbers, random_numbers, whole_number
from lithobrake.vocabulary.limit_state import COMPARED, Comparison, Condition, Junction, LimitState, Negation, Word
from lithobrake.vocabulary.outcomes import JourneyEnd, TouchdownOutcome

Values = Mapping[str, NDArray[np.float64]]

# Outputs that a lander has also if it is captured; all others are of its rebound, which it does not have.
ALSO_OF_CAPTURED = ("contact_duration", "penetration", "peak_acceleration", "energy_lost")
# Distances where there is none: of what is true or false alone, or is not known, and of what lies on the boundary.
FAR, NEAR = 1e30, 1e-30
# Share of the points of a level that make the next one.
LEVEL_SHARE = 0.1
# The share of the first points that fail from which on levels need more points than plain Monte Carlo for the same
# scatter, however the first points fell (docs/reliability.md).
NO_GAIN = 0.05
# Share of moves to aim for. Source: [Papaioannou-2015], section 3.3.
BEST_ACCEPTANCE = 0.44
# How far a first move goes, as a part of the standard deviation of the seeds.
FIRST_STEP = 0.6
# Levels after which a probability is below 1e-20 and the model is more likely wrong than that rare.
MOST_LEVELS = 20
Margin = Callable[[Array], ArrayLike]


class Met(NamedTuple):
    """Which landings surely meet a condition, and which may, both [count]."""

    surely: NDArray[np.bool_]
    maybe: NDArray[np.bool_]


def limit_state_met(state: LimitState, values: Values) -> NDArray[np.float64]:
    """Whether landings or journeys meet a limit state: 1, 0, or NaN where what is known does not decide, shape [count].

    values: of each name that it uses and of `captured`, or of `at_rest` for one of journeys, [count]: numbers [SI],
    words 1 or 0; NaN is not known. A comparison is not met with what a lander does not have: outputs of the rebound of
    one that was captured, and numbers of the place and time of rest of one that does not come to rest.
    """
    found = _met(state.condition, values)
    return np.where(found.surely == found.maybe, found.surely.astype(float), np.nan)


def limit_state_margin(state: LimitState, values: Values, scale: Mapping[str, float]) -> NDArray[np.float64]:
    """How far landings are from meeting a limit state, shape [count]: at most 0 where they do, FAR where not known.

    values: as for `limit_state_met`; scale: of each output that it uses, in its unit, in which distances are counted.
    """
    met = limit_state_met(state, values)
    # The sign is that of `met`, whatever a distance of several comparisons, or one of exactly 0, would have.
    size = np.maximum(np.abs(np.nan_to_num(_distance(state.condition, values, scale), nan=FAR)), NEAR)
    return np.where(met == 1.0, -size, np.where(met == 0.0, size, FAR))


def _met(condition: Condition, values: Values) -> Met:
    """Which landings meet a condition; what is not known may be so or not (logic of three values)."""
    match condition:
        case Junction(parts, needs_all):
            join = np.logical_and if needs_all else np.logical_or
            surely, maybe = zip(*(_met(part, values) for part in parts), strict=True)
            return Met(join.reduce(surely), join.reduce(maybe))
        case Negation(other):
            found = _met(other, values)
            return Met(~found.maybe, ~found.surely)
        case Word(name, is_so):
            return Met(values[name] == float(is_so), values[name] != float(not is_so))
        case Comparison():
            return _compared(condition, values)


def _compared(comparison: Comparison, values: Values) -> Met:
    """Which landings meet a comparison of two sides or more."""
    numbers = _numbers(comparison, values)
    met = known = np.ones(np.broadcast_shapes(*map(np.shape, numbers)), dtype=bool)
    for side, number in zip(comparison.sides, numbers, strict=True):
        if isinstance(side, str):
            # NaN is neither above nor below anything: a captured lander meets nothing that is said of its rebound.
            known = known & (np.isfinite(number) | _lacks(side, values))
    for sign, left, right in zip(comparison.signs, numbers, numbers[1:], strict=False):
        met = met & COMPARED[sign](left, right)
    return Met(known & met, ~known | met)


def _lacks(name: str, values: Values) -> NDArray[np.bool_]:
    """Which landers have no number of a name, [count]."""
    if JourneyEnd.AT_REST in values:
        return values[JourneyEnd.AT_REST] == 0.0
    return (values[TouchdownOutcome.CAPTURED] == 1.0) & (name not in ALSO_OF_CAPTURED)


def _distance(condition: Condition, values: Values, scale: Mapping[str, float]) -> NDArray[np.float64]:
    """Distance of landings from meeting a condition, [count], below 0 where they do; NaN where an output is missing."""
    match condition:
        case Junction(parts, needs_all):
            # One that is not known leaves the others of an `or` as near as they are.
            nearest = np.maximum if needs_all else np.fmin
            return nearest.reduce([_distance(part, values, scale) for part in parts])
        case Negation(other):
            return -_distance(other, values, scale)
        case Word():
            # What is true or false has no distance.
            return np.where(_met(condition, values).surely, -FAR, FAR)
        case Comparison(sides, signs):
            numbers, size = _numbers(condition, values), max(scale[side] for side in sides if isinstance(side, str))
            pairs = zip(signs, numbers, numbers[1:], strict=False)
            gaps = [(a - b if sign in ("<", "<=") else b - a) / size for sign, a, b in pairs]
            # Two numbers beside each other have one gap for all landings.
            return np.maximum.reduce(np.broadcast_arrays(*gaps))


def _numbers(comparison: Comparison, values: Values) -> list[Any]:
    """The numbers of each side: [count] of an output, or the one that was written."""
    return [values[side] if isinstance(side, str) else side for side in comparison.sides]


@dataclass(frozen=True)
class SubsetResult:
    """Result of a subset simulation: probability, bounds, levels and failing points.

    probability                 of failure, its bounds from the coefficient of variation on the logarithmic scale
    coefficient_of_variation    standard deviation of the probability over itself, as the groups of points tell it
    origins                     how many groups of one size the points that fail descend from; 0 without any
    thresholds [level_count]    margins that the levels lay below; the last is 0
    shares [level_count]        of the points of a level that lie below its threshold; their product is the probability
    failing [count, dimension]  points that fail, standard normal: which inputs make it, and where
    evaluation_count            how many margins were asked for
    reached                     whether a level had failing points; without, probability is 0 and upper a rough bound
    """

    probability: Estimate
    coefficient_of_variation: float
    origins: float
    thresholds: Array
    shares: Array
    failing: Array
    evaluation_count: int
    reached: bool = True


def subset_simulation(
    margin: Margin,
    dimension: int,
    *,
    points_per_level: int = 1000,
    kept: Sequence[int] = (),
    groups: Callable[[Array], ArrayLike] | None = None,
    most_levels: int = MOST_LEVELS,
    seed: int = 0,
) -> SubsetResult:
    """Estimate the probability that a margin is at most 0, over independent standard normal inputs.

    margin: of points [count, dimension], shape [count]; the same point has the same margin, so whatever is random in a
    model is an input of its own. kept: inputs that a chain keeps from its start, as those that pick a bed: a model that
    jumps when they change would refuse nearly every move. groups: labels [count] of points, by kept inputs alone, where
    points have something in common that is itself a draw, as landings on one bed have. points_per_level: a multiple of
    ten, 20 at least. most_levels: after which a failure that no point has shown is not looked for further. Where 5 % of
    the first points fail or more, they are counted, which is plain Monte Carlo: levels would gain nothing.
    Raises ValueError for other counts, and for margins that are no numbers.
    """
    dimension, points_per_level = whole_number("dimension", dimension, 1), _points_per_level(points_per_level)
    chain_count, most_levels = round(LEVEL_SHARE * points_per_level), whole_number("most_levels", most_levels, 1)
    if not set(kept) < set(range(dimension)):
        raise ValueError(f"kept is {list(kept)} of {dimension} inputs; allowed: some of them, counted from 0, not all")
    random = random_numbers(seed)
    points = random.standard_normal((points_per_level, dimension))
    values = _margins(margin, points)
    moved = np.setdiff1d(np.arange(dimension), np.asarray(kept, dtype=int))
    levels, step, count = _Levels(_groups(groups, points)), FIRST_STEP, points_per_level
    for number in range(most_levels + 1):
        order = np.argsort(values, kind="stable")
        threshold = max(0.5 * float(values[order[chain_count - 1]] + values[order[chain_count]]), 0.0)
        counted = number == 0 and float(np.mean(values <= 0.0)) >= NO_GAIN
        threshold = threshold if number < most_levels and not counted else 0.0
        below = values <= threshold
        if not below.any():
            break
        levels.add(threshold, below)
        # Where many points have one margin a level may hold all of them and lead nowhere.
        if threshold == 0.0 or below.all():
            break
        seeds = random.permutation(np.flatnonzero(below))[:chain_count]
        levels.descend(seeds)
        points, values, step = _chains(margin, points[seeds], values[seeds], threshold, moved, step, random)
        # A level may keep some points more than its share, where margins are equal.
        count += len(points) - chain_count
    return levels.result(points, values <= 0.0, count)


class _Levels:
    """What the levels have told so far, and which group each point of the present one descends from, [count].

    The influence of a group is how much it changed the logarithm of the probability, over all levels: its share of the
    points that fail less its share of the first points. So chance that chains share, by an ancestor or a bed, is in it.
    """

    def __init__(self, group: Labels) -> None:
        self.group, self.influence = group, np.zeros(group.max() + 1)
        self.thresholds: list[float] = []
        self.shares: list[float] = []

    def add(self, threshold: float, below: NDArray[np.bool_]) -> None:
        """Note a level by its threshold and which of its points lie below, [count]."""
        share = float(below.mean())
        self.thresholds.append(threshold)
        self.shares.append(share)
        self.influence += np.bincount(self.group, below / share - 1.0, len(self.influence)) / len(below)

    def descend(self, seeds: NDArray[np.intp]) -> None:
        """Go on with chains that start from some points, [chain_count]."""
        self.group = np.tile(self.group[seeds], round(1.0 / LEVEL_SHARE))

    def result(self, points: Array, fails: NDArray[np.bool_], count: int) -> SubsetResult:
        """The result, given the points of the last level, which of them fail, and how many margins were asked for."""
        probability, variation = math.prod(self.shares), self._variation()
        failing = np.bincount(self.group[fails]).astype(float)
        # Groups of unlike size tell as little of their scatter as fewer of one size.
        origins = float(failing.sum() ** 2 / np.sum(failing**2)) if len(failing) else 0.0
        told = variation, origins, np.array(self.thresholds), np.array(self.shares), points[fails], count
        if not len(failing):
            return SubsetResult(Estimate(0.0, 0.0, probability), *told, reached=False)
        # One origin alone is counted as two.
        half = t_quantile(max(origins - 1.0, 1.0)) * math.sqrt(math.log1p(variation**2))
        lower, upper = probability * math.exp(-half), min(probability * math.exp(half), 1.0)
        return SubsetResult(Estimate(probability, lower, upper), *told)

    def _variation(self) -> float:
        """Coefficient of variation of the probability, as groups differ. Source: [Lee-2018]."""
        group_count = len(self.influence)
        return math.sqrt(group_count / (group_count - 1.0) * float(np.sum(self.influence**2)))


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


def _groups(groups: Callable[[Array], ArrayLike] | None, points: Array) -> Labels:
    """Groups of the first points [count], numbered from 0: as labelled, else each point by itself.

    One group alone says nothing of another, so it counts as none.
    """
    alone = np.arange(len(points))
    if groups is None:
        return alone
    given = labels("groups", groups(points), len(points), "each point")
    numbered = np.unique(given, return_inverse=True)[1].astype(np.int64)
    return numbered if numbered.max() > 0 else alone


def _margins(margin: Margin, points: Array) -> Array:
    """Margins of points [count, dimension]. Raises ValueError for other shapes and for what is no number."""
    values = numbers("margin", margin(points))
    if values.shape != (len(points),) or np.isnan(values).any():
        raise ValueError(
            f"margin gave shape {values.shape} with {int(np.isnan(values).sum())} NaN for {len(points)} points; it "
            "must give one number for each: a large one where nothing failed"
        )
    return values


def _points_per_level(count: int) -> int:
    """Check how many points a level has; raises ValueError for what does not make whole chains."""
    length = round(1.0 / LEVEL_SHARE)
    if whole_number("points_per_level", count, 2 * length) % length:
        raise ValueError(f"points_per_level is {count}; allowed: multiples of {length} from {2 * length}; take 1000")
    return int(count)
