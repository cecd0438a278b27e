"""Flights in lanes: each has its own time and step, all share the passes over the facets.

A lane whose flight has ended takes the next of the queue; when the queue is empty the last lane moves into its place.
No number of one lane enters another, so a flight does not depend on its company.
"""

from typing import NamedTuple

import numpy as np

from lithobrake.compiled import compiled, kernel, large_kernel
from lithobrake.smallbody.acceleration import Forces, accelerate, has_escaped
from lithobrake.smallbody.arrays import Floats, Integers
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
from lithobrake.smallbody.impact import Ground, find_impact
from lithobrake.smallbody.orbit import Motion, motion_over
from lithobrake.smallbody.polyhedron import ROWS
from lithobrake.smallbody.simd import LANES

FLYING, IMPACT, ESCAPED, PARTNER, FAILED = range(5)  # the first four in the order of FlightStatus


class Lanes(NamedTuple):
    """The flights that are under way."""

    state: Floats  # [6, LANES], m and m/s
    derivative: Floats  # [STAGES, 6, LANES], of each stage
    step: Floats  # [LANES], s
    clock: Floats  # [LANES], s since the start
    flight: Integers  # [LANES], which flight it is


class FlightEnds(NamedTuple):
    """How flights ended, written by integrate_flights."""

    status: Integers  # [flight_count]
    time: Floats  # [flight_count], s since the start
    state: Floats  # [flight_count, 6], m and m/s
    facet: Integers  # [flight_count], -1: none
    step_count: Integers  # [flight_count]

    def of_flights(self, piece: slice) -> "FlightEnds":
        """Views of those of some flights."""
        return FlightEnds(
            self.status[piece], self.time[piece], self.state[piece], self.facet[piece], self.step_count[piece]
        )


@kernel
def _copy_lane(lanes: Lanes, source: int, target: int) -> None:
    """Copy one lane onto another."""
    for i in range(6):
        lanes.state[i, target] = lanes.state[i, source]
        lanes.derivative[0, i, target] = lanes.derivative[0, i, source]
    lanes.step[target], lanes.clock[target] = lanes.step[source], lanes.clock[source]
    lanes.flight[target] = lanes.flight[source]


@kernel
def _fill_lane(lanes: Lanes, j: int, starts: Floats, f: int) -> None:
    """Put flight f into lane j, at a step of zero: its first pass gives its first derivative."""
    lanes.flight[j], lanes.clock[j], lanes.step[j] = f, 0.0, 0.0
    for i in range(6):
        lanes.state[i, j] = starts[f, i]
        # Zero times what another flight left here need not be zero.
        for stage in range(STAGES):
            lanes.derivative[stage, i, j] = 0.0


@kernel
def _reuse_last_derivative(derivative: Floats, j: int) -> None:
    """The last derivative of lane j's step is the first of its next."""
    for i in range(6):
        derivative[0, i, j] = derivative[6, i, j]


@large_kernel
def _first_impact(
    curve: Floats,
    derivative: Floats,
    step: float,
    j: int,
    phase: Integers,
    grounds: tuple[Ground, Ground],
    motion: Motion,
    room: Floats,
) -> tuple[float, int, int]:
    """Fraction of lane j's step [s] at which it ends on the ground, the facet, and the status.

    phase [2] of this flight, for the body and its partner, is read and written (see impact); motion: of the partner.
    """
    ground, partner_ground = grounds
    still = Motion(0.0, 0.0, 0.0, 0.0, 0.0)
    fraction, facet, phase[0] = find_impact(curve, derivative, step, j, phase[0], ground, still, room)
    status = IMPACT if facet >= 0 else FLYING
    if motion.distance > 0.0:
        partner_fraction, partner_facet, phase[1] = find_impact(
            curve, derivative, step, j, phase[1], partner_ground, motion, room
        )
        if partner_facet >= 0 and partner_fraction < fraction:
            return partner_fraction, partner_facet, PARTNER
    return fraction, facet, status


@compiled
def integrate_flights(
    starts: Floats,
    begin: Floats,
    duration: Floats,
    phase: Integers,
    forces: Forces,
    grounds: tuple[Ground, Ground],
    ends: FlightEnds,
) -> None:
    """Fly all starts [count, 6] to their ends.

    begin     time at the start [s], [count]; duration [s], [count]
    phase     [count, 2], read and written: whether the flight has left the body, the partner (see impact)
    grounds   of the body and its partner
    ends      written
    """
    dynamics = forces.dynamics
    status, time, final, touched, steps = ends
    lanes = Lanes(
        np.empty((6, LANES)),
        np.empty((STAGES, 6, LANES)),
        np.empty(LANES),
        np.empty(LANES),
        np.empty(LANES, dtype=np.int64),
    )
    state, derivative, step, clock, flight = lanes
    end, when = np.empty((6, LANES)), np.empty(LANES)
    lane, curve, room = np.zeros(ROWS * LANES), np.empty((5, 6)), np.empty((3, 3))
    scratch = workspace(max(len(forces.gravity.polyhedron.vertices), len(forces.partner_gravity.polyhedron.vertices)))
    active = queued = 0
    for j in range(min(LANES, len(starts))):
        _fill_lane(lanes, j, starts, queued)
        active, queued = active + 1, queued + 1
    while active > 0:
        for stage in range(1, STAGES):
            stage_state(state, derivative, step, stage, active, end)
            for j in range(active):
                when[j] = begin[flight[j]] + clock[j] + NODES[stage] * step[j]
            accelerate(end, derivative, stage, active, lane, scratch, forces, when, flight)
        for j in range(active - 1, -1, -1):
            f = flight[j]
            if step[j] == 0.0:
                _reuse_last_derivative(derivative, j)
                step[j] = min(dynamics.first_step[f], duration[f])
                continue
            steps[f] += 1
            error = step_error(derivative, step[j], j, dynamics.length_tolerance[f], dynamics.speed_tolerance[f])
            taken, last = step[j], step[j] >= duration[f] - clock[j]
            step[j] = next_step(taken, error)
            if not error <= 1.0:
                if clock[j] + step[j] > clock[j] and steps[f] < 1_000_000:
                    continue
                status[f], fraction = FAILED, 0.0
            else:
                dense_coefficients(state, end, derivative, taken, j, curve)
                motion = motion_over(dynamics.orbit, f, begin[f] + clock[j], taken)
                fraction, touched[f], status[f] = _first_impact(
                    curve, derivative, taken, j, phase[f], grounds, motion, room
                )
                if status[f] == FLYING and has_escaped(end, j, dynamics, f, when[j]):
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
                _fill_lane(lanes, j, starts, queued)
                queued += 1
            else:
                active -= 1
                _copy_lane(lanes, active, j)
