"""Which inputs make the failures: how far their law among failing landings lies from that over all."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from lithobrake.analysis.confidence import LEVEL, answers, numbered_beds
from lithobrake.chaos.basis import checked_points
from lithobrake.vocabulary.arrays import Array
from lithobrake.vocabulary.given_numbers import random_numbers

if TYPE_CHECKING:
    from lithobrake.chaos import Distribution

DRAW_COUNT = 400


@dataclass(frozen=True)
class FailureInput:
    """An input among failing landings beside the same over all.

    distance        largest difference of the two distribution functions (Kolmogorov's), 0 to 1
    lower, upper    its interval, by drawing the beds anew
    luck            distance that no input without effect passes, with probability `level`, all inputs together
    median, median_of_all   of the input among failing landings, and by its law, in its unit
    """

    distance: float
    lower: float
    upper: float
    luck: float
    median: float
    median_of_all: float
    level: float = LEVEL

    @property
    def found(self) -> bool:
        """Whether failing landings differ in this input by more than luck."""
        return self.distance > self.luck


def failure_inputs(
    inputs: Mapping[str, "Distribution"], x: ArrayLike, failing: ArrayLike, bed: ArrayLike, seed: int = 0
) -> dict[str, FailureInput]:
    """Compare each input among failing runs with its law.

    x [run_count, input_count] in physical units, drawn from the law of the inputs; failing [run_count], from 0 to 1, or
    NaN where nobody knows; bed [run_count]. Empty where no run fails. Beds are drawn with replacement, `DRAW_COUNT`
    times, and failures are dealt out anew to the runs as often to tell what luck alone does.
    Source: [Spear-1980] (distribution functions of failing and other points compared); [Field-2007] (groups drawn
    whole).
    """
    of_all = answers("failing", failing)
    known = np.isfinite(of_all)
    if not ((of_all[known] >= 0.0) & (of_all[known] <= 1.0)).all():
        raise ValueError("failing must lie between 0 and 1, or be NaN where nobody knows")
    weights, beds = of_all[known], numbered_beds(numbered_beds(bed, len(of_all))[known], int(known.sum()))
    points = checked_points(inputs, x)[known]
    if not weights.sum() > 0.0:
        return {}
    random = random_numbers(seed)
    # Luck deals out what the runs have: shares of flights, or ones and noughts.
    dealt = np.array([random.permutation(weights) for _ in range(DRAW_COUNT)])
    drawn = weights * _counts_of_beds(beds, random)[:, beds]
    drawn = drawn[drawn.sum(axis=1) > 0.0]
    columns = [OrderedInput.of(law, values) for law, values in zip(inputs.values(), points.T, strict=True)]
    luck = np.quantile(np.max([column.distance(dealt) for column in columns], axis=0), LEVEL)
    found = {}
    for (name, law), column in zip(inputs.items(), columns, strict=True):
        distance = float(column.distance(weights[None])[0])
        # Drawing anew adds the luck of the draw to a distance, which has no sign: what it adds is taken off.
        spread = column.distance(drawn) - max(float(np.mean(column.distance(drawn))) - distance, 0.0)
        lower, upper = np.quantile(spread, [0.5 - 0.5 * LEVEL, 0.5 + 0.5 * LEVEL])
        found[name] = FailureInput(
            distance, max(min(float(lower), distance), 0.0), min(max(float(upper), distance), 1.0), float(luck),
            column.median(weights), float(law.median),
        )  # fmt: skip
    return found


@dataclass(frozen=True)
class OrderedInput:
    """One input of the runs: its values in order, their places among the runs, and its distribution function there."""

    values: Array
    order: np.ndarray
    law: Array

    @classmethod
    def of(cls, law: "Distribution", values: Array) -> "OrderedInput":
        """The values of one input, by its law."""
        order = np.argsort(values, kind="stable")
        return cls(values[order], order, law.cdf(values[order]))

    def distance(self, weights: Array) -> Array:
        """Largest difference between the law and the runs, weighted [draw_count, run_count], shape [draw_count]."""
        steps = np.cumsum(weights[:, self.order], axis=1)
        steps /= steps[:, -1:]
        before = np.column_stack([np.zeros(len(steps)), steps[:, :-1]])
        furthest: Array = np.maximum(np.abs(steps - self.law), np.abs(before - self.law)).max(axis=1)
        return furthest

    def median(self, weights: Array) -> float:
        """Weighted median of the values."""
        steps = np.cumsum(weights[self.order])
        return float(self.values[np.searchsorted(steps, 0.5 * steps[-1])])


def _counts_of_beds(beds: np.ndarray, random: np.random.Generator) -> Array:
    """How often each bed comes when as many are drawn with replacement, [DRAW_COUNT, bed_count]."""
    count = int(beds.max()) + 1
    drawn = random.integers(count, size=(DRAW_COUNT, count))
    return np.array([np.bincount(one, minlength=count) for one in drawn], dtype=float)
