"""What is due next, and when a pair is to be looked at: a contact, or what could touch."""

from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Bodies, Pairs
from lithobrake.dem.bodies.vectors import arm_to, cross, dot, minus, plus, put, row, scaled
from lithobrake.dem.local_stepping.approach import Approach, closing_speed, time_to_close
from lithobrake.dem.local_stepping.cells import Cells
from lithobrake.dem.local_stepping.free_motion import (
    Flight,
    Rules,
    acceleration_of,
    relative_surge,
    relative_weight,
    surface_speed,
    surge_bound,
    swept,
    turning_rate,
    weight,
)
from lithobrake.dem.narrow_phase.feature_list import travelled
from lithobrake.vocabulary.array_types import Floats, Integers, Vector

# A body's pairs are planned anew when the speed of its surface has changed by this part of what it was.
# Of contacts and near pairs together, a smaller part has fewer looked at and more planned anew: with a tenth looks are
# 6 % fewer than with three tenths, and the energy of landings is kept half as well.
NOTED_CHANGE = 0.3
# The same of its acceleration, of which so much of gravity besides passes without notice.
NOTED_WEIGHT = 0.2
# A body on a joint swings to and fro. Its plans hold for free fall with so many times the acceleration that it has, or
# with this part of what they held for before: so a few swings are enough to find their size.
SWINGING, KEPT = 2.0, 0.5
# A contact keeps its step until the one that it should have is below, or above, these parts of it.
# Steps that follow the collision at every look are uneven, which costs a frictionless landing 5 % of its energy.
SHORTER, LONGER = 0.8, 2.0
# One that has become shorter by this factor does not wait for the next look.
URGENT = 0.5
# Time from first to deepest touch and back, over deepest overlap by speed: Hertz (1882), see time_step.py.
HERTZ_TIME = 2.943
# Fewer steps in a collision do not follow it.
FEWEST_STEPS = 5.0


class Agenda(NamedTuple):
    """A heap of items 0 to before capacity."""

    due: Floats  # [capacity], s
    heap: Integers  # [capacity], items, the first due in front
    place: Integers  # [capacity], where in the heap an item stands, -1: not in it
    size: Integers  # [1]


def new_agenda(capacity: int) -> Agenda:
    return Agenda(np.zeros(capacity), np.zeros(capacity, np.int64), np.full(capacity, -1), np.zeros(1, np.int64))


@kernel
def comes_before(agenda: Agenda, one: int, other: int) -> bool:
    a, b = agenda.due[one], agenda.due[other]
    return a < b or (a == b and one < other)


@kernel
def move_up(agenda: Agenda, item: int, place: int) -> int:
    """Move an item up from a place until what stands above comes before it; return its place. Writes to agenda."""
    while place > 0:
        above = (place - 1) >> 1
        other = agenda.heap[above]
        if comes_before(agenda, other, item):
            break
        agenda.heap[place], agenda.place[other] = other, place
        place = above
    agenda.heap[place], agenda.place[item] = item, place
    return place


@kernel
def move_down(agenda: Agenda, item: int, place: int) -> None:
    """Move an item down from a place until it comes before what stands below. Writes to agenda."""
    size = agenda.size[0]
    while True:
        below = 2 * place + 1
        if below >= size:
            break
        if below + 1 < size and comes_before(agenda, agenda.heap[below + 1], agenda.heap[below]):
            below += 1
        other = agenda.heap[below]
        if comes_before(agenda, item, other):
            break
        agenda.heap[place], agenda.place[other] = other, place
        place = below
    agenda.heap[place], agenda.place[item] = item, place


@kernel
def put_on(agenda: Agenda, item: int, time: float) -> None:
    """Make an item due at a time [s], whether it is on the agenda or not. Writes to agenda."""
    place = agenda.place[item]
    agenda.due[item] = time
    if place < 0:
        place = agenda.size[0]
        agenda.size[0] = place + 1
    if move_up(agenda, item, place) == place:
        move_down(agenda, item, place)


@kernel
def take_off(agenda: Agenda, item: int) -> None:
    """Take an item off the agenda, if it is on it. Writes to agenda."""
    place = agenda.place[item]
    if place < 0:
        return
    agenda.place[item] = -1
    last = agenda.size[0] - 1
    agenda.size[0] = last
    other = agenda.heap[last]
    if other != item and move_up(agenda, other, place) == place:
        move_down(agenda, other, place)


class Plans(NamedTuple):
    """Per slot for a pair, used or free."""

    last: Floats  # [pair_capacity], s, when it was last looked at
    interval: Floats  # [pair_capacity], s, from then until it is to be looked at again, where it touches; else 0
    inverse_mass: Floats  # [pair_capacity], 1/kg, that the contact meets, more where its damping is strong
    longest: Floats  # [pair_capacity], s, step at which sliding, tilting and damping are followed stably
    duration: Floats  # [pair_capacity], s (m/s)^(1/5), duration of a collision times the fifth root of its speed
    apart_until: Floats  # [pair_capacity], m, motion of both since the start before which listed features are apart
    apart: Floats  # [pair_capacity, 3], m, from the first's centroid to the second's, at the last look
    spin: Floats  # [pair_capacity, 2, 3], rad/s, of both after the last look
    link: Integers  # [2 pair_capacity], next entry in the list of the first's, and of the second's pairs; -1: none
    free: Integers  # [pair_capacity], slots that are free
    free_count: Integers  # [1]


class Schedule(NamedTuple):
    flight: Flight
    plans: Plans
    agenda: Agenda
    cells: Cells


@kernel
def steps_at(speed: float, flight: Flight, rules: Rules) -> float:
    """Return the number of steps in a collision that begins at a speed [m/s]: fewer in proportion where it is slow."""
    full = flight.resolved_speed[0]
    return rules.steps if speed >= full else max(FEWEST_STEPS, rules.steps * speed / full)


@kernel
def speed_with_fall(pair: int, pairs: Pairs, flight: Flight, plans: Plans, speed: float, rules: Rules) -> float:
    """Return a speed [m/s] at which a collision begins, with what gravity adds within it where that is all there is."""
    # The speed that gravity gives within the collision that begins with it: v = g t with t = duration v^(-1/5).
    acceleration = relative_weight(flight, pairs.first[pair], pairs.second[pair], rules)
    return speed + (acceleration * plans.duration[pair]) ** (5.0 / 6.0)


@kernel
def collision_step(pair: int, pairs: Pairs, flight: Flight, plans: Plans, speed: float, rules: Rules) -> float:
    """Return the step [s] of a contact that begins at a speed [m/s]; on what does not fall gravity adds to that."""
    speed = speed_with_fall(pair, pairs, flight, plans, speed, rules)
    return plans.duration[pair] * speed**-0.2 / steps_at(speed, flight, rules) if speed > 0.0 else np.inf


@kernel
def longest_step(pair: int, pairs: Pairs, flight: Flight, plans: Plans, rules: Rules) -> float:
    """Return the step [s] at which a contact follows whatever it may gain before its bodies are planned anew.

    An overlap that is only rounding has no energy, and by that a step in which its bodies fall through each other.
    """
    first, second = pairs.first[pair], pairs.second[pair]
    gain = flight.slack[first] + (flight.slack[second] if second >= 0 else 0.0)
    speed = speed_with_fall(pair, pairs, flight, plans, gain, rules)
    return plans.duration[pair] * speed**-0.2 / FEWEST_STEPS if speed > 0.0 else np.inf


@kernel
def contact_step(pair: int, bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, rules: Rules) -> float:
    """Return the step [s] of a contact: a part of the collision with the energy that it has now."""
    normal, overlap, elastic = row(pairs.normal, pair), pairs.overlap[pair], pairs.elastic_force[pair]
    speed = dot(closing_velocity(pair, bodies, pairs, plans), normal)
    inverse_mass = plans.inverse_mass[pair]
    # By the energy of the collision, and neither by overlap nor by speed, which change in the course of it: so the
    # steps of a collision stay even.
    energy = 0.4 * elastic * overlap + 0.5 * speed * speed / inverse_mass
    deepest = (2.5 * energy * overlap**1.5 / elastic) ** 0.4
    fastest = (2.0 * energy * inverse_mass) ** 0.5
    step = HERTZ_TIME * deepest / (fastest * steps_at(fastest, flight, rules))
    return min(step, longest_step(pair, pairs, flight, plans, rules), plans.longest[pair])


@kernel
def closing_velocity(pair: int, bodies: Bodies, pairs: Pairs, plans: Plans) -> Vector:
    """Return the velocity of the first against the second at their centre of pressure, spins as at the last look."""
    first, second, point = pairs.first[pair], pairs.second[pair], row(pairs.point, pair)
    arm = minus(point, row(bodies.position, first))
    velocity = plus(row(bodies.velocity, first), cross(row(plans.spin[pair], 0), arm))
    if second >= 0:
        arm = arm_to(bodies, second, point)
        velocity = minus(velocity, plus(row(bodies.velocity, second), cross(row(plans.spin[pair], 1), arm)))
    return velocity


@kernel
def way_since(bodies: Bodies, flight: Flight, body: int, now: float, rules: Rules) -> tuple[float, float]:
    """Return the way [m] of a body's surface up to now [s], and the speed [m/s] gained since it was moved, at most."""
    time = now - flight.time[body]
    gained = 0.0 if flight.held[body] else time * surge_bound(bodies, flight, body, rules)
    return bodies.travel[body] + time * (surface_speed(bodies, flight, body) + gained), gained


@kernel
def plan_apart(
    pair: int, bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, free: float, now: float,
    rules: Rules,
) -> None:  # fmt: skip
    """Make a pair due when it could touch first, wherever it is near; where features are listed, not before a step of
    what would come has passed since its last look.

    Writes to agenda. free: motion of both since the start [m] before which they do not touch. Only one of the two may
    have been moved to now [s].
    """
    first, second = pairs.first[pair], pairs.second[pair]
    way, gained = way_since(bodies, flight, first, now, rules)
    gap, speed = free - way, closing_speed(bodies, flight, first, second) + gained
    if second >= 0:
        way, gained = way_since(bodies, flight, second, now, rules)
        gap, speed = gap - way, speed + gained
    acceleration = relative_surge(bodies, flight, first, second, rules)
    due = now + (time_to_close(gap, speed, acceleration) if gap > 0.0 else 0.0)
    # What is apart by no more than rounding would be due at once, for ever, whenever its bodies are planned anew.
    if pairs.feature_count[pair] != 0:
        due = max(due, plans.last[pair] + collision_step(pair, pairs, flight, plans, speed, rules))
    put_on(agenda, len(bodies.mass) + pair, due)


@kernel
def plan_approach(
    pair: int, bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, approach: Approach,
    now: float, rules: Rules,
) -> None:  # fmt: skip
    """Make a pair due when its features could touch first, or a step of their contact later.

    Writes to plans and agenda.
    """
    plans.apart_until[pair] = travelled(bodies, pairs.first[pair], pairs.second[pair]) + approach.gap
    wait = max(approach.time, collision_step(pair, pairs, flight, plans, approach.speed, rules))
    put_on(agenda, len(bodies.mass) + pair, now + wait)


@kernel
def plan_search(bodies: Bodies, flight: Flight, agenda: Agenda, body: int, now: float, rules: Rules) -> None:
    """Make a body due when it could have left the reach of its list of neighbours. Writes to agenda."""
    left = 0.5 * rules.skin - (bodies.travel[body] - bodies.travel_listed[body])
    speed = surface_speed(bodies, flight, body) + flight.slack[body]
    surge = surge_bound(bodies, flight, body, rules)
    put_on(agenda, body, now + (time_to_close(left, speed, surge) if left > 0.0 else 0.0))


@kernel
def has_changed(bodies: Bodies, flight: Flight, body: int, now: float, rules: Rules) -> bool:
    """Tell whether contacts moved a body so that the plans of its pairs hold no longer."""
    time, mass, turning = now - flight.planned[body], bodies.inverse_mass[body], flight.turning[body]
    force, torque = row(flight.force, body), row(flight.torque, body)
    expected = plus(row(flight.velocity, body), scaled(time, plus(rules.gravity, scaled(mass, force))))
    change = minus(row(bodies.velocity, body), expected)
    turn = minus(row(bodies.angular_momentum, body), plus(row(flight.momentum, body), scaled(time, torque)))
    turning *= bodies.turning_radius[body]
    # Of a body that was never planned the change is not a number.
    if flight.joints[body] > 0:
        # Planned for free fall, see note_plan.
        gained = dot(change, change) ** 0.5 + swept(bodies, flight, body, turn)
        force, torque = row(bodies.force, body), row(bodies.torque, body)
        surge = mass * dot(force, force) ** 0.5 + swept(bodies, flight, body, torque)
        return not gained <= flight.slack[body] or surge > flight.surge[body]
    if not dot(change, change) ** 0.5 + turning * dot(turn, turn) ** 0.5 <= flight.slack[body]:
        return True
    force, torque = minus(row(bodies.force, body), force), minus(row(bodies.torque, body), torque)
    return mass * dot(force, force) ** 0.5 + turning * dot(torque, torque) ** 0.5 > flight.surge[body]


@kernel
def touches(pairs: Pairs, flight: Flight, plans: Plans, body: int) -> bool:
    entry = flight.head[body]
    while entry >= 0:
        if pairs.overlap[entry >> 1] > 0.0:
            return True
        entry = plans.link[entry]
    return False


@kernel
def note_plan(
    bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, body: int, now: float, rules: Rules
) -> None:  # fmt: skip
    """Note the motion of a body for which its pairs are planned now [s], and which changes of it they allow for.

    Writes to flight.
    """
    put(flight.velocity, body, row(bodies.velocity, body))
    put(flight.momentum, body, row(bodies.angular_momentum, body))
    put(flight.force, body, row(bodies.force, body))
    put(flight.torque, body, row(bodies.torque, body))
    flight.planned[body] = now
    speed, along = surface_speed(bodies, flight, body), acceleration_of(bodies, flight, body, rules)
    surge = dot(along, along) ** 0.5 + turning_rate(bodies, flight, body, rules)
    if flight.joints[body] > 0:
        put(flight.force, body, (0.0, 0.0, 0.0))
        put(flight.torque, body, (0.0, 0.0, 0.0))
        flight.slack[body] = max(speed, KEPT * flight.slack[body])
        flight.surge[body] = max(SWINGING * surge, KEPT * flight.surge[body]) + NOTED_WEIGHT * weight(rules)
    elif touches(pairs, flight, plans, body):
        flight.slack[body] = NOTED_CHANGE * speed
        flight.surge[body] = NOTED_CHANGE * surge + NOTED_WEIGHT * weight(rules)
    else:
        # What touches nothing is not pushed, and what begins to touch is planned anew.
        flight.slack[body], flight.surge[body] = 0.0, 0.0


@kernel
def replan(
    bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, body: int, now: float, rules: Rules
) -> None:
    """Plan the pairs of a body anew after a change of its motion. Writes to flight and agenda.

    What is near is not looked at for that: from the gap at its last look and the motion since it follows when the next
    one is due.
    """
    note_plan(bodies, pairs, flight, plans, body, now, rules)
    plan_search(bodies, flight, agenda, body, now, rules)
    entry = flight.head[body]
    while entry >= 0:
        pair, item = entry >> 1, len(bodies.mass) + (entry >> 1)
        if pairs.overlap[pair] > 0.0:
            step = contact_step(pair, bodies, pairs, flight, plans, rules)
            # A contact keeps its steps even while it can: uneven ones take energy from it.
            if step < URGENT * plans.interval[pair]:
                put_on(agenda, item, min(agenda.due[item], max(plans.last[pair] + step, now)))
        else:
            free = pairs.wake[pair] if pairs.feature_count[pair] == 0 else plans.apart_until[pair]
            plan_apart(pair, bodies, pairs, flight, plans, agenda, free, now, rules)
        entry = plans.link[entry]
