"""What one way of fitting gives for one output, so that ways can be compared and joined."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lithobrake.chaos.multi_index import Indices
from lithobrake.vocabulary.arrays import Array


@dataclass(frozen=True)
class Solution:
    """One output: terms [term_count, input_count], coefficients [term_count], and the error expected at new points.

    expected_error: root-mean-square [unit of the output], run-to-run scatter included; error_estimate: how it was
    found; facts: further plain JSON values for the report; residuals [count] if they are at hand.
    """

    method: str
    indices: Indices
    coefficients: Array
    expected_error: float
    error_estimate: str
    facts: dict[str, Any] = field(default_factory=dict)
    residuals: Array | None = None


def with_progress(outputs: range, progress: Callable[[int, int], None]) -> Iterator[int]:
    """The outputs one by one, with how many are done told before each and at the end."""
    for output in outputs:
        progress(output, len(outputs))
        yield output
    progress(len(outputs), len(outputs))


def joined(solutions: Sequence[Solution]) -> tuple[Indices, Array]:
    """Terms that any output uses, ordered by total degree, and coefficients [term_count, output_count]."""
    if all(one.indices is solutions[0].indices for one in solutions):
        return solutions[0].indices, np.column_stack([one.coefficients for one in solutions])
    stacked = np.concatenate([one.indices for one in solutions])
    distinct = np.unique(stacked, axis=0)
    keys = [-distinct[:, column] for column in reversed(range(distinct.shape[1]))]
    indices = np.ascontiguousarray(distinct[np.lexsort([*keys, distinct.sum(axis=1)])])
    place = {tuple(row): k for k, row in enumerate(indices.tolist())}
    coefficients = np.zeros((len(indices), len(solutions)))
    for output, one in enumerate(solutions):
        rows = [place[tuple(row)] for row in one.indices.tolist()]
        coefficients[rows, output] = one.coefficients
    return indices, coefficients


def summary(solutions: Sequence[Solution], names: Sequence[str], y: Array) -> dict[str, Any]:
    """The report of a fit: per output its method and expected error, in its unit and relative to its spread."""
    outputs = {}
    for name, one, column in zip(names, solutions, y.T, strict=True):
        spread = float(np.std(column)) if np.ptp(column) > 0.0 else 0.0
        outputs[name] = {
            "method": one.method,
            "term_count": len(one.indices),
            "rmse_estimate": one.expected_error,
            "rrmse_estimate": one.expected_error / spread if spread > 0.0 else None,
            "error_estimate": one.error_estimate,
            **one.facts,
        }
    methods = sorted({one.method for one in solutions})
    return {
        "method": methods[0] if len(methods) == 1 else "best of each output",
        "rrmse_estimate": [entry["rrmse_estimate"] for entry in outputs.values()],
        "outputs": outputs,
    }
