"""When and where a flight meets the ground within one step of Dormand and Prince's pair 5(4)."""

from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.smallbody.acceleration import Motion, into_ground
from lithobrake.smallbody.facet_grid import Grid, clearance, first_entry, height_near
from lithobrake.smallbody.rotation import Turning
from lithobrake.vocabulary.array_types import Floats

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
ON_SURFACE, ALOFT = 0, 1
# Halvings of a fraction of the step, down to its rounding.
BISECTIONS = 48
SAGITTA = 5.0  # slacks by which a chord may leave the curve: a graze not deeper than that may be passed over


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
        # A maximum would pass over NaN, and the step would be taken.
        if not error < np.inf:
            return np.nan
        worst = max(worst, error)
    return worst


@kernel
def next_step(step: float, error: float) -> float:
    # NaN gives a fifth of the step, whose error may be a number again.
    if not error > 0.0:
        return step * 5.0 if error == 0.0 else step * 0.2
    # The error of the pair goes with the fifth power of the step; with a tenth to spare few steps are refused.
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
    remaining = 1.0 - fraction
    inner = curve[3, i] + remaining * curve[4, i]
    value: float = curve[0, i] + fraction * (curve[1, i] + remaining * (curve[2, i] + fraction * inner))
    return value


class Ground(NamedTuple):
    """What a flight may hit: a surface in its own frame."""

    grid: Grid
    corners: Floats  # [facet_count, 3, 3], vertices of the facets [m]
    pseudonormals: Floats  # [facet_count, 7, 3], see signed_distance
    slack: float  # distance [m] that counts as none
    radius: float  # of the farthest vertex [m]


@kernel
def _position_at(curve: Floats, fraction: float, motion: Motion, point: Floats) -> None:
    """Write the position [m] at a fraction of the step, in the frame of the ground."""
    for i in range(3):
        point[i] = dense_output(curve, fraction, i)
    into_ground(point, motion, fraction)


@kernel
def _motion_bounds(curve: Floats, derivative: Floats, step: float, j: int, motion: Motion) -> tuple[float, float]:
    """Larger speed of the two ends [m/s], and a bound of the acceleration [m/s2], over lane j's step of `step` [s].

    Half as much again as the largest of seven stages stands for the largest acceleration.
    """
    acceleration = 0.0
    for m in range(len(derivative)):
        acceleration = max(acceleration, derivative[m, 3, j] ** 2 + derivative[m, 4, j] ** 2 + derivative[m, 5, j] ** 2)
    acceleration = 1.5 * np.sqrt(acceleration)
    pace = reach = 0.0
    distance, rate, swing = motion.distance, motion.turn / step, motion.swing / step
    for fraction in (0.0, 1.0):
        x, y = dense_output(curve, fraction, 0), dense_output(curve, fraction, 1)
        u, v = dense_output(curve, fraction, 3), dense_output(curve, fraction, 4)
        if distance > 0.0:
            # Against the partner's ground: less the motion of its centre, less the turning about it.
            place = motion.angle + fraction * motion.turn
            centre_x, centre_y = distance * np.cos(place), distance * np.sin(place)
            x, y = x - centre_x, y - centre_y
            u, v = u + rate * centre_y + swing * y, v - rate * centre_x - swing * x
        pace = max(pace, u * u + v * v + dense_output(curve, fraction, 5) ** 2)
        reach = max(reach, x * x + y * y)
    pace = np.sqrt(pace)
    if distance == 0.0 and motion.turning.rate > 0.0:
        return _turning_bounds(curve, acceleration, step, pace, motion.turning)
    if distance > 0.0:
        # Between the ends place and speed are those there and what the acceleration may add.
        reach = np.sqrt(reach) + 0.125 * acceleration * step * step
        acceleration += distance * rate * rate + abs(swing) * (2.0 * pace + abs(swing) * reach)
        acceleration *= 1.0 + abs(swing) * step
    return pace, acceleration


@kernel
def _turning_bounds(
    curve: Floats, acceleration: float, step: float, pace: float, turning: Turning
) -> tuple[float, float]:
    """The same two numbers as seen from a body that turns against the frame, from those in the frame."""
    reach = 0.0
    for fraction in (0.0, 1.0):
        square = 0.0
        for i in range(3):
            square += dense_output(curve, fraction, i) ** 2
        reach = max(reach, square)
    reach = np.sqrt(reach) + 0.125 * acceleration * step * step
    fastest = pace + 0.5 * acceleration * step
    acceleration += turning.change * reach + turning.rate * (2.0 * fastest + turning.rate * reach)
    return pace + turning.rate * reach, acceleration


@kernel
def _closest_approach(here: Floats, there: Floats) -> float:
    """Smallest distance [m] of the straight line between two points from the origin."""
    along_line = square = 0.0
    for i in range(3):
        along_line -= here[i] * (there[i] - here[i])
        square += (there[i] - here[i]) ** 2
    fraction = min(max(along_line / square, 0.0), 1.0) if square > 0.0 else 0.0
    nearest = 0.0
    for i in range(3):
        nearest += (here[i] + fraction * (there[i] - here[i])) ** 2
    return np.sqrt(nearest)


@large_kernel
def _fraction_at_plane(
    curve: Floats, ground: Ground, motion: Motion, facet: int, point: Floats, low: float, high: float
) -> float:
    corner, outward = ground.corners, ground.pseudonormals
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        _position_at(curve, middle, motion, point)
        height = 0.0
        for i in range(3):
            height += outward[facet, 0, i] * (point[i] - corner[facet, 0, i])
        if height > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


@large_kernel
def _fraction_at_surface(
    curve: Floats, ground: Ground, motion: Motion, point: Floats, low: float, high: float
) -> tuple[float, int]:
    """Fraction between low (above) and high (below) at which the height is zero, and the facet there."""
    facet = -1
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        _position_at(curve, middle, motion, point)
        height, facet = height_near(ground.grid, ground.corners, ground.pseudonormals, point)
        if height > 0.0:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high), facet


@kernel
def _chord_limits(ground: Ground, pace: float, acceleration: float, step: float) -> tuple[float, float]:
    """Largest speed [m/s] of a step [s], and the longest time [s] of a chord near the surface."""
    fastest = pace + 0.5 * acceleration * step
    # Half a cell keeps a chord among few cells; the sagitta of a chord of time t is at most acceleration t**2 / 8.
    longest = min(
        np.sqrt(8.0 * SAGITTA * ground.slack / acceleration) if acceleration > 0.0 else step,
        0.5 * ground.grid.edge / fastest if fastest > 0.0 else step,
    )
    return fastest, longest


@kernel
def _sink(curve: Floats, ground: Ground, motion: Motion, there: Floats, fraction: float) -> tuple[float, int]:
    """Height [m] at a fraction of the step, and the facet there if that is below the surface, else -1. Writes there."""
    _position_at(curve, fraction, motion, there)
    height, facet = height_near(ground.grid, ground.corners, ground.pseudonormals, there)
    return height, facet if height < -ground.slack else -1


@kernel
def _entered_facet(ground: Ground, here: Floats, there: Floats, chord: Floats) -> int:
    """First facet that the chord between two points enters from outside, -1: none. Writes chord."""
    for i in range(3):
        chord[i] = there[i] - here[i]
    return first_entry(ground.grid, ground.corners, here, chord)[1]


@large_kernel
def find_impact(
    curve: Floats, derivative: Floats, step: float, j: int, phase: int, ground: Ground, motion: Motion, room: Floats
) -> tuple[float, int, int]:
    """Fraction of lane j's step [step s] at which it meets the ground, the facet (-1: it does not), and the phase after
    it.

    room [3, 3] is scratch.
    """
    grid, slack = ground.grid, ground.slack
    here, there, chord = room[0], room[1], room[2]
    pace, acceleration = _motion_bounds(curve, derivative, step, j, motion)
    _position_at(curve, 0.0, motion, here)
    if phase == ALOFT:
        _position_at(curve, 1.0, motion, there)
        # A step that clears the sphere around the body needs no look at its facets, as most do against a partner.
        if _closest_approach(here, there) > ground.radius + 0.125 * acceleration * step * step:
            return 1.0, -1, phase
    fastest, longest = _chord_limits(ground, pace, acceleration, step)
    # A lander on the ground may turn back at once, so the first looks are a few slacks apart.
    stride = min(longest, 4.0 * slack / pace) if pace > 0.0 else longest
    time, height = 0.0, 0.0
    if phase == ON_SURFACE:
        height = height_near(grid, ground.corners, ground.pseudonormals, here)[0]
    while time < step:
        if phase == ON_SURFACE:
            until = min(time + stride, step)
            height_there, facet = _sink(curve, ground, motion, there, until / step)
            if facet >= 0:
                if height > 0.0:
                    fraction, facet = _fraction_at_surface(curve, ground, motion, there, time / step, until / step)
                    return fraction, facet, phase
                return time / step, facet, phase
            if height_there > slack:
                phase = ALOFT
            height = height_there
            stride = min(2.0 * stride, longest)
        else:
            gap = clearance(grid, here[0], here[1], here[2])
            until = min(time + (gap / fastest if gap > 0.0 else longest), step)
            _position_at(curve, until / step, motion, there)
            # A chord within the clearance of its beginning meets no facet, so none is looked at.
            facet = _entered_facet(ground, here, there, chord) if gap == 0.0 else -1
            if facet >= 0:
                fraction = _fraction_at_plane(curve, ground, motion, facet, there, time / step, until / step)
                return fraction, facet, phase
        time = until
        for i in range(3):
            here[i] = there[i]
    return 1.0, -1, phase
