"""Flights in lanes: each has its own time and step, all share the passes over the facets.

A lane whose flight has ended takes the next of the queue; when the queue is empty the last lane moves into its place.
No number of one lane enters another, so a flight does not depend on its company.
"""

from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import compiled, kernel, large_kernel
from lithobrake.smallbody.acceleration import Forces, Motion, accelerate, has_escaped, motion_over, own_motion
from lithobrake.smallbody.attraction import Workspace, workspace
from lithobrake.smallbody.impact_search import (
    NODES,
    STAGES,
    Ground,
    dense_coefficients,
    dense_output,
    find_impact,
    next_step,
    stage_state,
    step_error,
)
from lithobrake.smallbody.polyhedron_gravity import ROWS
from lithobrake.smallbody.simd import LANES
from lithobrake.vocabulary.array_types import Floats, Integers

FLYING, IMPACT, ESCAPED, PARTNER, FAILED = range(5)  # the first four in the order of FlightStatus
# Of a flight: some 40 000 circuits near the surface at the default tolerance, years about a body of a kilometre.
MOST_STEPS = 1_000_000


class Lanes(NamedTuple):
    state: Floats  # [6, LANES], m and m/s
    derivative: Floats  # [STAGES, 6, LANES], of each stage
    step: Floats  # [LANES], s
    clock: Floats  # [LANES], s since the start
    flight: Integers  # [LANES], which flight it is


class StepRoom(NamedTuple):
    """What a step of the lanes is worked out in; overwritten by the next."""

    end: Floats  # [6, LANES], state at the end of the step, m and m/s
    when: Floats  # [LANES], time of the last stage, s
    curve: Floats  # [5, 6], see dense_coefficients
    frame: Floats  # [3, 3], see find_impact


class FlightEnds(NamedTuple):
    status: Integers  # [flight_count]
    time: Floats  # [flight_count], s since the start
    state: Floats  # [flight_count, 6], m and m/s
    facet: Integers  # [flight_count], -1: none
    step_count: Integers  # [flight_count]

    @classmethod
    def of_count(cls, count: int) -> "FlightEnds":
        """Room for so many, none of which has hit anything."""
        numbers = np.zeros(count, dtype=np.int64), np.zeros(count), np.zeros((count, 6)), np.full(count, -1)
        return cls(*numbers, np.zeros(count, dtype=np.int64))

    def put(self, which: Integers, others: "FlightEnds") -> None:
        """Put others in the places `which`."""
        for mine, theirs in zip(self, others, strict=True):
            mine[which] = theirs


@kernel
def _copy_lane(lanes: Lanes, source: int, target: int) -> None:
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
    motions: tuple[Motion, Motion],
    room: Floats,
) -> tuple[float, int, int]:
    """Fraction of lane j's step [s] at which it ends on the ground, the facet, and the status.

    phase [2] of this flight, for the body and its partner, is read and written (see impact_search); motions: of both.
    """
    ground, partner_ground = grounds
    own, motion = motions
    fraction, facet, phase[0] = find_impact(curve, derivative, step, j, phase[0], ground, own, room)
    status = IMPACT if facet >= 0 else FLYING
    if motion.distance > 0.0:
        partner_fraction, partner_facet, phase[1] = find_impact(
            curve, derivative, step, j, phase[1], partner_ground, motion, room
        )
        if partner_facet >= 0 and partner_fraction < fraction:
            return partner_fraction, partner_facet, PARTNER
    return fraction, facet, status


@compiled
def _new_lanes() -> Lanes:
    return Lanes(
        np.empty((6, LANES)),
        np.empty((STAGES, 6, LANES)),
        np.empty(LANES),
        np.empty(LANES),
        np.empty(LANES, dtype=np.int64),
    )


@kernel
def _pass_stages(
    lanes: Lanes, active: int, begin: Floats, forces: Forces, room: StepRoom, lane: Floats, scratch: Workspace
) -> None:
    """Take all stages of a step of the active lanes. Writes to lanes and room; lane and scratch: see accelerate."""
    state, derivative, step, clock, flight = lanes
    for stage in range(1, STAGES):
        stage_state(state, derivative, step, stage, active, room.end)
        for j in range(active):
            room.when[j] = begin[flight[j]] + clock[j] + NODES[stage] * step[j]
        accelerate(room.end, derivative, stage, active, lane, scratch, forces, room.when, flight)


@kernel
def _write_end(lanes: Lanes, j: int, curve: Floats, fraction: float, taken: float, ends: FlightEnds) -> None:
    """Write where lane j's flight ended: at a fraction of the step of `taken` [s] on a facet, else where it is."""
    f = lanes.flight[j]
    hit = ends.facet[f] >= 0
    ends.time[f] = lanes.clock[j]
    if hit:
        ends.time[f] -= (1.0 - fraction) * taken
    for i in range(6):
        ends.state[f, i] = dense_output(curve, fraction, i) if hit else lanes.state[i, j]


@kernel
def _finish_step(
    lanes: Lanes,
    j: int,
    begin: Floats,
    duration: Floats,
    phase: Integers,
    forces: Forces,
    grounds: tuple[Ground, Ground],
    room: StepRoom,
    ends: FlightEnds,
) -> bool:
    """Take lane j's step, or make it shorter; whether its flight is over, which is then written to ends."""
    state, derivative, step, clock, flight = lanes
    f, dynamics, turning = flight[j], forces.dynamics, forces.turning
    if step[j] == 0.0:
        _reuse_last_derivative(derivative, j)
        step[j] = min(dynamics.first_step[f], duration[f])
        return False
    ends.step_count[f] += 1
    error = step_error(derivative, step[j], j, dynamics.length_tolerance[f], dynamics.speed_tolerance[f])
    taken, last = step[j], step[j] >= duration[f] - clock[j]
    step[j] = next_step(taken, error)
    # Written so that an error that is no number refuses the step.
    if not error <= 1.0:
        # A step that no longer moves the clock would be tried without end.
        if clock[j] + step[j] > clock[j] and ends.step_count[f] < MOST_STEPS:
            return False
        ends.status[f] = FAILED
        _write_end(lanes, j, room.curve, 0.0, taken, ends)
        return True
    dense_coefficients(state, room.end, derivative, taken, j, room.curve)
    time = begin[f] + clock[j]
    motions = own_motion(turning, time, taken), motion_over(dynamics.orbit, f, turning, time, taken)
    fraction, ends.facet[f], ends.status[f] = _first_impact(
        room.curve, derivative, taken, j, phase[f], grounds, motions, room.frame
    )
    # The last stage is that of the end of the step, and `when` still holds its time.
    if ends.status[f] == FLYING and has_escaped(room.end, j, dynamics, f, room.when[j]):
        ends.status[f] = ESCAPED
    _reuse_last_derivative(derivative, j)
    for i in range(6):
        state[i, j] = room.end[i, j]
    # The end of the time is met to the last bit, which no sum of steps does.
    clock[j] = duration[f] if last else clock[j] + taken
    step[j] = min(step[j], duration[f] - clock[j])
    if ends.status[f] == FLYING and not last:
        if ends.step_count[f] < MOST_STEPS:
            return False
        ends.status[f] = FAILED
    _write_end(lanes, j, room.curve, fraction, taken, ends)
    return True


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
    phase     [count, 2], read and written: whether the flight has left the body, the partner (see impact_search)
    grounds   of the body and its partner
    ends      written
    """
    lanes = _new_lanes()
    room = StepRoom(np.empty((6, LANES)), np.empty(LANES), np.empty((5, 6)), np.empty((3, 3)))
    lane = np.zeros(ROWS * LANES)
    # One workspace for both bodies, with room for the vertices of the larger one.
    scratch = workspace(max(len(forces.gravity.polyhedron.vertices), len(forces.partner_gravity.polyhedron.vertices)))
    active = queued = 0
    for j in range(min(LANES, len(starts))):
        _fill_lane(lanes, j, starts, queued)
        active, queued = active + 1, queued + 1
    while active > 0:
        _pass_stages(lanes, active, begin, forces, room, lane, scratch)
        # From the last lane down: the one that moves into a free place has had its turn in this pass.
        for j in range(active - 1, -1, -1):
            if not _finish_step(lanes, j, begin, duration, phase, forces, grounds, room, ends):
                continue
            if queued < len(starts):
                _fill_lane(lanes, j, starts, queued)
                queued += 1
            else:
                active -= 1
                _copy_lane(lanes, active, j)
