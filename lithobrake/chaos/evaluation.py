"""Evaluating an expansion at many points: each term is one multiplication away from an earlier term."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lithobrake.chaos.basis import germs_of, recurrences_of
from lithobrake.chaos.germ import Distribution
from lithobrake.chaos.polynomials import Array, Recurrence
from lithobrake.chaos.terms import Indices

# Points worked on at once: the tables of one block stay in the processor's cache.
BLOCK = 4096


@dataclass(frozen=True)
class Plan:
    """The order of multiplications for an index set.

    parent: earlier term [row_count]; factor: row of the stacked univariate tables [row_count]; the first row is the
    constant. coefficients [row_count, output_count], zero for rows that serve as parents only.
    """

    recurrences: list[Recurrence]
    parent: NDArray[np.int64]
    factor: NDArray[np.int64]
    coefficients: Array


def make_plan(inputs: Mapping[str, Distribution], indices: Indices, coefficients: Array) -> Plan:
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
    return Plan(recurrences, np.array(parent), np.array(factor), table)


def evaluate(inputs: Mapping[str, Distribution], plan: Plan, points: Array) -> Array:
    """Values of the expansion at points in physical units [count, input_count]; result [count, output_count]."""
    result = np.empty((len(points), plan.coefficients.shape[1]))
    work = np.ones((len(plan.parent), min(BLOCK, max(len(points), 1))))
    weights = np.ascontiguousarray(plan.coefficients.T)
    for start in range(0, len(points), BLOCK):
        germs = germs_of(inputs, points[start : start + BLOCK])
        table = np.concatenate([one.values(germ) for one, germ in zip(plan.recurrences, germs, strict=True)])
        rows = work[:, : germs.shape[1]]
        for row in range(1, len(plan.parent)):
            np.multiply(rows[plan.parent[row]], table[plan.factor[row]], out=rows[row])
        result[start : start + BLOCK] = (weights @ rows).T
    return result
