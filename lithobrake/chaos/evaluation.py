"""Evaluating an expansion at many points: each term is one multiplication away from an earlier term."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.basis import Indices, germs_of, recurrences_of
from lithobrake.chaos.distributions import Distribution
from lithobrake.chaos.polynomials import Recurrence
from lithobrake.vocabulary.array_types import Array

Loop = Callable[..., None]

# Points whose tables stay in the first-level cache together; the innermost loops run over them.
LANES = 64
# Points worked on at once: the tables of one block stay in the processor's cache.
BLOCK = 4096
# Below this number of points loading the compiler costs more than it saves.
COMPILED_FROM = 20_000


def expansion_loop(
    germs: Array,
    offset: NDArray[np.int64],
    center: Array,
    spread: Array,
    parent: NDArray[np.int64],
    factor: NDArray[np.int64],
    coefficients: Array,
    result: Array,
) -> None:
    """Evaluate an expansion at germs [input_count, count]; only result [count, output_count] is written.

    offset [input_count + 1]: first table row of each input; center, spread [row_count of the tables]: recurrence that
    leads from a row to the next; parent, factor [term_count]: as in `EvaluationPlan`; coefficients [term_count,
    output_count].
    """
    input_count, count = germs.shape
    term_count, output_count = coefficients.shape
    table = np.ones((offset[input_count], LANES))
    work = np.ones((term_count, LANES))
    total = np.empty((output_count, LANES))
    for start in range(0, count, LANES):
        lanes = min(LANES, count - start)
        for k in range(input_count):
            for row in range(offset[k], offset[k + 1] - 1):
                a, scale = center[row], 1.0 / spread[row]
                if row == offset[k]:
                    for lane in range(lanes):
                        table[row + 1, lane] = (germs[k, start + lane] - a) * scale
                else:
                    back = spread[row - 1] * scale
                    for lane in range(lanes):
                        step = (germs[k, start + lane] - a) * scale
                        table[row + 1, lane] = step * table[row, lane] - back * table[row - 1, lane]
        for output in range(output_count):
            for lane in range(LANES):
                total[output, lane] = coefficients[0, output]
        for term in range(1, term_count):
            above, side, here = work[parent[term]], table[factor[term]], work[term]
            for lane in range(LANES):
                here[lane] = above[lane] * side[lane]
            for output in range(output_count):
                weight, sums = coefficients[term, output], total[output]
                for lane in range(LANES):
                    sums[lane] += weight * here[lane]
        for lane in range(lanes):
            for output in range(output_count):
                result[start + lane, output] = total[output, lane]


@cache
def compiled_loop() -> Loop | None:
    """The compiled `expansion_loop`, or None without Numba."""
    if find_spec("numba") is None:
        return None
    from lithobrake.compilation.compiled import compiled

    return compiled(expansion_loop)


@dataclass(frozen=True)
class EvaluationPlan:
    """The order of multiplications for an index set.

    offset: first row of each input in the stacked univariate tables [input_count + 1]; center, spread: recurrence from
    each row to the next, padded at the last row of an input. parent: earlier term [row_count]; factor: row of the
    tables [row_count]; the first row is the constant. coefficients [row_count, output_count], zero for rows that
    serve as parents only.
    """

    recurrences: list[Recurrence]
    offset: NDArray[np.int64]
    center: Array
    spread: Array
    parent: NDArray[np.int64]
    factor: NDArray[np.int64]
    coefficients: Array


def make_plan(inputs: Mapping[str, Distribution], indices: Indices, coefficients: Array) -> EvaluationPlan:
    """Order the terms so that each is its parent (the same index without its last input) times one factor."""
    recurrences = recurrences_of(inputs, indices)
    offset = np.concatenate([[0], np.cumsum([one.degree + 1 for one in recurrences])])
    place: dict[tuple[int, ...], int] = {}
    parent: list[int] = []
    factor: list[int] = []

    def add(index: tuple[int, ...]) -> int:
        if index in place:
            return place[index]
        last = max((k for k, power in enumerate(index) if power), default=-1)
        above = 0 if last < 0 else add((*index[:last], 0, *index[last + 1 :]))
        place[index] = len(parent)
        parent.append(above)
        factor.append(0 if last < 0 else int(offset[last]) + index[last])
        return place[index]

    add((0,) * indices.shape[1])
    rows = [add(tuple(int(power) for power in index)) for index in indices]
    table = np.zeros((len(parent), coefficients.shape[1]))
    np.add.at(table, rows, coefficients)
    center = np.concatenate([np.append(one.center, 0.0) for one in recurrences])
    spread = np.concatenate([np.append(one.spread, 1.0) for one in recurrences])
    return EvaluationPlan(recurrences, offset, center, spread, np.array(parent), np.array(factor), table)


def evaluate(inputs: Mapping[str, Distribution], plan: EvaluationPlan, points: Array) -> Array:
    """Values of the expansion at points in physical units [count, input_count]; result [count, output_count].

    Many points go through the compiled loop where Numba is present, few through NumPy (equal up to rounding).
    """
    result = np.empty((len(points), plan.coefficients.shape[1]))
    loop = compiled_loop() if len(points) >= COMPILED_FROM else None
    for start in range(0, len(points), BLOCK):
        germs = germs_of(inputs, points[start : start + BLOCK])
        _fill(plan, germs, result[start : start + BLOCK], loop)
    return result


def _fill(plan: EvaluationPlan, germs: Array, result: Array, loop: Loop | None) -> None:
    if loop is not None:
        loop(germs, plan.offset, plan.center, plan.spread, plan.parent, plan.factor, plan.coefficients, result)
        return
    table = np.concatenate([one.values(germ) for one, germ in zip(plan.recurrences, germs, strict=True)])
    rows = np.ones((len(plan.parent), germs.shape[1]))
    for row in range(1, len(plan.parent)):
        np.multiply(rows[plan.parent[row]], table[plan.factor[row]], out=rows[row])
    np.matmul(rows.T, plan.coefficients, out=result)
