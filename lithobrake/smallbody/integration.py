"""Flights in lanes: each has its own time and step, all share the passes over the facets.

A lane whose flight has ended takes the next of the queue; when the queue is empty the last lane moves into its place.
No number of one lane enters another, so a flight does not depend on its company.
"""

from typing import Any

import numpy as np

from lithobrake.compiled import compiled, kernel, large_kernel
from lithobrake.smallbody.acceleration import FIRST_STEP, LENGTH, ORBIT, SPEED, accelerate, has_escaped
from lithobrake.smallbody.attraction import workspace
from lithobrake.smallbody.dormand_prince import (
    NODES,
    STAGES,
    dense_coefficients,
    dense_output,
    next_step,
    stage_state,
    step_error,
)
from lithobrake.smallbody.impact import find_impact
from lithobrake.smallbody.orbit import motion_over
from lithobrake.smallbody.polyhedron import ROWS
from lithobrake.smallbody.simd import LANES

FLYING, IMPACT, ESCAPED, PARTNER, FAILED = 0, 1, 2, 3, 4


@kernel
def _copy_lane(state: Any, derivative: Any, step: Any, clock: Any, flight: Any, source: int, target: int) -> None:
    """Copy one lane onto another."""
    for i in range(6):
        state[i, target] = state[i, source]
        derivative[0, i, target] = derivative[0, i, source]
    step[target], clock[target], flight[target] = step[source], clock[source], flight[source]


@kernel
def _fill_lane(starts: Any, f: int, state: Any, derivative: Any, step: Any, clock: Any, flight: Any, j: int) -> None:
    """Put flight f into lane j, at a step of zero: its first pass gives its first derivative."""
    flight[j], clock[j], step[j] = f, 0.0, 0.0
    for i in range(6):
        state[i, j] = starts[f, i]
        # Zero times what another flight left here need not be zero.
        for stage in range(STAGES):
            derivative[stage, i, j] = 0.0


@kernel
def _reuse_last_derivative(derivative: Any, j: int) -> None:
    """The last derivative of lane j's step is the first of its next."""
    for i in range(6):
        derivative[0, i, j] = derivative[6, i, j]


@large_kernel
def _first_impact(
    curve: Any, derivative: Any, step: float, j: int, phase: Any, grounds: Any, orbit: Any, time: float, room: Any
) -> Any:
    """Fraction of lane j's step, begun at `time` [s], at which it ends on the ground, the facet, and the status.

    phase [2] of this flight, for the body and its partner, is read and written (see impact).
    """
    still = (0.0, 0.0, 0.0, 0.0, 0.0)
    fraction, facet, phase[0] = find_impact(curve, derivative, step, j, phase[0], grounds[0], still, room)
    status = IMPACT if facet >= 0 else FLYING
    if orbit[0] > 0.0:
        motion = motion_over(orbit, time, step)
        partner_fraction, partner_facet, phase[1] = find_impact(
            curve, derivative, step, j, phase[1], grounds[1], motion, room
        )
        if partner_facet >= 0 and partner_fraction < fraction:
            return partner_fraction, partner_facet, PARTNER
    return fraction, facet, status


@compiled
def integrate_flights(starts: Any, begin: Any, duration: Any, phase: Any, forces: Any, grounds: Any, out: Any) -> None:
    """Fly all starts [count, 6] to their ends.

    begin     time at the start [s], [count]; duration [s], [count]
    phase     [count, 2], read and written: whether the flight has left the body, the partner (see impact)
    forces    see acceleration; one row of worlds a flight
    grounds   of the body and its partner, each as in impact
    out       written: (status [count], time [s] [count], state [count, 6], facet [count], steps [count])
    """
    worlds = forces[2]
    status, time, final, touched, steps = out
    state, end, derivative = np.empty((6, LANES)), np.empty((6, LANES)), np.empty((STAGES, 6, LANES))
    step, clock, flight, when = np.empty(LANES), np.empty(LANES), np.empty(LANES, dtype=np.int64), np.empty(LANES)
    lane, curve, room = np.zeros(ROWS * LANES), np.empty((5, 6)), np.empty((3, 3))
    scratch = workspace(max(len(forces[0][0][0]), len(forces[1][0][0])))
    active = queued = 0
    for j in range(min(LANES, len(starts))):
        _fill_lane(starts, queued, state, derivative, step, clock, flight, j)
        active, queued = active + 1, queued + 1
    while active > 0:
        for stage in range(1, STAGES):
            stage_state(state, derivative, step, stage, active, end)
            for j in range(active):
                when[j] = begin[flight[j]] + clock[j] + NODES[stage] * step[j]
            accelerate(end, derivative, stage, active, lane, scratch, forces, when, flight)
        for j in range(active - 1, -1, -1):
            f = flight[j]
            world = worlds[f]
            if step[j] == 0.0:
                _reuse_last_derivative(derivative, j)
                step[j] = min(world[FIRST_STEP], duration[f])
                continue
            steps[f] += 1
            error = step_error(derivative, step[j], j, world[LENGTH], world[SPEED])
            taken, last = step[j], step[j] >= duration[f] - clock[j]
            step[j] = next_step(taken, error)
            if not error <= 1.0:
                if clock[j] + step[j] > clock[j] and steps[f] < 1_000_000:
                    continue
                status[f], fraction = FAILED, 0.0
            else:
                dense_coefficients(state, end, derivative, taken, j, curve)
                fraction, touched[f], status[f] = _first_impact(
                    curve, derivative, taken, j, phase[f], grounds, world[ORBIT:], begin[f] + clock[j], room
                )
                if status[f] == FLYING and has_escaped(end, j, world, when[j]):
                    status[f] = ESCAPED
                _reuse_last_derivative(derivative, j)
                for i in range(6):
                    state[i, j] = end[i, j]
                clock[j] = duration[f] if last else clock[j] + taken
                step[j] = min(step[j], duration[f] - clock[j])
                if status[f] == FLYING and not last:
                    continue
            # The flight is over.
            time[f] = clock[j]
            if touched[f] >= 0:
                time[f] -= (1.0 - fraction) * taken
            for i in range(6):
                final[f, i] = dense_output(curve, fraction, i) if touched[f] >= 0 else state[i, j]
            if queued < len(starts):
                _fill_lane(starts, queued, state, derivative, step, clock, flight, j)
                queued += 1
            else:
                active -= 1
                _copy_lane(state, derivative, step, clock, flight, active, j)
