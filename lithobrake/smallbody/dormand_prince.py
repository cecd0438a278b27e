"""The embedded Runge-Kutta pair 5(4) with seven stages, and its polynomial between the ends of a step.

Sources: [Dormand-1980]; [Hairer-1993], sections II.4 (step size) and II.6 (dense output).

A state is x, y, z [m] and their rates [m/s]; `derivative` holds that of each stage. Lanes stand last: state
[6, lane], derivative [7, 6, lane].
"""

import numpy as np

from lithobrake.compilation.compiled import kernel
from lithobrake.smallbody.arrays import Floats

STAGES = 7
NODES = np.array([0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1, 1])
WEIGHTS = np.array(
    [
        [0, 0, 0, 0, 0, 0],
        [1 / 5, 0, 0, 0, 0, 0],
        [3 / 40, 9 / 40, 0, 0, 0, 0],
        [44 / 45, -56 / 15, 32 / 9, 0, 0, 0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0, 0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0],
        [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
ERROR = np.array([71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
DENSE = np.array(
    [
        -12715105075 / 11282082432,
        0,
        87487479700 / 32700410799,
        -10690763975 / 1880347072,
        701980252875 / 199316789632,
        -1453857185 / 822651844,
        69997945 / 29380423,
    ]
)


@kernel
def stage_state(state: Floats, derivative: Floats, step: Floats, stage: int, count: int, result: Floats) -> None:
    """Write into result [6, lane] the state where a stage takes its derivative; stage 6 gives the end of the step."""
    for i in range(6):
        row = result[i]
        for j in range(count):
            row[j] = 0.0
        for m in range(stage):
            weight, rate = WEIGHTS[stage, m], derivative[m, i]
            for j in range(count):
                row[j] += weight * rate[j]
        for j in range(count):
            row[j] = state[i, j] + step[j] * row[j]


@kernel
def step_error(derivative: Floats, step: float, j: int, length: float, speed: float) -> float:
    """Largest error of lane j over its step, position in units of `length` [m], velocity of `speed` [m/s]."""
    worst = 0.0
    for i in range(6):
        total = 0.0
        for m in range(STAGES):
            total += ERROR[m] * derivative[m, i, j]
        error = abs(step * total) / (length if i < 3 else speed)
        if not error < np.inf:
            return np.nan
        worst = max(worst, error)
    return worst


@kernel
def next_step(step: float, error: float) -> float:
    """Step size whose error is expected to be just below 1."""
    if not error > 0.0:
        return step * 5.0 if error == 0.0 else step * 0.2
    return step * min(5.0, max(0.2, 0.9 * error**-0.2))


@kernel
def dense_coefficients(state: Floats, end: Floats, derivative: Floats, step: float, j: int, curve: Floats) -> None:
    """Write the coefficients curve [5, 6] of the polynomial of lane j between state and end [6, lane]."""
    for i in range(6):
        change = end[i, j] - state[i, j]
        bend = step * derivative[0, i, j] - change
        total = 0.0
        for m in range(STAGES):
            total += DENSE[m] * derivative[m, i, j]
        curve[0, i] = state[i, j]
        curve[1, i] = change
        curve[2, i] = bend
        curve[3, i] = change - step * derivative[6, i, j] - bend
        curve[4, i] = step * total


@kernel
def dense_output(curve: Floats, fraction: float, i: int) -> float:
    """Component i of the state at a fraction of the step."""
    remaining = 1.0 - fraction
    inner = curve[3, i] + remaining * curve[4, i]
    value: float = curve[0, i] + fraction * (curve[1, i] + remaining * (curve[2, i] + fraction * inner))
    return value
