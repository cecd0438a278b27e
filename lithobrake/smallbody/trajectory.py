"""Flights in lanes: each has its own time and step, all share the passes over the facets.

A lane whose flight has ended takes the next of the queue; when the queue is empty the last lane moves into its place.
No number of one lane enters another, so a flight does not depend on its company.
"""

from typing import Any

import numpy as np

from lithobrake.compiled import compiled
from lithobrake.smallbody.attraction import attract, workspace
from lithobrake.smallbody.dormand_prince import STAGES, interpolate, next_step, stage_state, step_error
from lithobrake.smallbody.dormand_prince import along as along_curve
from lithobrake.smallbody.impact import find_impact
from lithobrake.smallbody.lanes import LANES
from lithobrake.smallbody.polyhedron import PULL_X, ROWS

FLYING, IMPACT, ESCAPED, FAILED = 0, 1, 2, 3


@compiled
def accelerate(state: Any, slope: Any, stage: int, count: int, lane: Any, scratch: Any, forces: Any) -> None:
    """Write slope [stage, 6, lane] of state [6, lane] in the turning frame: gravity, centrifugal and Coriolis
    acceleration.

    forces: (gravity arrays, G density [1/s2], spin rate [rad/s]); lane and scratch are overwritten.
    """
    gravity, strength, spin = forces
    for i in range(3):
        for j in range(count):
            lane[i * LANES + j] = state[i, j]
    attract(lane, count, scratch, gravity)
    for j in range(count):
        for i in range(3):
            slope[stage, i, j] = state[3 + i, j]
            slope[stage, 3 + i, j] = strength * lane[(PULL_X + i) * LANES + j]
        slope[stage, 3, j] += spin * (spin * state[0, j] + 2.0 * state[4, j])
        slope[stage, 4, j] += spin * (spin * state[1, j] - 2.0 * state[3, j])


@compiled
def has_escaped(state: Any, j: int, parameter: float, spin: float, radius: float) -> bool:
    """Farther out than radius [m], moving outwards, with positive two-body energy in the inertial frame."""
    x, y, z = state[0, j], state[1, j], state[2, j]
    u, v, w = state[3, j] - spin * y, state[4, j] + spin * x, state[5, j]
    r = np.sqrt(x * x + y * y + z * z)
    outward = x * u + y * v + z * w > 0.0
    return r > radius and outward and 0.5 * (u * u + v * v + w * w) > parameter / r


@compiled
def _move(state: Any, slope: Any, step: Any, clock: Any, flight: Any, source: int, target: int) -> None:
    """Copy one lane onto another."""
    for i in range(6):
        state[i, target] = state[i, source]
        slope[0, i, target] = slope[0, i, source]
    step[target], clock[target], flight[target] = step[source], clock[source], flight[source]


@compiled
def _begin(starts: Any, f: int, state: Any, slope: Any, step: Any, clock: Any, flight: Any, j: int) -> None:
    """Put flight f into lane j, at a step of zero: its first pass gives its first slope."""
    flight[j], clock[j], step[j] = f, 0.0, 0.0
    for i in range(6):
        state[i, j] = starts[f, i]
        # Zero times what another flight left here need not be zero.
        for stage in range(STAGES):
            slope[stage, i, j] = 0.0


@compiled
def _shift(slope: Any, j: int) -> None:
    """The last slope of lane j's step is the first of its next."""
    for i in range(6):
        slope[0, i, j] = slope[6, i, j]


@compiled
def fly_lanes(starts: Any, phase: Any, duration: Any, forces: Any, ground: Any, limits: Any, out: Any) -> None:
    """Fly all starts [count, 6] to their ends.

    duration  [s], [count]
    phase     [count], read and written: whether the flight has left the surface (see impact)
    limits    (length error [m] and speed error [m/s] of a step, first step [s], escape radius [m], G mass [m3/s2])
    out       written: (status [count], time [s] [count], state [count, 6], facet [count], steps [count])
    """
    length, speed, first_step, radius, parameter = limits
    status, time, final, touched, steps = out
    state, end, slope = np.empty((6, LANES)), np.empty((6, LANES)), np.empty((STAGES, 6, LANES))
    step, clock, flight = np.empty(LANES), np.empty(LANES), np.empty(LANES, dtype=np.int64)
    lane, scratch, curve = np.zeros(ROWS * LANES), workspace(len(forces[0][0][0])), np.empty((5, 6))
    active = queued = 0
    for j in range(min(LANES, len(starts))):
        _begin(starts, queued, state, slope, step, clock, flight, j)
        active, queued = active + 1, queued + 1
    while active > 0:
        for stage in range(1, STAGES):
            stage_state(state, slope, step, stage, active, end)
            accelerate(end, slope, stage, active, lane, scratch, forces)
        for j in range(active - 1, -1, -1):
            f = flight[j]
            if step[j] == 0.0:
                _shift(slope, j)
                step[j] = min(first_step, duration[f])
                continue
            steps[f] += 1
            error = step_error(slope, step[j], j, length, speed)
            taken, last = step[j], step[j] >= duration[f] - clock[j]
            step[j] = next_step(taken, error)
            if not error <= 1.0:
                if clock[j] + step[j] > clock[j] and steps[f] < 1_000_000:
                    continue
                status[f], share = FAILED, 0.0
            else:
                interpolate(state, end, slope, taken, j, curve)
                share, touched[f], phase[f] = find_impact(curve, slope, taken, j, phase[f], ground)
                status[f] = IMPACT if touched[f] >= 0 else FLYING
                if status[f] == FLYING and has_escaped(end, j, parameter, forces[2], radius):
                    status[f] = ESCAPED
                _shift(slope, j)
                for i in range(6):
                    state[i, j] = end[i, j]
                clock[j] = duration[f] if last else clock[j] + taken
                step[j] = min(step[j], duration[f] - clock[j])
                if status[f] == FLYING and not last:
                    continue
            # The flight is over.
            time[f] = clock[j]
            if status[f] == IMPACT:
                time[f] -= (1.0 - share) * taken
            for i in range(6):
                final[f, i] = along_curve(curve, share, i) if status[f] == IMPACT else state[i, j]
            if queued < len(starts):
                _begin(starts, queued, state, slope, step, clock, flight, j)
                queued += 1
            else:
                active -= 1
                _move(state, slope, step, clock, flight, active, j)
