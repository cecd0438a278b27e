"""The compiled loop that evaluates an expansion; absent where Numba is absent."""

from collections.abc import Callable
from functools import cache
from importlib.util import find_spec

import numpy as np
from numpy.typing import NDArray

from lithobrake.vocabulary.arrays import Array

Loop = Callable[..., None]

# Points whose tables stay in the first-level cache together; the innermost loops run over them.
LANES = 64


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
