"""The neighbours of one body, listed anew when it has moved by half the skin; pairs come and go one by one.

Each part of a body has neighbours of its own: parts of other bodies, and planes.
Every body has a list of its pairs: entries 2 k and 2 k + 1 stand for the first and the second of the pair in slot k.
"""

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, Laws, Pairs, Planes, curvature_of
from lithobrake.dem.bodies.vectors import dot, minus, nearest, row
from lithobrake.dem.law.restitution import law_between
from lithobrake.dem.local_stepping.agenda import Agenda, Plans, Schedule, plan_search, put_on, take_off
from lithobrake.dem.local_stepping.cells import gather_near, move_to_cell, put_in_cell
from lithobrake.dem.local_stepping.free_motion import Flight, Rules, fly_to, place_at, turning_rate, turning_speed
from lithobrake.dem.narrow_phase.scratch import Scratch, System
from lithobrake.dem.stepping.neighbours import are_near
from lithobrake.dem.stepping.time_step_stability import HERTZ_DURATION
from lithobrake.vocabulary.array_types import Floats

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
def collision_duration(
    pair: int, bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, flight: Flight
) -> float:  # fmt: skip
    """Return the duration of a collision of two times the fifth root of its speed, see time_step.contact_duration."""
    law, curvature = law_between(pair, bodies, planes, pairs, laws), curvature_of(pair, bodies, pairs)
    inverse = 1.0 / flight.mass[pairs.first_part[pair]]
    if pairs.second[pair] >= 0:
        inverse += 1.0 / flight.mass[pairs.second_part[pair]]
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
    plans.duration[pair] = collision_duration(pair, bodies, planes, pairs, laws, flight)
    link(flight, plans, first, 2 * pair)
    if second >= 0:
        link(flight, plans, second, 2 * pair + 1)
    put_on(agenda, len(bodies.mass) + pair, due)


@large_kernel
def enter_all(system: System, schedule: Schedule, due: Floats, rules: Rules) -> None:
    """Enter the bodies and then the pairs of the first slots, due at instants [body_count + pair_count].

    A body due at minus infinity is new, and its neighbours have just been listed: it is put in its cell, and is due
    when it could have left their reach. Writes to schedule.
    """
    bodies, _, planes, pairs, laws, _, _ = system
    flight, plans, agenda, cells = schedule
    n = len(bodies.mass)
    for body in range(n):
        if due[body] != -np.inf:
            put_on(agenda, body, due[body])
            continue
        if cells.cell[body] >= 0:
            put_in_cell(bodies, cells, body)
        plan_search(bodies, flight, agenda, body, flight.time[body], rules)
    for pair in range(len(due) - n):
        enter_pair(pair, bodies, planes, pairs, laws, flight, plans, agenda, due[n + pair])


@kernel
def add_pair(
    bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, flight: Flight, plans: Plans, agenda: Agenda,
    members: tuple[int, int], parts: tuple[int, int], now: float,
) -> bool:  # fmt: skip
    """List parts of two as neighbours, due at once; tell whether there was a slot.

    Writes to pairs, flight, plans and agenda.
    """
    if plans.free_count[0] == 0:
        return False
    plans.free_count[0] -= 1
    pair = plans.free[plans.free_count[0]]
    # The smaller number comes first, as in the lists for common steps.
    own, other = (1, 0) if 0 <= members[1] < members[0] else (0, 1)
    pairs.first[pair], pairs.second[pair] = members[own], members[other]
    pairs.first_part[pair], pairs.second_part[pair] = parts[own], parts[other]
    pairs.wake[pair], pairs.feature_count[pair], pairs.deepest[pair] = 0.0, 0, 0.0
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
    bodies: Bodies, cores: Cores, planes: Planes, scratch: Scratch, flight: Flight, members: tuple[int, int],
    parts: tuple[int, int], now: float, rules: Rules,
) -> bool:  # fmt: skip
    """Tell whether a part of a body that has been moved to now [s] may be less than the skin from one of another, or
    from a plane.

    Writes to scratch.
    """
    body, other = members
    here, reach = row(bodies.position, body), bodies.bounding_radius[body] + rules.skin
    if other < 0:
        return dot(row(planes.normal, -1 - other), here) - planes.offset[-1 - other] < reach
    apart = nearest(bodies.period, minus(place_at(bodies, flight, other, now, rules), here))
    if dot(apart, apart) ** 0.5 - bodies.bounding_radius[other] >= reach:
        return False
    # The other has turned since it was last moved.
    turned = 0.0
    if not flight.held[other]:
        time = now - flight.time[other]
        turned = turning_speed(bodies, flight, other)
        turned = time * (turned + time * turning_rate(bodies, flight, other, rules))
    shapes = (bodies.shape[parts[0]], bodies.shape[parts[1]])
    return are_near(bodies, cores, scratch, members, shapes, apart, rules.skin + turned)


@kernel
def list_if_near(
    system: System, schedule: Schedule, members: tuple[int, int], parts: tuple[int, int], now: float, rules: Rules
) -> bool:
    """List a part of another, or a plane, as a neighbour of a part of a body if it is near and not listed yet; tell
    whether there was a slot.

    Writes to system and schedule.
    """
    bodies, cores, planes, pairs, laws, scratch, _ = system
    flight, plans, agenda, _ = schedule
    # A stamp saves a walk through all pairs of the body for each candidate.
    if flight.stamp[stamp_of(bodies, parts[1])] == parts[0]:
        return True
    if not is_near(bodies, cores, planes, scratch, flight, members, parts, now, rules):
        return True
    return add_pair(bodies, planes, pairs, laws, flight, plans, agenda, members, parts, now)


@large_kernel
def search_neighbours(system: System, schedule: Schedule, body: int, now: float, rules: Rules) -> int:
    """List the neighbours of a body anew; return LISTED, NO_SLOT where one more is needed, or LOST.

    Writes to system and schedule.
    """
    bodies, pairs = system.bodies, system.pairs
    flight, plans, agenda, cells = schedule
    fly_to(bodies, flight, body, now, rules)
    if not np.isfinite(bodies.travel[body]):
        return LOST
    move_to_cell(bodies, cells, body)
    found = gather_near(cells, row(bodies.position, body), bodies.bounding_radius[body] + rules.skin)
    for part in range(bodies.part_start[body], bodies.part_start[body + 1]):
        drop_distant(system, schedule, body, part, now, rules)
        if not list_near(system, schedule, body, part, found, now, rules):
            return NO_SLOT
        unstamp(bodies, pairs, flight, plans, body, part)
    bodies.travel_listed[body] = bodies.travel[body]
    plan_search(bodies, flight, agenda, body, now, rules)
    return LISTED


@kernel
def list_near(
    system: System, schedule: Schedule, body: int, part: int, found: int, now: float, rules: Rules
) -> bool:  # fmt: skip
    """List what is near a part of a body, of the planes and of so many that the cells found; tell whether there were
    slots for all.

    Writes to system and schedule.
    """
    bodies, planes, cells, flight = system.bodies, system.planes, schedule.cells, schedule.flight
    has_room = True
    for at in range(-len(planes.offset), found):
        if at < 0:
            if planes.meets[-1 - at, body]:
                has_room &= list_if_near(system, schedule, (body, at), (part, at), now, rules)
            continue
        other = cells.found[at]
        # What is joined does not touch; a body is its own leader, or shares it with all that it is joined to.
        if flight.leader[other] == flight.leader[body]:
            continue
        for its in range(bodies.part_start[other], bodies.part_start[other + 1]):
            has_room &= list_if_near(system, schedule, (body, other), (part, its), now, rules)
    return has_room


@kernel
def stamp_of(bodies: Bodies, part: int) -> int:
    """Return where the stamp of a part, or of a plane (below 0), stands."""
    return part if part >= 0 else len(bodies.shape) - 1 - part


@kernel
def parts_from(pairs: Pairs, entry: int) -> tuple[int, int]:
    """Return the parts of a pair, first that of the body in whose list the entry stands."""
    first, second = pairs.first_part[entry >> 1], pairs.second_part[entry >> 1]
    return (second, first) if entry & 1 else (first, second)


@kernel
def unstamp(bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, body: int, part: int) -> None:
    """Take the stamp of a part of a body off all that it has listed. Writes to flight."""
    entry = flight.head[body]
    while entry >= 0:
        own, other = parts_from(pairs, entry)
        if own == part:
            flight.stamp[stamp_of(bodies, other)] = -1
        entry = plans.link[entry]


@kernel
def drop_distant(system: System, schedule: Schedule, body: int, part: int, now: float, rules: Rules) -> None:
    """Forget the pairs of a part of a body that are no longer near it, and stamp the others.

    Writes to system and schedule.
    """
    bodies, cores, planes, pairs, _, scratch, _ = system
    flight, plans, agenda, _ = schedule
    entry = flight.head[body]
    while entry >= 0:
        after, pair = plans.link[entry], entry >> 1
        other = pairs.first[pair] if entry & 1 else pairs.second[pair]
        parts = parts_from(pairs, entry)
        if parts[0] != part:
            entry = after
            continue
        # A pair that touches is never forgotten: its springs hold energy and history.
        is_apart = pairs.overlap[pair] == 0.0
        if is_apart and not is_near(bodies, cores, planes, scratch, flight, (body, other), parts, now, rules):
            forget_pair(pair, pairs, flight, plans, agenda, len(bodies.mass))
        else:
            flight.stamp[stamp_of(bodies, parts[1])] = part
        entry = after
