"""The neighbours of one body, listed anew when it has moved by half the skin; pairs come and go one by one.

Every body has a list of its pairs: entries 2 k and 2 k + 1 stand for the first and the second of the pair in slot k.
"""

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, Floats, Laws, Pairs, Planes
from lithobrake.dem.bodies.period import nearest
from lithobrake.dem.bodies.vectors import dot, minus, row
from lithobrake.dem.law.material_pair import law_between
from lithobrake.dem.local_stepping.agenda import Agenda, put_on, take_off
from lithobrake.dem.local_stepping.cells import gather_near, move_to_cell
from lithobrake.dem.local_stepping.contact_plans import Plans, Schedule, plan_search
from lithobrake.dem.local_stepping.free_flight import Flight, Rules, fly_to, place_at, spin_bound
from lithobrake.dem.narrow_phase.scratch import Scratch, System
from lithobrake.dem.stepping.neighbours import are_near
from lithobrake.dem.stepping.time_step import HERTZ_DURATION

LISTED, NO_SLOT, LOST = 0, 1, 2


@kernel
def link(flight: Flight, plans: Plans, body: int, entry: int) -> None:
    """Enter a pair in the list of a body's. Writes to flight and plans."""
    plans.link[entry] = flight.head[body]
    flight.head[body] = entry


@kernel
def unlink(flight: Flight, plans: Plans, body: int, entry: int) -> None:
    """Take an entry out of the list of a body's pairs. Writes to flight and plans."""
    if flight.head[body] == entry:
        flight.head[body] = plans.link[entry]
        return
    at = flight.head[body]
    while plans.link[at] != entry:
        at = plans.link[at]
    plans.link[at] = plans.link[entry]


@kernel
def collision_duration(bodies: Bodies, planes: Planes, laws: Laws, flight: Flight, first: int, second: int) -> float:
    """Return the duration of a collision of two times the fifth root of its speed, see time_step.contact_duration."""
    law = law_between(bodies, planes, laws, first, second)
    inverse, curvature = 1.0 / flight.mass[first], bodies.curvature[first]
    if second >= 0:
        inverse, curvature = inverse + 1.0 / flight.mass[second], curvature + bodies.curvature[second]
    return HERTZ_DURATION * (curvature / (inverse * law.young_modulus) ** 2) ** 0.2 / max(1.0, 2.0 * law.damping_ratio)


@kernel
def enter_pair(
    pair: int, bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, flight: Flight, plans: Plans, agenda: Agenda,
    due: float,
) -> None:  # fmt: skip
    """Enter the pair of a slot in the lists of its bodies, due at an instant [s].

    Writes to flight, plans and agenda.
    """
    first, second = pairs.first[pair], pairs.second[pair]
    plans.duration[pair] = collision_duration(bodies, planes, laws, flight, first, second)
    link(flight, plans, first, 2 * pair)
    if second >= 0:
        link(flight, plans, second, 2 * pair + 1)
    put_on(agenda, len(bodies.mass) + pair, due)


@large_kernel
def enter_all(
    bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, flight: Flight, plans: Plans, agenda: Agenda,
    due: Floats,
) -> None:  # fmt: skip
    """Enter the bodies and then the pairs of the first slots, due at instants [body_count + pair_count].

    Writes to flight, plans and agenda.
    """
    n = len(bodies.mass)
    for body in range(n):
        put_on(agenda, body, due[body])
    for pair in range(len(due) - n):
        enter_pair(pair, bodies, planes, pairs, laws, flight, plans, agenda, due[n + pair])


@large_kernel
def plan_all_searches(bodies: Bodies, flight: Flight, agenda: Agenda, now: float, rules: Rules) -> None:
    """Make all bodies due whose neighbours have just been listed, now [s]. Writes to agenda."""
    for body in range(len(bodies.mass)):
        plan_search(bodies, flight, agenda, body, now, rules)


@kernel
def add_pair(
    bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, flight: Flight, plans: Plans, agenda: Agenda, one: int,
    other: int, now: float,
) -> bool:  # fmt: skip
    """List two as neighbours, due at once; tell whether there was a slot. Writes to pairs, flight, plans and agenda."""
    if plans.free_count[0] == 0:
        return False
    plans.free_count[0] -= 1
    pair = plans.free[plans.free_count[0]]
    pairs.first[pair], pairs.second[pair] = (min(one, other), max(one, other)) if other >= 0 else (one, other)
    pairs.wake[pair], pairs.feature_count[pair] = 0.0, 0
    plans.last[pair], plans.interval[pair] = now, 0.0
    enter_pair(pair, bodies, planes, pairs, laws, flight, plans, agenda, now)
    return True


@kernel
def forget_pair(
    pair: int, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, body_count: int
) -> None:  # fmt: skip
    """Take a pair off the lists of its bodies. Writes to pairs, flight, plans and agenda."""
    take_off(agenda, body_count + pair)
    unlink(flight, plans, pairs.first[pair], 2 * pair)
    if pairs.second[pair] >= 0:
        unlink(flight, plans, pairs.second[pair], 2 * pair + 1)
    pairs.first[pair], pairs.feature_count[pair] = -1, 0
    plans.free[plans.free_count[0]] = pair
    plans.free_count[0] += 1


@kernel
def is_near(
    bodies: Bodies, cores: Cores, planes: Planes, scratch: Scratch, flight: Flight, body: int, other: int, now: float,
    rules: Rules,
) -> bool:  # fmt: skip
    """Tell whether a body that has been moved to now [s] may be less than the skin from another, or from a plane.

    Writes to scratch.
    """
    here, reach = row(bodies.position, body), bodies.bounding_radius[body] + rules.skin
    if other < 0:
        return dot(row(planes.normal, -1 - other), here) - planes.offset[-1 - other] < reach
    apart = nearest(bodies.period, minus(place_at(bodies, flight, other, now, rules), here))
    if dot(apart, apart) ** 0.5 - bodies.bounding_radius[other] >= reach:
        return False
    # The other has turned since it was last moved.
    turned = 0.0
    if not flight.held[other]:
        turned = (now - flight.time[other]) * bodies.turning_radius[other] * spin_bound(bodies, flight, other)
    return are_near(bodies, cores, scratch, body, other, apart, rules.skin + turned)


@kernel
def list_if_near(system: System, schedule: Schedule, body: int, other: int, now: float, rules: Rules) -> bool:
    """List another as a neighbour of a body if it is near and not listed yet; tell whether there was a slot.

    Writes to system and schedule.
    """
    bodies, cores, planes, pairs, laws, scratch, _ = system
    flight, plans, agenda, _ = schedule
    n = len(bodies.mass)
    if other == body or flight.stamp[other if other >= 0 else n - 1 - other] == body:
        return True
    if not is_near(bodies, cores, planes, scratch, flight, body, other, now, rules):
        return True
    return add_pair(bodies, planes, pairs, laws, flight, plans, agenda, body, other, now)


@large_kernel
def search_neighbours(system: System, schedule: Schedule, body: int, now: float, rules: Rules) -> int:
    """List the neighbours of a body anew; return LISTED, NO_SLOT where one more is needed, or LOST.

    Writes to system and schedule.
    """
    bodies, planes, pairs = system.bodies, system.planes, system.pairs
    flight, plans, agenda, cells = schedule
    fly_to(bodies, flight, body, now, rules)
    if not np.isfinite(bodies.travel[body]):
        return LOST
    move_to_cell(bodies, cells, body)
    here, reach = row(bodies.position, body), bodies.bounding_radius[body] + rules.skin
    drop_distant(system, schedule, body, now, rules)
    has_room = True
    for at in range(-len(planes.offset), gather_near(cells, here, reach)):
        other = at if at < 0 else cells.found[at]
        if other >= 0 or planes.meets[-1 - other, body]:
            has_room &= list_if_near(system, schedule, body, other, now, rules)
    if not has_room:
        return NO_SLOT
    unstamp(pairs, flight, plans, body, len(bodies.mass))
    bodies.travel_listed[body] = bodies.travel[body]
    plan_search(bodies, flight, agenda, body, now, rules)
    return LISTED


@kernel
def unstamp(pairs: Pairs, flight: Flight, plans: Plans, body: int, body_count: int) -> None:
    """Take a body's stamp off all that it has listed. Writes to flight."""
    entry = flight.head[body]
    while entry >= 0:
        pair = entry >> 1
        other = pairs.second[pair] if pairs.first[pair] == body else pairs.first[pair]
        flight.stamp[other if other >= 0 else body_count - 1 - other] = -1
        entry = plans.link[entry]


@kernel
def drop_distant(system: System, schedule: Schedule, body: int, now: float, rules: Rules) -> None:
    """Forget the pairs of a body that are no longer near it, and stamp the others. Writes to system and schedule."""
    bodies, cores, planes, pairs, _, scratch, _ = system
    flight, plans, agenda, _ = schedule
    entry, n = flight.head[body], len(bodies.mass)
    while entry >= 0:
        after, pair = plans.link[entry], entry >> 1
        other = pairs.second[pair] if pairs.first[pair] == body else pairs.first[pair]
        if pairs.overlap[pair] == 0.0 and not is_near(bodies, cores, planes, scratch, flight, body, other, now, rules):
            forget_pair(pair, pairs, flight, plans, agenda, n)
        else:
            flight.stamp[other if other >= 0 else n - 1 - other] = body
        entry = after
