"""Every contact at steps of its own: bodies move under steady forces between the instants at which contacts are due.

A contact is looked at at its own instants, and its force is steady in between. At a look the force changes, and half of
the change is counted for the time since the last one, so that one contact alone is stepped by velocity Verlet, which is
the leapfrog of motion.py, and what is at rest stays at rest. Momentum is kept to the last bit. Intervals follow from
the collision of each contact, so that a slow one takes few steps while a fast one takes many beside it; what cannot
touch yet is not looked at.

Source: [Lew-2003] for contacts at instants of their own.
"""

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Cores, Laws, Pairs, Planes, Reactions, Step, contact_radii
from lithobrake.dem.bodies.vectors import minus, plus, put, row, scaled, way_between
from lithobrake.dem.local_stepping.agenda import (
    LONGER,
    SHORTER,
    Plans,
    Schedule,
    collision_step,
    contact_step,
    has_changed,
    plan_apart,
    plan_approach,
    put_on,
    replan,
)
from lithobrake.dem.local_stepping.approach import Approach, approach_of, closing_speed
from lithobrake.dem.local_stepping.free_motion import (
    Flight,
    Rules,
    fly_all_to,
    fly_to,
    spin_of,
)
from lithobrake.dem.local_stepping.holding import is_stirred, let_go
from lithobrake.dem.local_stepping.joints import Joints, renew_joint
from lithobrake.dem.local_stepping.neighbour_search import LISTED, enter_all, search_neighbours
from lithobrake.dem.local_stepping.pushes import count_contact, push
from lithobrake.dem.narrow_phase.feature_list import ROUNDING_OF_RADIUS, STEPS_LISTED, renew_list, travelled
from lithobrake.dem.narrow_phase.scratch import Scratch, System
from lithobrake.dem.stepping.time_loop import contact_force, record_touch
from lithobrake.dem.stepping.time_step_stability import pair_step
from lithobrake.vocabulary.array_types import Floats, Vector

# Why a run stops: besides what neighbour_search.py says.
NO_ROOM = 3
# Steps of motion for which what is near and does not touch is listed; narrowest part of the widest margin.
STEPS_NEAR, NARROWEST = 10.0, 1e-3
# Largest c dt + (w dt)^2 / 4 of one contact, see stability.py: several may push one body.
STABLE_PART = 0.6
# Looks at a joint after which its bodies are planned anew: about a period of the hinge.
PLANNED_LOOKS = 200.0


@kernel
def list_features(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, scratch: Scratch, flight: Flight,
    plans: Plans, rules: Rules,
) -> bool:  # fmt: skip
    """List the features of a pair anew where the list serves no longer; tell whether there was room for them.

    What was not near is always listed anew: it is looked at only where it could touch by now, and the narrower the
    list, the rarer what is near and does not touch. Writes to pairs and scratch.
    """
    first, second = pairs.first[pair], pairs.second[pair]
    touching, travel = pairs.overlap[pair] > 0.0, travelled(bodies, first, second)
    if pairs.feature_count[pair] != 0 and travel < pairs.wake[pair]:
        return True
    speed = closing_speed(bodies, flight, first, second)
    step = plans.interval[pair] if touching else collision_step(pair, pairs, flight, plans, speed, rules)
    most = ROUNDING_OF_RADIUS * contact_radii(pair, bodies, pairs)
    way = (STEPS_LISTED if touching else STEPS_NEAR) * speed * step if speed > 0.0 else 0.0
    margin = max(NARROWEST * most, min(way, most))
    return renew_list(pair, bodies, cores, planes, pairs, scratch, margin, travel)


@kernel
def way_to_second(bodies: Bodies, first: int, second: int) -> Vector:
    """Return the way from the centroid of the first to that of the second, or to the origin for a plane [m]."""
    return way_between(bodies, first, second) if second >= 0 else scaled(-1.0, row(bodies.position, first))


@kernel
def note_motion(pair: int, bodies: Bodies, pairs: Pairs, plans: Plans) -> None:
    """Note where the members of a pair are and how they turn, to tell at the next look how they have moved.

    Writes to plans.
    """
    first, second = pairs.first[pair], pairs.second[pair]
    put(plans.apart, pair, way_to_second(bodies, first, second))
    put(plans.spin[pair], 0, spin_of(bodies, first))
    if second >= 0:
        put(plans.spin[pair], 1, spin_of(bodies, second))


@kernel
def predict(bodies: Bodies, body: int) -> None:
    """Write the velocities at this instant where contact laws read them. Writes to bodies."""
    put(bodies.velocity_predicted, body, row(bodies.velocity, body))
    put(bodies.spin_predicted, body, spin_of(bodies, body))
    put(bodies.half_spin, body, spin_of(bodies, body))


@kernel
def force_after(pair: int, system: System, step: Step, plans: Plans) -> float:
    """Compute the contact force after a step in which others may have moved the members; return its rate.

    A contact slips by the way of its bodies since the last look, whatever moved them: taken from the velocities at hand
    alone, it would gain energy. Writes to system.
    """
    bodies, pairs = system.bodies, system.pairs
    first, second = pairs.first[pair], pairs.second[pair]
    velocity, other_velocity = row(bodies.velocity, first), (0.0, 0.0, 0.0)
    touched = plans.interval[pair] > 0.0 and step.time_step > 0.0
    if touched:
        # `contact_force` takes slip as velocity times step, so velocities of the mean motion stand in here.
        way = minus(way_to_second(bodies, first, second), row(plans.apart, pair))
        mean = scaled(1.0 / step.time_step, way)
        put(bodies.half_spin, first, scaled(0.5, plus(row(bodies.half_spin, first), row(plans.spin[pair], 0))))
        if second >= 0:
            other_velocity = row(bodies.velocity, second)
            put(bodies.velocity, second, plus(velocity, mean))
            put(bodies.half_spin, second, scaled(0.5, plus(row(bodies.half_spin, second), row(plans.spin[pair], 1))))
        else:
            put(bodies.velocity, first, scaled(-1.0, mean))
    rate = contact_force(pair, system, step, True)
    if touched:
        put(bodies.velocity, first, velocity)
        if second >= 0:
            put(bodies.velocity, second, other_velocity)
    return rate


@kernel
def next_step(
    pair: int, bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, flight: Flight, plans: Plans, planned: float,
    rate: float, rules: Rules,
) -> float:  # fmt: skip
    """Return the interval [s] until a contact is due again; planned: the last one, 0 where it touches anew.

    Writes to plans.
    """
    # From the rate of the contact and not from its bodies, so that strong damping counts in it.
    plans.inverse_mass[pair] = rate * pairs.overlap[pair] / (1.5 * pairs.elastic_force[pair])
    plans.longest[pair] = pair_step(pair, bodies, planes, pairs, laws, rules.paper_mass, STABLE_PART)
    step = contact_step(pair, bodies, pairs, flight, plans, rules)
    return planned if SHORTER * planned <= step <= LONGER * planned else step


@kernel
def touch(pair: int, system: System, schedule: Schedule, passed: float, rules: Rules) -> float:
    """Compute a contact, push its bodies, and return the interval [s] until it is due again; 0 where it has ended.

    passed: since the last look [s]. Writes to system and schedule.
    """
    bodies, _, planes, pairs, laws, _, reactions = system
    flight, plans = schedule.flight, schedule.plans
    first, second = pairs.first[pair], pairs.second[pair]
    planned = plans.interval[pair]
    force, torque, other_torque = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if planned > 0.0:
        force, torque = row(reactions.force, pair), row(reactions.first_torque, pair)
        other_torque = row(reactions.second_torque, pair)
    predict(bodies, first)
    if second >= 0:
        predict(bodies, second)
    step = Step(passed, 0.0, rules.gravity, rules.rotation, rules.paper_mass)
    rate = force_after(pair, system, step, plans)
    interval, change = 0.0, scaled(-1.0, force)
    moment, other_moment = scaled(-1.0, torque), scaled(-1.0, other_torque)
    if pairs.overlap[pair] > 0.0:
        interval = next_step(pair, bodies, planes, pairs, laws, flight, plans, planned, rate, rules)
        change = plus(change, row(reactions.force, pair))
        moment = plus(moment, row(reactions.first_torque, pair))
        other_moment = plus(other_moment, row(reactions.second_torque, pair))
    # The force has pushed as it was at the last look: half of its change belongs to the time since.
    # What passed before a contact begins was flight: at most half of the coming interval counts of it.
    time = 0.5 * (passed if planned > 0.0 else min(passed, interval))
    push(bodies, flight, first, -1.0, time, change, moment)
    count_contact(bodies, flight, first, planned, interval)
    if second >= 0:
        push(bodies, flight, second, 1.0, time, change, other_moment)
        count_contact(bodies, flight, second, planned, interval)
    plans.interval[pair] = interval
    note_motion(pair, bodies, pairs, plans)
    return interval


@kernel
def meet(pair: int, system: System, schedule: Schedule, now: float, rules: Rules) -> bool:
    """Look at a pair that is due and plan when to look again; tell whether there was room for its features.

    Writes to system and schedule.
    """
    bodies, cores, planes, pairs, _, scratch, _ = system
    flight, plans, agenda, _ = schedule
    for member in (pairs.first[pair], pairs.second[pair]):
        if member >= 0:
            fly_to(bodies, flight, member, now, rules)
    if not list_features(pair, bodies, cores, planes, pairs, scratch, flight, plans, rules):
        return False
    passed = now - plans.last[pair]
    plans.last[pair] = now
    if pairs.overlap[pair] == 0.0:
        plans.interval[pair] = 0.0
        if pairs.feature_count[pair] == 0:
            pairs.deepest[pair] = 0.0
            plan_apart(pair, bodies, pairs, flight, plans, agenda, pairs.wake[pair], now, rules)
            return True
        # In a dent the two are not apart: the law says when they are.
        if pairs.deepest[pair] == 0.0:
            approach = approach_of(pair, bodies, cores, planes, pairs, flight, rules)
            if approach.gap > 0.0:
                plan_approach(pair, bodies, pairs, flight, plans, agenda, approach, now, rules)
                return True
    touched = plans.interval[pair] > 0.0
    interval = touch(pair, system, schedule, passed, rules)
    if interval > 0.0:
        put_on(agenda, len(bodies.mass) + pair, now + interval)
    else:
        # It has ended, or begins at the very instant: wait for a step of what may come.
        speed = closing_speed(bodies, flight, pairs.first[pair], pairs.second[pair])
        plan_approach(pair, bodies, pairs, flight, plans, agenda, Approach(0.0, speed, 0.0), now, rules)
    for member in (pairs.first[pair], pairs.second[pair]):
        if member < 0:
            continue
        if flight.held[member]:
            if is_stirred(pair, bodies, pairs, flight, plans, member, rules):
                let_go(bodies, pairs, flight, plans, agenda, member, now, rules)
                # It turns from now on, as the next look at this pair has to know.
                note_motion(pair, bodies, pairs, plans)
        elif (touched and interval == 0.0) or has_changed(bodies, flight, member, now, rules):
            replan(bodies, pairs, flight, plans, agenda, member, now, rules)
    return True


@large_kernel
def meet_joint(system: System, schedule: Schedule, joints: Joints, joint: int, now: float, rules: Rules) -> None:
    """Look at a joint that is due and plan when to look again. Writes to system, schedule and joints."""
    bodies, pairs = system.bodies, system.pairs
    flight, plans, agenda, _ = schedule
    members = (joints.first[joint], joints.second[joint])
    for member in members:
        fly_to(bodies, flight, member, now, rules)
    renew_joint(bodies, flight, joints, joint, now - joints.last[joint])
    joints.last[joint], joints.due[joint] = now, now + joints.interval[joint]
    put_on(agenda, joint_item(bodies, pairs, joint), joints.due[joint])
    for member in members:
        # What swings less than it did is planned for less, after a while.
        outdated = now - flight.planned[member] > PLANNED_LOOKS * joints.interval[joint]
        if outdated or has_changed(bodies, flight, member, now, rules):
            replan(bodies, pairs, flight, plans, agenda, member, now, rules)


@kernel
def joint_item(bodies: Bodies, pairs: Pairs, joint: int) -> int:
    """Return where a joint stands on the agenda: after all bodies and all slots for pairs."""
    return len(bodies.mass) + len(pairs.first) + joint


@kernel
def concerns(pair: int, pairs: Pairs, flight: Flight, watched: int) -> bool:
    """Tell whether a pair touches the watched body, or what is joined to it."""
    first, second = pairs.first[pair], pairs.second[pair]
    return flight.leader[first] == watched or (second >= 0 and flight.leader[second] == watched)


@kernel
def contacts_on(pairs: Pairs, reactions: Reactions, flight: Flight, plans: Plans, body: int) -> tuple[bool, Vector]:
    """Tell whether anything touches a body, and return the sum of the contact forces on it [N]."""
    force, touched, entry = (0.0, 0.0, 0.0), False, flight.head[body]
    while entry >= 0:
        pair = entry >> 1
        if pairs.overlap[pair] > 0.0:
            touched = True
            force = plus(force, scaled(1.0 if entry & 1 else -1.0, row(reactions.force, pair)))
        entry = plans.link[entry]
    return touched, force


@kernel
def record_contacts(
    pairs: Pairs, reactions: Reactions, flight: Flight, plans: Plans, joints: Joints | None, watched: int, now: float,
    record: Floats,
) -> None:  # fmt: skip
    """Note what contacts do now [s] to the watched body and to what is joined to it. Writes to record."""
    touched, force = contacts_on(pairs, reactions, flight, plans, watched)
    if joints is not None:
        for joint in range(len(joints.second)):
            if flight.leader[joints.second[joint]] == watched:
                also, more = contacts_on(pairs, reactions, flight, plans, joints.second[joint])
                touched, force = touched or also, plus(force, more)
    record_touch(force, touched, now, record)


@large_kernel
def advance_locally(
    system: System, schedule: Schedule, joints: Joints | None, due: Floats, end: float, rules: Rules, watched: int,
    record: Floats,
) -> int:  # fmt: skip
    """Do all that is due up to an instant [s] and move all bodies there; return LISTED, or what is lacking.

    joints: None where nothing is joined: for that type of it what stands below `is not None` is not compiled.
    due: what is entered first, see enter_all, if anything. Writes to system, schedule, joints and record.
    """
    pairs, agenda, n = system.pairs, schedule.agenda, len(system.bodies.mass)
    if len(due) > 0:
        enter_all(system, schedule, due, rules)
        if joints is not None:
            for joint in range(len(joints.first)):
                put_on(agenda, joint_item(system.bodies, pairs, joint), joints.due[joint])
    while agenda.size[0] > 0:
        item = agenda.heap[0]
        now = agenda.due[item]
        # What is not a number never comes.
        if not now <= end:
            break
        if item < n:
            reason = search_neighbours(system, schedule, item, now, rules)
            if reason != LISTED:
                return reason
            continue
        pair = item - n
        if joints is not None and pair >= len(pairs.first):
            meet_joint(system, schedule, joints, pair - len(pairs.first), now, rules)
            continue
        if not meet(pair, system, schedule, now, rules):
            return NO_ROOM
        if watched >= 0 and concerns(pair, pairs, schedule.flight, watched):
            flight, plans = schedule.flight, schedule.plans
            record_contacts(pairs, system.reactions, flight, plans, joints, watched, now, record)
    fly_all_to(system.bodies, schedule.flight, end, rules)
    return LISTED
