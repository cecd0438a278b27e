"""Every contact at steps of its own: bodies fly freely between the instants at which a contact of theirs is looked at.

A contact kicks its two bodies at instants of its own, by the mean of the intervals before and after, so momentum is kept
to the last bit and a contact alone is stepped as by the leapfrog of motion.py. Between kicks bodies fly under gravity and
turn freely, without error. What cannot touch is not looked at before it could.

Source: Lew, Marsden, Ortiz and West (2003), Archive for Rational Mechanics and Analysis 167, 85-146: asynchronous
variational integrators.
"""

from typing import NamedTuple

import numpy as np

from lithobrake.compiled import kernel, large_kernel
from lithobrake.dem.agenda import Agenda, put_on, take_off
from lithobrake.dem.arrays import Bodies, Cores, Floats, Integers, Laws, Pairs, Planes, Reactions, Step
from lithobrake.dem.contact_patch import measure_feature
from lithobrake.dem.feature_id import SPHERES, feature_capacity, feature_indices, feature_kind, listed_feature
from lithobrake.dem.feature_list import BOUND_SLACK, ROUNDING_OF_RADIUS, STEPS_LISTED, list_bodies, list_plane, travelled
from lithobrake.dem.force import contact_force
from lithobrake.dem.motion import turned, write_inverse_inertia, write_rotation
from lithobrake.dem.scratch import Scratch
from lithobrake.dem.vectors import Vector, add, cross, dot, minus, plus, put, row, scaled, times, transposed_times

DONE, FEATURES_OVERFLOW, PAIRS_FULL, DIVERGED = 0, 1, 2, 4
# A body's pairs are looked at anew when its speed has changed by this part of what it was.
NOTED_CHANGE = 0.5
# Largest angle [rad] by which a body turns freely at once.
LARGEST_TURN = 0.2
# Largest (w dt)^2 / 4 of the tilting of a patch in a step of its contact; 1 is the limit of stability.
TILT_STEP = 0.15
# Steps of motion for which what is near and does not touch is listed; smallest part of the widest margin that is listed.
STEPS_NEAR, NARROWEST = 3.0, 1e-3
# A contact keeps its step until the wanted one is so many times shorter or longer.
UNEVEN = 0.5


class Flight(NamedTuple):
    """Per body, between its kicks."""

    time: Floats  # [body_count], s, to which it was last moved
    velocity: Floats  # [body_count, 3], m/s, for which its pairs were planned
    momentum: Floats  # [body_count, 3], kg m2/s, the same
    slack: Floats  # [body_count], m/s, change of the speed of its surface for which the plans hold
    turning: Floats  # [body_count], 1/(kg m2), largest inverse moment of inertia
    mass: Floats  # [body_count], kg, smallest that a contact meets
    head: Integers  # [body_count], first entry of the list of its pairs, -1: none
    stamp: Integers  # [body_count], scratch of the search for neighbours
    stats: Integers


class Plans(NamedTuple):
    """Per slot for a pair, used or free."""

    last: Floats  # [pair_capacity], s, when it was last looked at
    interval: Floats  # [pair_capacity], s, until when it was planned to be looked at again, then
    inverse_mass: Floats  # [pair_capacity], 1/kg, that a contact meets along its normal, more where damping is strong
    duration: Floats  # [pair_capacity], s (m/s)^(1/5), duration of a collision times the fifth root of its speed
    apart: Floats  # [pair_capacity, 3], m, from the first's centroid to the second's, at the last look
    spin: Floats  # [pair_capacity, 2, 3], rad/s, of both after the last kick
    link: Integers  # [2 pair_capacity], next entry in the list of the first's, and of the second's pairs; -1: none
    free: Integers  # [pair_capacity], slots that are free
    free_count: Integers  # [1]


class Rules(NamedTuple):
    """What holds for a whole run."""

    gravity: Vector  # m/s2
    drag: float  # 1/s
    paper_mass: bool
    steps: float  # in the duration of a contact
    skin: float  # m, gap below which two are neighbours
    uneven: float
    tilt: float


@kernel
def entry_after(plans: Plans, entry: int) -> int:
    """Return the next entry in the list of a body's pairs."""
    return plans.link[entry]


@kernel
def surface_speed(bodies: Bodies, flight: Flight, body: int) -> float:
    """Return a bound on the speed of a body's surface [m/s], however it tumbles."""
    v, momentum = row(bodies.velocity, body), row(bodies.angular_momentum, body)
    turning = bodies.turning_radius[body] * flight.turning[body]
    return dot(v, v) ** 0.5 + turning * dot(momentum, momentum) ** 0.5


@kernel
def fly_to(bodies: Bodies, flight: Flight, body: int, now: float, rules: Rules) -> None:
    """Move a body in free flight to an instant. Writes to bodies and flight."""
    time = now - flight.time[body]
    if time <= 0.0:
        return
    flight.time[body] = now
    before = row(bodies.velocity, body)
    if rules.drag > 0.0:
        kept = np.exp(-rules.drag * time)
        way = (1.0 - kept) / rules.drag
        fall = scaled(1.0 / rules.drag, rules.gravity)
        after = plus(fall, scaled(kept, minus(before, fall)))
        add(bodies.position, body, 1.0, plus(scaled(time, fall), scaled(way, minus(before, fall))))
        momentum = row(bodies.angular_momentum, body)
        energy = bodies.mass[body] * (dot(before, before) + dot(after, after)) * 0.5
        put(bodies.velocity, body, after)
        put(bodies.angular_momentum, body, scaled(kept, momentum))
        bodies.dragged[body] += rules.drag * energy * time
    else:
        after = plus(before, scaled(time, rules.gravity))
        add(bodies.position, body, time, plus(before, scaled(0.5 * time, rules.gravity)))
        put(bodies.velocity, body, after)
    momentum = row(bodies.angular_momentum, body)
    spin = flight.turning[body] * dot(momentum, momentum) ** 0.5
    parts = 1 + int(spin * time / LARGEST_TURN)
    for _ in range(parts):
        turn_freely(bodies, body, time / parts)
    fastest = max(dot(before, before), dot(after, after)) ** 0.5
    bodies.travel[body] += time * (fastest + bodies.turning_radius[body] * spin)


@kernel
def turn_freely(bodies: Bodies, body: int, time: float) -> None:
    """Turn a body freely for a time [s] by the spin at its middle, to the second order. Writes to bodies."""
    momentum = row(bodies.angular_momentum, body)
    spin = times(bodies.inverse_inertia, body, momentum)
    if not bodies.isotropic[body]:
        # The angular momentum stands still while the body turns under it.
        spin = plus(spin, scaled(0.5 * time, change_of_spin(bodies, body, momentum, spin)))
    q = bodies.quaternion
    after = turned((q[body, 0], q[body, 1], q[body, 2], q[body, 3]), spin, time)
    q[body, 0], q[body, 1], q[body, 2], q[body, 3] = after
    write_rotation(after, bodies.rotation[body])
    if not bodies.isotropic[body]:
        write_inverse_inertia(bodies, body)
    put(bodies.half_spin, body, spin)


@kernel
def change_of_spin(bodies: Bodies, body: int, momentum: Vector, spin: Vector) -> Vector:
    """Return the rate of change of the spin of a free body [rad/s2]: I^-1 (L x w), by Euler's equations."""
    return times(bodies.inverse_inertia, body, cross(momentum, spin))


@kernel
def closing_speed(bodies: Bodies, flight: Flight, first: int, second: int) -> float:
    """Return a bound on the speed at which the surfaces of two near each other while their plans hold [m/s]."""
    momentum = row(bodies.angular_momentum, first)
    turning = bodies.turning_radius[first] * flight.turning[first] * dot(momentum, momentum) ** 0.5
    between, slack = row(bodies.velocity, first), flight.slack[first]
    if second >= 0:
        momentum = row(bodies.angular_momentum, second)
        turning += bodies.turning_radius[second] * flight.turning[second] * dot(momentum, momentum) ** 0.5
        between = minus(between, row(bodies.velocity, second))
        slack += flight.slack[second]
    return dot(between, between) ** 0.5 + turning + slack


@kernel
def time_to_close(gap: float, speed: float, fall: float) -> float:
    """Return the shortest time [s] in which a gap [m] closes at a speed [m/s] under an acceleration [m/s2]."""
    fastest = speed + (speed * speed + 2.0 * fall * gap) ** 0.5
    return 2.0 * gap / fastest if fastest > 0.0 else np.inf


@kernel
def weight(rules: Rules) -> float:
    """Return the size of gravity [m/s2]."""
    return dot(rules.gravity, rules.gravity) ** 0.5


@kernel
def near_interval(pair: int, plans: Plans, speed: float, rules: Rules) -> float:
    """Return the step [s] of a contact that begins at a speed [m/s]."""
    return plans.duration[pair] * speed**-0.2 / rules.steps if speed > 0.0 else np.inf


@kernel
def touching_interval(pair: int, bodies: Bodies, pairs: Pairs, plans: Plans, rules: Rules) -> float:
    """Return the step [s] of a contact, from the collision that it is a part of."""
    first, second = pairs.first[pair], pairs.second[pair]
    point, normal = row(pairs.point, pair), row(pairs.normal, pair)
    arm = minus(point, row(bodies.position, first))
    velocity = plus(row(bodies.velocity, first), cross(row(bodies.half_spin, first), arm))
    couple = 1.0 * dot(normal, normal) * flight_inverse(bodies, first)
    if second >= 0:
        arm = minus(point, row(bodies.position, second))
        velocity = minus(velocity, plus(row(bodies.velocity, second), cross(row(bodies.half_spin, second), arm)))
        couple += flight_inverse(bodies, second)
    speed = dot(velocity, normal)
    overlap, elastic = pairs.overlap[pair], pairs.elastic_force[pair]
    stiffness = elastic / overlap
    inverse_mass = plans.inverse_mass[pair]
    energy = 0.4 * elastic * overlap + 0.5 * speed * speed / inverse_mass
    deepest = (2.5 * energy * overlap**0.5 / stiffness) ** 0.4
    interval = 2.943 * deepest / ((2.0 * energy * inverse_mass) ** 0.5 * rules.steps)
    tilt = (pairs.tilt_stiffness[pair] + pairs.roll_stiffness[pair] + pairs.twist_stiffness[pair]) * couple
    return min(interval, 2.0 * (rules.tilt / tilt) ** 0.5) if tilt > 0.0 else interval


@kernel
def flight_inverse(bodies: Bodies, body: int) -> float:
    """Return the trace of the inverse inertia [1/(kg m2)], which no direction passes."""
    inverse = bodies.inverse_inertia
    return inverse[body, 0, 0] + inverse[body, 1, 1] + inverse[body, 2, 2]


@kernel
def predict(bodies: Bodies, body: int, sign: float, force: Vector, torque: Vector, half: float) -> None:
    """Write the velocities at the instant, to which the kick of the pair's last look has come but half.

    Writes to bodies.
    """
    put(bodies.velocity_predicted, body, plus(row(bodies.velocity, body), scaled(sign * half * bodies.inverse_mass[body], force)))
    momentum = plus(row(bodies.angular_momentum, body), scaled(sign * half, torque))
    put(bodies.spin_predicted, body, times(bodies.inverse_inertia, body, momentum))
    put(bodies.half_spin, body, times(bodies.inverse_inertia, body, row(bodies.angular_momentum, body)))


@kernel
def plan_far(
    pair: int, bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, now: float, rules: Rules
) -> None:
    """Make a pair due when it could touch first, as nothing near has been found. Writes to agenda."""
    first, second = pairs.first[pair], pairs.second[pair]
    gap = pairs.wake[pair] - bodies.travel[first] - (now - flight.time[first]) * surface_speed(bodies, flight, first)
    fall = 0.0
    if second >= 0:
        gap -= bodies.travel[second] + (now - flight.time[second]) * surface_speed(bodies, flight, second)
    else:
        fall = weight(rules)
    time = time_to_close(gap, closing_speed(bodies, flight, first, second), fall) if gap > 0.0 else 0.0
    put_on(agenda, len(bodies.mass) + pair, now + time)


@kernel
def replan(
    bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, body: int, now: float, rules: Rules
) -> None:
    """Plan the pairs of a body anew after its speed has changed. Writes to flight and agenda."""
    put(flight.velocity, body, row(bodies.velocity, body))
    put(flight.momentum, body, row(bodies.angular_momentum, body))
    flight.slack[body] = NOTED_CHANGE * surface_speed(bodies, flight, body)
    plan_search(bodies, flight, agenda, body, now, rules)
    entry = flight.head[body]
    while entry >= 0:
        pair = entry >> 1
        if pairs.feature_count[pair] == 0:
            plan_far(pair, bodies, pairs, flight, plans, agenda, now, rules)
        else:
            item = len(bodies.mass) + pair
            if pairs.overlap[pair] > 0.0:
                interval = touching_interval(pair, bodies, pairs, plans, rules)
                # A contact keeps its steps even while it can: uneven ones take energy from it.
                if interval < rules.uneven * plans.interval[pair]:
                    put_on(agenda, item, min(agenda.due[item], max(plans.last[pair] + interval, now)))
            else:
                put_on(agenda, item, now)
        entry = plans.link[entry]


@kernel
def plan_search(bodies: Bodies, flight: Flight, agenda: Agenda, body: int, now: float, rules: Rules) -> None:
    """Make a body due when it could have left the reach of its list of neighbours. Writes to agenda."""
    left = 0.5 * rules.skin - (bodies.travel[body] - bodies.travel_listed[body])
    speed = surface_speed(bodies, flight, body) + flight.slack[body]
    put_on(agenda, body, now + (time_to_close(left, speed, weight(rules)) if left > 0.0 else 0.0))


@kernel
def has_changed(bodies: Bodies, flight: Flight, body: int) -> bool:
    """Tell whether the plans of a body's pairs hold no longer."""
    change = minus(row(bodies.velocity, body), row(flight.velocity, body))
    turn = minus(row(bodies.angular_momentum, body), row(flight.momentum, body))
    turning = bodies.turning_radius[body] * flight.turning[body]
    return not dot(change, change) ** 0.5 + turning * dot(turn, turn) ** 0.5 <= flight.slack[body]


@kernel
def kick_body(bodies: Bodies, body: int, sign: float, force: Vector, torque: Vector) -> None:
    """Add an impulse [N s] and its moment [N m s] to a body. Writes to bodies."""
    add(bodies.velocity, body, sign * bodies.inverse_mass[body], force)
    add(bodies.angular_momentum, body, sign, torque)


@kernel
def list_features(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, scratch: Scratch, flight: Flight,
    plans: Plans, rules: Rules,
) -> bool:  # fmt: skip
    """List the features of a pair anew where the list serves no longer; tell whether there was room for them.

    What was not near is always listed anew: it is looked at only where it could touch by now, and the narrower the list,
    the rarer what is near and does not touch. Writes to pairs and scratch.
    """
    first, second = pairs.first[pair], pairs.second[pair]
    touching, travel = pairs.overlap[pair] > 0.0, travelled(bodies, first, second)
    if pairs.feature_count[pair] != 0 and travel < pairs.wake[pair]:
        return True
    speed = closing_speed(bodies, flight, first, second)
    interval = plans.interval[pair] if touching else near_interval(pair, plans, speed, rules)
    radius = bodies.contact_radius[first] + (bodies.contact_radius[second] if second >= 0 else 0.0)
    most, least = ROUNDING_OF_RADIUS * radius, NARROWEST * ROUNDING_OF_RADIUS * radius
    margin = least
    if speed > 0.0:
        margin = max(least, min((STEPS_LISTED if touching else STEPS_NEAR) * speed * interval, most))
    if second < 0:
        serves = max(margin, list_plane(pair, bodies, cores, planes, pairs, margin))
    else:
        serves = list_bodies(pair, bodies, cores, pairs, scratch.simplex, scratch.turned, scratch.relative, margin)
    if pairs.feature_count[pair] > feature_capacity(pair, pairs):
        return False
    pairs.wake[pair] = travel + (1.0 - BOUND_SLACK) * serves
    return True


class Approach(NamedTuple):
    """How near the features of a pair are to touching."""

    gap: float  # m, of the first to touch; not above 0 where one touches
    speed: float  # m/s, at which that one closes at most while the plans hold
    time: float  # s, before which none touches


@kernel
def sooner(approach: Approach, gap: float, closing: float, slack: float, fall: float) -> Approach:
    """Return the sooner of an approach and of a feature at a gap [m] that closes at a speed [m/s] and a slack [m/s]."""
    speed = max(closing, 0.0) + slack
    time = time_to_close(max(gap, 0.0), speed, fall)
    return Approach(gap, speed, time) if gap <= 0.0 or time < approach.time else approach


@kernel
def approach_of(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, flight: Flight, rules: Rules
) -> Approach:
    """Return how near a pair is to touching, from the features that are listed and the motion of either."""
    first, second = pairs.first[pair], pairs.second[pair]
    left = pairs.wake[pair] - travelled(bodies, first, second)
    fall = weight(rules) if second < 0 else 0.0
    whole = closing_speed(bodies, flight, first, second)
    approach = Approach(left, whole, time_to_close(max(left, 0.0), whole, fall))
    count, velocity = pairs.feature_count[pair], row(bodies.velocity, first)
    spin = times(bodies.inverse_inertia, first, row(bodies.angular_momentum, first))
    slack = flight.slack[first]
    if count < 0 or left <= 0.0:
        return Approach(0.0, whole, 0.0)
    if second < 0:
        plane, shape = -1 - second, bodies.shape[first]
        outward = row(planes.normal, plane)
        level = dot(outward, row(bodies.position, first)) - planes.offset[plane] - cores.rounding[shape]
        for k in range(count):
            corner = row(cores.vertex, cores.vertex_start[shape] + feature_indices(listed_feature(pair, pairs, k))[0])
            arm = times(bodies.rotation, first, corner)
            closing = -dot(outward, plus(velocity, cross(spin, arm)))
            approach = sooner(approach, level + dot(outward, arm), closing, slack, fall)
        return approach
    slack += flight.slack[second]
    apart = minus(row(bodies.position, second), row(bodies.position, first))
    other_spin = times(bodies.inverse_inertia, second, row(bodies.angular_momentum, second))
    between = minus(row(bodies.velocity, second), velocity)
    if feature_kind(pairs.feature[pair, 0]) == SPHERES:
        distance = dot(apart, apart) ** 0.5
        gap = distance - bodies.contact_radius[first] - bodies.contact_radius[second]
        return sooner(approach, gap, -dot(between, apart) / distance if distance > 0.0 else 0.0, slack, 0.0)
    reach = cores.rounding[bodies.shape[first]] + cores.rounding[bodies.shape[second]]
    for k in range(count):
        feature = listed_feature(pair, pairs, k)
        on_first, normal, distance = measure_feature(bodies, cores, feature, first, second, apart, reach + left)
        if distance < reach + left:
            on_second = minus(plus(on_first, scaled(distance, normal)), apart)
            moving = plus(between, minus(cross(other_spin, on_second), cross(spin, on_first)))
            approach = sooner(approach, distance - reach, -dot(moving, normal), slack, 0.0)
            if approach.gap <= 0.0:
                break
    return approach


@kernel
def longest_turn(bodies: Bodies, flight: Flight, first: int, second: int) -> float:
    """Return for how long [s] velocities of points of the bodies stay about the same, though they turn."""
    momentum = row(bodies.angular_momentum, first)
    spin = flight.turning[first] * dot(momentum, momentum) ** 0.5
    if second >= 0:
        momentum = row(bodies.angular_momentum, second)
        spin = max(spin, flight.turning[second] * dot(momentum, momentum) ** 0.5)
    return LARGEST_TURN / spin if spin > 0.0 else np.inf


@kernel
def distance_of(bodies: Bodies, first: int, second: int) -> Vector:
    """Return the way from the centroid of the first to that of the second, or to the origin for a plane [m]."""
    here = row(bodies.position, first)
    return minus(row(bodies.position, second), here) if second >= 0 else scaled(-1.0, here)


@kernel
def note_motion(pair: int, bodies: Bodies, pairs: Pairs, plans: Plans) -> None:
    """Note where the members of a pair are and how they turn, to tell at the next look how they have moved.

    Writes to plans.
    """
    first, second = pairs.first[pair], pairs.second[pair]
    put(plans.apart, pair, distance_of(bodies, first, second))
    put(plans.spin[pair], 0, times(bodies.inverse_inertia, first, row(bodies.angular_momentum, first)))
    if second >= 0:
        put(plans.spin[pair], 1, times(bodies.inverse_inertia, second, row(bodies.angular_momentum, second)))


@kernel
def forces_after(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, scratch: Scratch,
    reactions: Reactions, plans: Plans, passed: float, rules: Rules,
) -> float:  # fmt: skip
    """Compute the contact force after an interval [s] in which others may have kicked the members; return its rate.

    The way that a contact has slipped is that of the bodies since the last look, whoever kicked them.
    Writes to bodies, pairs, scratch and reactions.
    """
    first, second = pairs.first[pair], pairs.second[pair]
    velocity, spin = row(bodies.velocity, first), row(bodies.half_spin, first)
    other_velocity, other_spin = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if passed > 0.0 and plans.interval[pair] > 0.0:
        way = scaled(1.0 / passed, minus(distance_of(bodies, first, second), row(plans.apart, pair)))
        put(bodies.half_spin, first, scaled(0.5, plus(spin, row(plans.spin[pair], 0))))
        if second >= 0:
            other_velocity, other_spin = row(bodies.velocity, second), row(bodies.half_spin, second)
            put(bodies.velocity, second, plus(velocity, way))
            put(bodies.half_spin, second, scaled(0.5, plus(other_spin, row(plans.spin[pair], 1))))
        else:
            put(bodies.velocity, first, scaled(-1.0, way))
    step = Step(passed, 0.0, rules.gravity, rules.paper_mass)
    rate = contact_force(pair, bodies, cores, planes, pairs, laws, step, scratch, reactions, True)
    if passed > 0.0 and plans.interval[pair] > 0.0:
        put(bodies.velocity, first, velocity)
        put(bodies.half_spin, first, spin)
        if second >= 0:
            put(bodies.velocity, second, other_velocity)
            put(bodies.half_spin, second, other_spin)
    return rate


@kernel
def meet(
    pair: int, bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, scratch: Scratch,
    reactions: Reactions, flight: Flight, plans: Plans, agenda: Agenda, now: float, rules: Rules,
) -> int:  # fmt: skip
    """Look at a pair, kick its bodies if they touch, and plan when to look again; return DONE, or what is lacking.

    Writes to bodies, pairs, scratch, reactions, flight, plans and agenda.
    """
    first, second = pairs.first[pair], pairs.second[pair]
    for member in (first, second):
        if member >= 0:
            fly_to(bodies, flight, member, now, rules)
    if not list_features(pair, bodies, cores, planes, pairs, scratch, flight, plans, rules):
        return FEATURES_OVERFLOW
    passed = now - plans.last[pair]
    plans.last[pair] = now
    if pairs.feature_count[pair] == 0 and pairs.overlap[pair] == 0.0:
        plans.interval[pair] = 0.0
        flight.stats[5] += 1
        plan_far(pair, bodies, pairs, flight, plans, agenda, now, rules)
        return DONE
    touched = pairs.overlap[pair] > 0.0
    if not touched:
        approach = approach_of(pair, bodies, cores, planes, pairs, flight, rules)
        if approach.gap > 0.0:
            # What is about to touch may do so by a step's motion, as what touches moves by that.
            wait = max(approach.time, near_interval(pair, plans, approach.speed, rules))
            plans.interval[pair] = 0.0
            flight.stats[6] += 1
            put_on(agenda, len(bodies.mass) + pair, now + min(wait, longest_turn(bodies, flight, first, second)))
            return DONE
    force, torque, second_torque = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    if touched:
        force, torque = row(reactions.force, pair), row(reactions.first_torque, pair)
        second_torque = row(reactions.second_torque, pair)
    predict(bodies, first, -1.0, force, torque, 0.5 * passed)
    if second >= 0:
        predict(bodies, second, 1.0, force, second_torque, 0.5 * passed)
    rate = forces_after(
        pair, bodies, cores, planes, pairs, laws, scratch, reactions, plans, passed, rules
    )
    # The last kick reached half of the interval planned then; what came of it may have been shorter.
    planned = plans.interval[pair]
    early = 0.5 * (passed - planned) if touched else 0.0
    if pairs.overlap[pair] > 0.0:
        plans.inverse_mass[pair] = rate * pairs.overlap[pair] / (1.5 * pairs.elastic_force[pair])
        interval = touching_interval(pair, bodies, pairs, plans, rules)
        if touched and planned > 0.0 and rules.uneven * planned <= interval <= planned / rules.uneven:
            interval = planned
    else:
        interval = near_interval(pair, plans, closing_speed(bodies, flight, first, second), rules)
    plans.interval[pair] = interval
    if pairs.overlap[pair] > 0.0:
        flight.stats[0] += 1
        if touched and passed < planned * (1.0 - 1e-9):
            flight.stats[3] += 1
    elif touched:
        flight.stats[7] += 1
    else:
        flight.stats[4] += 1
    if touched or pairs.overlap[pair] > 0.0:
        impulse, moment, second_moment = scaled(early, force), scaled(early, torque), scaled(early, second_torque)
        if pairs.overlap[pair] > 0.0:
            time = 0.5 * (min(passed, interval) + interval) if not touched else 0.5 * (passed + interval)
            impulse = plus(impulse, scaled(time, row(reactions.force, pair)))
            moment = plus(moment, scaled(time, row(reactions.first_torque, pair)))
            second_moment = plus(second_moment, scaled(time, row(reactions.second_torque, pair)))
        kick_body(bodies, first, -1.0, impulse, moment)
        if second >= 0:
            kick_body(bodies, second, 1.0, impulse, second_moment)
    note_motion(pair, bodies, pairs, plans)
    put_on(agenda, len(bodies.mass) + pair, now + interval)
    for member in (first, second):
        if member >= 0 and has_changed(bodies, flight, member):
            replan(bodies, pairs, flight, plans, agenda, member, now, rules)
    return DONE


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
def add_pair(
    bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, flight: Flight, plans: Plans, agenda: Agenda, one: int,
    other: int, now: float,
) -> None:
    """List two as neighbours, due at once. Writes to pairs, flight, plans and agenda."""
    count = plans.free_count[0] - 1
    plans.free_count[0] = count
    pair = plans.free[count]
    first, second = (min(one, other), max(one, other)) if other >= 0 else (one, other)
    pairs.first[pair], pairs.second[pair] = first, second
    pairs.wake[pair], pairs.feature_count[pair] = 0.0, 0
    plans.last[pair], plans.interval[pair] = now, 0.0
    plans.duration[pair] = duration_of(bodies, planes, laws, flight, first, second)
    link(flight, plans, first, 2 * pair)
    if second >= 0:
        link(flight, plans, second, 2 * pair + 1)
    put_on(agenda, len(bodies.mass) + pair, now)


@kernel
def link(flight: Flight, plans: Plans, body: int, entry: int) -> None:
    """Enter a pair in the list of a body's. Writes to flight and plans."""
    plans.link[entry] = flight.head[body]
    flight.head[body] = entry


@kernel
def duration_of(bodies: Bodies, planes: Planes, laws: Laws, flight: Flight, first: int, second: int) -> float:
    """Return the duration of a collision of two times the fifth root of its speed, see timestep.contact_duration."""
    here, there = bodies.material[first], planes.material[-1 - second] if second < 0 else bodies.material[second]
    inverse, curvature = 1.0 / flight.mass[first], bodies.curvature[first]
    if second >= 0:
        inverse, curvature = inverse + 1.0 / flight.mass[second], curvature + bodies.curvature[second]
    modulus, ratio = laws.young_modulus[here, there], laws.damping_ratio[here, there]
    return 2.868 * (curvature / (inverse * modulus) ** 2) ** 0.2 / max(1.0, 2.0 * ratio)


@large_kernel
def search(
    bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, flight: Flight, plans: Plans, agenda: Agenda, body: int,
    now: float, rules: Rules,
) -> int:  # fmt: skip
    """List the neighbours of a body anew; return DONE, or what is lacking.

    Writes to bodies, pairs, flight, plans and agenda.
    """
    fly_to(bodies, flight, body, now, rules)
    if not np.isfinite(bodies.travel[body]):
        return DIVERGED
    here, reach = row(bodies.position, body), bodies.bounding_radius[body] + rules.skin
    entry, n = flight.head[body], len(bodies.mass)
    while entry >= 0:
        after, pair = plans.link[entry], entry >> 1
        other = pairs.second[pair] if pairs.first[pair] == body else pairs.first[pair]
        if gap_to(bodies, planes, flight, here, other, now, rules) > reach and pairs.overlap[pair] == 0.0:
            forget(pairs, flight, plans, agenda, n, pair)
        elif other >= 0:
            flight.stamp[other] = body
        entry = after
    for other in range(n):
        if other == body:
            continue
        if flight.stamp[other] == body:
            flight.stamp[other] = -1
        elif gap_to(bodies, planes, flight, here, other, now, rules) < reach:
            if plans.free_count[0] == 0:
                return PAIRS_FULL
            add_pair(bodies, planes, pairs, laws, flight, plans, agenda, body, other, now)
    for plane in range(len(planes.offset)):
        if planes.meets[plane, body] and gap_to(bodies, planes, flight, here, -1 - plane, now, rules) < reach:
            if not meets_plane(pairs, flight, plans, body, -1 - plane):
                if plans.free_count[0] == 0:
                    return PAIRS_FULL
                add_pair(bodies, planes, pairs, laws, flight, plans, agenda, body, -1 - plane, now)
    bodies.travel_listed[body] = bodies.travel[body]
    plan_search(bodies, flight, agenda, body, now, rules)
    return DONE


@kernel
def meets_plane(pairs: Pairs, flight: Flight, plans: Plans, body: int, plane: int) -> bool:
    """Tell whether a body and a plane are listed as neighbours."""
    entry = flight.head[body]
    while entry >= 0:
        if pairs.second[entry >> 1] == plane:
            return True
        entry = plans.link[entry]
    return False


@kernel
def gap_to(
    bodies: Bodies, planes: Planes, flight: Flight, here: Vector, other: int, now: float, rules: Rules
) -> float:
    """Return how far a place is from the bounding sphere of a body where it is now, or from a plane [m]."""
    if other < 0:
        return dot(row(planes.normal, -1 - other), here) - planes.offset[-1 - other]
    time = now - flight.time[other]
    way, fall = time, 0.5 * time * time
    velocity = row(bodies.velocity, other)
    if rules.drag > 0.0:
        way = (1.0 - np.exp(-rules.drag * time)) / rules.drag
        fall = (time - way) / rules.drag
    there = plus(row(bodies.position, other), plus(scaled(way, velocity), scaled(fall, rules.gravity)))
    between = minus(there, here)
    return dot(between, between) ** 0.5 - bodies.bounding_radius[other]


@kernel
def forget(pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, body_count: int, pair: int) -> None:
    """Take a pair off the lists. Writes to pairs, flight, plans and agenda."""
    take_off(agenda, body_count + pair)
    unlink(flight, plans, pairs.first[pair], 2 * pair)
    if pairs.second[pair] >= 0:
        unlink(flight, plans, pairs.second[pair], 2 * pair + 1)
    pairs.first[pair], pairs.feature_count[pair] = -1, 0
    plans.free[plans.free_count[0]] = pair
    plans.free_count[0] += 1


@kernel
def record_force(
    pairs: Pairs, reactions: Reactions, flight: Flight, plans: Plans, watched: int, now: float, record: Floats
) -> None:
    """Note the largest force on the watched body, and when it was first and last touched. Writes to record."""
    force, touched, entry = (0.0, 0.0, 0.0), False, flight.head[watched]
    while entry >= 0:
        pair = entry >> 1
        if pairs.overlap[pair] > 0.0:
            touched = True
            force = plus(force, scaled(1.0 if entry & 1 else -1.0, row(reactions.force, pair)))
        entry = plans.link[entry]
    if touched:
        record[0] = max(record[0], dot(force, force) ** 0.5)
        if record[1] < 0.0:
            record[1] = now
        record[2] = now
    record[3] = 1.0 if touched else 0.0


@large_kernel
def advance_locally(
    bodies: Bodies, cores: Cores, planes: Planes, pairs: Pairs, laws: Laws, scratch: Scratch, reactions: Reactions,
    flight: Flight, plans: Plans, agenda: Agenda, end: float, watched: int, record: Floats, rules: Rules,
    counts: Integers,
) -> int:  # fmt: skip
    """Do all that is due up to an instant; return DONE, or what is lacking.

    Writes to bodies, pairs, scratch, reactions, flight, plans, agenda, record and counts.
    """
    n = len(bodies.mass)
    while agenda.size[0] > 0:
        item = agenda.heap[0]
        now = agenda.due[item]
        if now > end:
            break
        if item < n:
            counts[0] += 1
            reason = search(bodies, planes, pairs, laws, flight, plans, agenda, item, now, rules)
        else:
            counts[1] += 1
            pair = item - n
            reason = meet(
                pair, bodies, cores, planes, pairs, laws, scratch, reactions, flight, plans, agenda, now, rules
            )
            if reason == DONE and watched >= 0 and (pairs.first[pair] == watched or pairs.second[pair] == watched):
                record_force(pairs, reactions, flight, plans, watched, now, record)
        if reason != DONE:
            return reason
    return DONE


@large_kernel
def catch_up(bodies: Bodies, flight: Flight, end: float, rules: Rules) -> None:
    """Move all bodies to an instant before which nothing is due. Writes to bodies and flight."""
    for body in range(len(bodies.mass)):
        fly_to(bodies, flight, body, end, rules)
