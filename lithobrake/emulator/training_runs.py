"""The runs that an emulator is made from, checked, and bounded outputs as unbounded coordinates."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lithobrake.chaos.basis import checked_points
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.numerical_distributions import checked_inputs
from lithobrake.chaos.training_data import check_magnitude
from lithobrake.vocabulary.array_types import Array
from lithobrake.vocabulary.constants import FEWEST_RUNS_OF_EMULATOR
from lithobrake.vocabulary.given_numbers import (
    LARGEST,
    labels,
    numbers,
    numbers_or_nan,
    random_numbers,
    whole_number,
    without_rounding,
)

WITH_OUTPUTS, WITHOUT_OUTPUTS = "with_outputs", "without_outputs"
# Fewer residuals than this are no distribution to draw from.
FEWEST = FEWEST_RUNS_OF_EMULATOR
# What a coordinate may lose of the range of its output.
ROUNDING = 1e-4


def to_coordinate(y: Array, lower: Array, upper: Array) -> Array:
    """Coordinates of outputs y strictly between bounds of the same shape; an infinite bound is none."""
    has_lower, has_upper = np.isfinite(lower), np.isfinite(upper)
    # Where there is no bound the distance is 1, of which the logarithm is 0.
    above = np.where(has_lower, y - np.where(has_lower, lower, 0.0), 1.0)
    below = np.where(has_upper, np.where(has_upper, upper, 0.0) - y, 1.0)
    return np.where(has_lower | has_upper, np.log(above) - np.log(below), y)


def with_slope(y: Array, lower: Array, upper: Array) -> tuple[Array, Array]:
    """Coordinates of any outputs, and derivatives of them by the output; beyond a bound infinite, with derivative 0.

    Bounds broadcast to the shape of y.
    """
    low, high = np.broadcast_to(lower, y.shape), np.broadcast_to(upper, y.shape)
    within = np.clip(y, np.nextafter(low, np.inf), np.nextafter(high, -np.inf))
    coordinate = np.where(y <= low, -np.inf, np.where(y >= high, np.inf, to_coordinate(within, low, high)))
    # Of an infinite bound nothing is left; at the smallest numbers a derivative would overflow.
    with np.errstate(over="ignore"):
        slope = np.minimum(1.0 / (within - low) + 1.0 / (high - within), np.finfo(float).max)
    slope = np.where(np.isfinite(low) | np.isfinite(high), slope, 1.0)
    return coordinate, np.where(np.isinf(coordinate), 0.0, slope)


def from_coordinate(coordinate: Array, lower: Array, upper: Array) -> Array:
    """Outputs of coordinates, strictly between bounds that broadcast to their shape."""
    has_lower, has_upper = np.isfinite(lower), np.isfinite(upper)
    start, end = np.where(has_lower, lower, 0.0), np.where(has_upper, upper, 0.0)
    # Of a coordinate far out no more than the bound itself would be left: the exponent is the smaller one.
    share = 1.0 / (1.0 + np.exp(-np.clip(coordinate, -700.0, 700.0)))
    grown = np.exp(np.clip(coordinate, -700.0, 700.0))
    two_sided = start + (end - start) * share
    one_sided = np.where(has_lower, start + grown, end - 1.0 / grown)
    y = np.where(has_lower & has_upper, two_sided, np.where(has_lower | has_upper, one_sided, coordinate))
    # Rounding may put a draw onto a bound, which no output reaches.
    return inside(y, lower, upper)


def inside(y: Array, lower: Array, upper: Array) -> Array:
    """Outputs with those beyond bounds put onto the next number inside."""
    return np.clip(y, np.nextafter(lower, np.inf), np.nextafter(upper, -np.inf))


@dataclass(frozen=True)
class TrainingRuns:
    """Runs of a model. x [run_count, input_count]; outcome [run_count], places among the outcome names; group
    [run_count], numbers from 0; y, lower, upper [output_run_count, output_count] of the runs with outputs alone.

    riders: columns of y that are drawn with their row unchanged. distant: columns whose bounds bend no coordinate.
    """

    inputs: dict[str, Distribution]
    x: Array
    outcome: NDArray[np.int64]
    outcome_names: tuple[str, ...]
    output_outcome: int
    group: NDArray[np.int64]
    y: Array
    lower: Array
    upper: Array
    output_names: tuple[str, ...]
    riders: tuple[int, ...]
    distant: tuple[int, ...] = ()

    @cached_property
    def has_outputs(self) -> NDArray[np.bool_]:
        """Which runs have outputs [run_count]."""
        return self.outcome == self.output_outcome

    @cached_property
    def modelled(self) -> tuple[int, ...]:
        """Columns of y that have a law of their own."""
        return tuple(k for k in range(self.y.shape[1]) if k not in self.riders)

    @cached_property
    def coordinates(self) -> Array:
        """Coordinates of the modelled outputs [output_run_count, modelled_count]."""
        columns, (low, high) = list(self.modelled), self.bending(self.lower, self.upper)
        return to_coordinate(self.y[:, columns], low[:, columns], high[:, columns])

    def bending(self, lower: Array, upper: Array) -> tuple[Array, Array]:
        """Of bounds [..., output_count] those that bend a coordinate, infinite for the others."""
        unbent = np.isin(np.arange(self.y.shape[1]), self.distant)
        return np.where(unbent, -np.inf, lower), np.where(unbent, np.inf, upper)

    def outputs_of(self, coordinates: Array, lower: Array, upper: Array) -> Array:
        """Modelled outputs of coordinates [..., modelled_count] between bounds [..., output_count] of all outputs."""
        columns, (low, high) = list(self.modelled), self.bending(lower, upper)
        y = from_coordinate(coordinates, low[..., columns], high[..., columns])
        return inside(y, lower[..., columns], upper[..., columns])

    def bounds_at(self, lower: ArrayLike | None, upper: ArrayLike | None, count: int) -> tuple[Array, Array]:
        """Bounds [count, output_count] at points: those given, or those of the runs where they never differed."""
        known = []
        for name, given, of_runs in (("lower", lower, self.lower), ("upper", upper, self.upper)):
            if given is None and (of_runs != of_runs[0]).any():
                raise ValueError(f"{name} is missing, but it differed between the runs: give it at each point")
            known.append(of_runs[0] if given is None else given)
        tables = checked_bounds(known[0], known[1], (count, len(self.output_names)))
        for name, table, of_runs in zip(("lower", "upper"), tables, (self.lower, self.upper), strict=True):
            # A bound that is finite at the runs or at new points alone would give the output another coordinate there.
            if (np.isfinite(table) != np.isfinite(of_runs[0])).any():
                raise ValueError(f"{name} must be finite for the same outputs as in the runs: give it as fit was given")
        return tables

    def checked_weights(self, weights: ArrayLike) -> Array:
        """How often each run counts [run_count]; raises ValueError for what is no such weights."""
        counted, count = numbers("weights", weights), len(self.x)
        if counted.shape != (count,) or not ((counted >= 0.0) & (counted <= LARGEST)).all():
            raise ValueError(
                f"weights have shape {counted.shape}, but must be [{count}]: one finite number of at least 0 for each "
                f"run, {LARGEST:g} at most"
            )
        used = counted[self.has_outputs]
        if (used > 0.0).sum() < 2 or used.sum() < 2.0:
            raise ValueError(
                f"weights count {used.sum():g} runs, {(used > 0.0).sum()} of them different ones with outputs, but a "
                "law needs two: give how often each run counts, 1 for as often as it is there"
            )
        return counted

    def weights_of_refits(self, count: int, seed: int) -> list[Array]:
        """How often each run counts [run_count] where groups are drawn with replacement, `count` times."""
        random = random_numbers(seed)
        group_count = int(self.group.max()) + 1
        draws: list[Array] = []
        while len(draws) < whole_number("count", count, 1):
            drawn = np.bincount(random.integers(group_count, size=group_count), minlength=group_count)
            weights = drawn[self.group].astype(float)
            # Groups without any outputs, drawn alone, have no law.
            if (weights[self.has_outputs] > 0.0).sum() > 1:
                draws.append(weights)
        return draws


def checked_bounds(lower: ArrayLike | None, upper: ArrayLike | None, shape: tuple[int, int]) -> tuple[Array, Array]:
    """Bounds as tables of a shape [count, output_count]; None is no bound. Raises ValueError for other shapes."""
    tables = []
    for name, given, none in (("lower", lower, -np.inf), ("upper", upper, np.inf)):
        table = numbers(name, none if given is None else given)
        try:
            tables.append(np.array(np.broadcast_to(table, shape)))
        except ValueError:
            raise ValueError(
                f"{name} has shape {table.shape}, but must be a number, [{shape[1]}] (one for each output) or "
                f"[{shape[0]}, {shape[1]}] (one for each point and output)"
            ) from None
    if not (tables[0] < tables[1]).all():
        raise ValueError("lower must be less than upper everywhere, and neither may be NaN: give -inf or inf for none")
    return tables[0], tables[1]


def checked_runs(
    inputs: Mapping[str, Distribution],
    x: ArrayLike,
    y: ArrayLike,
    groups: ArrayLike | None,
    outcome: ArrayLike | None,
    outcomes: Sequence[str] | None,
    lower: ArrayLike | None,
    upper: ArrayLike | None,
    riders: Sequence[int | str],
    output_names: Sequence[str] | None,
) -> TrainingRuns:
    """Check what `fit` was given; raises ValueError for shapes, values and labels that do not fit together."""
    distributions = checked_inputs(inputs)
    points = checked_points(distributions, x)
    table = np.atleast_2d(numbers_or_nan("y", y).T).T
    if table.ndim != 2 or len(table) != len(points) or table.shape[1] == 0:
        raise ValueError(f"y has shape {table.shape}, but must be [{len(points)}, output_count]: one row for each run")
    names = tuple(output_names) if output_names is not None else tuple(f"y{k}" for k in range(table.shape[1]))
    if len(names) != table.shape[1] or len(set(names)) < len(names):
        raise ValueError(f"output_names are {names}, but must be {table.shape[1]} different names")
    ended, outcome_names, output_outcome = _checked_outcome(table, outcome, outcomes)
    there = ended == output_outcome
    check_magnitude("y", table[there])
    low, high = (bound[there] for bound in checked_bounds(lower, upper, (len(table), table.shape[1])))
    carried = _checked_riders(riders, names)
    group, values = _checked_groups(groups, len(points), there), without_rounding(table[there])
    runs = TrainingRuns(
        distributions, points, ended, outcome_names, output_outcome, group, values, low, high, names, carried
    )
    _check_inside(runs)
    _check_resolution(runs)
    return runs


def _check_inside(runs: TrainingRuns) -> None:
    """Raise ValueError for outputs that do not lie between their bounds."""
    for bound in (runs.lower, runs.upper):
        # NaN marks no bound alike in all runs, so that a column has one kind of coordinate.
        if (np.isfinite(bound).any(axis=0) != np.isfinite(bound).all(axis=0)).any():
            raise ValueError("a bound must be finite in all runs of an output or in none")
    wrong = ~((runs.lower < runs.y) & (runs.y < runs.upper))
    wrong[:, list(runs.riders)] = False
    if wrong.any():
        run, k = np.argwhere(wrong)[0]
        raise ValueError(
            f"{runs.output_names[k]} is {runs.y[run, k]:g}, but must lie between its bounds {runs.lower[run, k]:g} and "
            f"{runs.upper[run, k]:g}, and on neither: widen the bounds"
        )


def _check_resolution(runs: TrainingRuns) -> None:
    """Raise ValueError for bounds so far from the outputs that their coordinates no longer tell these apart."""
    columns = list(runs.modelled)
    y, low, high = (table[:, columns] for table in (runs.y, runs.lower, runs.upper))
    with np.errstate(over="ignore", invalid="ignore"):
        back = runs.outputs_of(runs.coordinates, runs.lower, runs.upper)
        lost = ~(np.abs(back - y).max(axis=0) <= ROUNDING * np.ptp(y, axis=0))
    lost &= np.ptp(y, axis=0) > 0.0
    if lost.any():
        k = int(np.flatnonzero(lost)[0])
        raise ValueError(
            f"the bounds of {runs.output_names[columns[k]]}, {low[0, k]:g} and {high[0, k]:g}, are so far from its "
            f"values ({y[:, k].min():g} to {y[:, k].max():g}) that rounding takes these together: give -inf or inf "
            "where there is no bound"
        )


def _checked_outcome(
    y: Array, outcome: ArrayLike | None, outcomes: Sequence[str] | None
) -> tuple[NDArray[np.int64], tuple[str, ...], int]:
    """Outcome of each run as a place among the names, the names, and the place of the one that has outputs."""
    there = np.isfinite(y).all(axis=1)
    if (np.isnan(y).any(axis=1) & ~np.isnan(y).all(axis=1)).any() or np.isinf(y).any():
        raise ValueError("each row of y must be all numbers, or all NaN where its outcome has no outputs")
    told = np.where(there, WITH_OUTPUTS, WITHOUT_OUTPUTS) if outcome is None else outcome
    given = labels("outcome", told, len(y), "each run").astype(str)
    names = tuple(dict.fromkeys([*(outcomes or ()), *sorted(set(given.tolist()))]))
    if outcomes is not None and len(names) > len(outcomes):
        raise ValueError(f"outcome holds {names[len(outcomes)]!r}, but outcomes are {', '.join(outcomes)}")
    with_outputs = sorted(set(given[there].tolist()))
    if len(with_outputs) != 1 or with_outputs[0] in given[~there]:
        raise ValueError(
            f"rows of y are there for the outcomes {with_outputs}, but one outcome must have outputs in all its runs, "
            "and the others in none: give runs with outputs one label, and fit another kind apart"
        )
    if there.sum() < FEWEST:
        raise ValueError(f"{there.sum()} runs have outputs, but an emulator needs at least {FEWEST}: make more runs")
    place = {name: index for index, name in enumerate(names)}
    return np.array([place[label] for label in given.tolist()]), names, place[with_outputs[0]]


def _checked_riders(riders: Sequence[int | str], names: tuple[str, ...]) -> tuple[int, ...]:
    """Columns of the riders, given as columns or names; at least one output must be left."""
    carried = []
    for one in riders:
        if one not in names and one not in range(len(names)):
            raise ValueError(f"riders hold {one!r}, but must be columns of y, 0 to {len(names) - 1}, or names: {names}")
        carried.append(names.index(one) if isinstance(one, str) else int(one))
    if len(set(carried)) == len(names):
        raise ValueError("all outputs are riders, but at least one must not be: it is what a law is fitted to")
    return tuple(sorted(set(carried)))


def _checked_groups(groups: ArrayLike | None, count: int, there: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Groups as numbers from 0 [count]; each run is its own where none are given."""
    if groups is None:
        return np.arange(count)
    numbered = np.unique(labels("groups", groups, count, "each run"), return_inverse=True)[1].astype(np.int64)
    if np.ptp(numbered[there]) == 0:
        raise ValueError(
            "groups hold one group with outputs, but leaving one out needs two: leave groups out to score run by run"
        )
    return numbered
