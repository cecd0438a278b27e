"""Bodies in motion under steady forces between two looks."""

from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies
from lithobrake.dem.bodies.orientation import turn_by
from lithobrake.dem.bodies.turning_frame import (
    TOLD_ANGLE,
    bulge,
    coasted,
    precess,
    precession,
    turn_in_frame,
    with_frame,
)
from lithobrake.dem.bodies.vectors import add, cross, dot, minus, plus, put, row, scaled, times
from lithobrake.vocabulary.array_types import Flags, Floats, Integers, Vector

# Largest angle [rad] by which a body turns freely at once.
LARGEST_TURN = 0.2


class Flight(NamedTuple):
    """Per body, between looks at its contacts."""

    time: Floats  # [body_count], s, to which it was last moved
    planned: Floats  # [body_count], s, when its pairs were planned
    velocity: Floats  # [body_count, 3], m/s, for which its pairs were planned
    momentum: Floats  # [body_count, 3], kg m2/s, the same
    force: Floats  # [body_count, 3], N, of its contacts, the same; of a held body, the one that its rest balances
    torque: Floats  # [body_count, 3], N m, the same
    slack: Floats  # [body_count], m/s, change of the speed of its surface for which the plans hold
    surge: Floats  # [body_count], m/s2, change of the acceleration of its surface for which they do
    touching: Integers  # [body_count], contacts that push it
    turning: Floats  # [body_count], 1/(kg m2), largest inverse moment of inertia
    slenderness: Floats  # [body_count], largest over smallest moment of inertia
    mobility: Floats  # [body_count], 1/kg, square of the surface's speed over twice the energy of the turning, at most
    mass: Floats  # [part_count], kg, smallest that a contact meets
    leader: Integers  # [body_count], body at the root of all that it is joined to, see joints.py; itself: not joined
    joints: Integers  # [body_count], joints that it is part of
    head: Integers  # [body_count], first entry of the list of its pairs, -1: none
    stamp: Integers  # [part_count + plane_count], by which a search tells what it has listed
    told: Floats  # [body_count], s, until when its spin knows how the frame turns
    held: Flags  # [body_count], see holding.py
    fastest_held: Floats  # [1], m/s, speed of its surface with which a held body is let go
    resolved_speed: Floats  # [1], m/s, of collisions that take all steps; slower ones take fewer


class Rules(NamedTuple):
    gravity: Vector  # m/s2
    rotation: Vector  # rad/s, of the frame
    rate: float  # rad/s, size of the rotation
    drag: float  # 1/s
    paper_mass: bool  # as in Step
    steps: float  # in the duration of a contact
    skin: float  # m, gap below which two are neighbours


@kernel
def spin_of(bodies: Bodies, body: int) -> Vector:
    """Return the angular velocity of a body [rad/s]."""
    return times(bodies.inverse_inertia, body, row(bodies.angular_momentum, body))


@large_kernel
def spin_size(bodies: Bodies, body: int) -> float:
    """Return the size of a body's angular velocity [rad/s]."""
    spin = spin_of(bodies, body)
    return dot(spin, spin) ** 0.5


@kernel
def spin_bound(bodies: Bodies, flight: Flight, body: int) -> float:
    """Return a bound on the size of a body's angular velocity [rad/s], however it tumbles; on a joint the one at hand,
    as a slender part would tumble 10 000 times as fast about its own axis.
    """
    momentum = row(bodies.angular_momentum, body)
    if flight.joints[body] > 0:
        return spin_size(bodies, body)
    return flight.turning[body] * dot(momentum, momentum) ** 0.5


@large_kernel
def swept(bodies: Bodies, flight: Flight, body: int, momentum: Vector) -> float:
    """Return a bound on the speed [m/s] that an angular momentum gives the surface of a body on a joint.

    By the energy of the turning, which free tumbling keeps. A change of the momentum, or a torque, may stand in its
    place.
    """
    return (flight.mobility[body] * max(0.0, dot(momentum, times(bodies.inverse_inertia, body, momentum)))) ** 0.5


@kernel
def turning_speed(bodies: Bodies, flight: Flight, body: int) -> float:
    """Return a bound on the speed of a body's surface by its spin alone [m/s]."""
    if flight.joints[body] > 0:
        return swept(bodies, flight, body, row(bodies.angular_momentum, body))
    return bodies.turning_radius[body] * spin_bound(bodies, flight, body)


@kernel
def surface_speed(bodies: Bodies, flight: Flight, body: int) -> float:
    """Return a bound on the speed of a body's surface [m/s]."""
    velocity = row(bodies.velocity, body)
    return dot(velocity, velocity) ** 0.5 + turning_speed(bodies, flight, body)


@kernel
def acceleration_of(bodies: Bodies, flight: Flight, body: int, rules: Rules) -> Vector:
    """Return the acceleration of a body under gravity and its contacts as they were last looked at [m/s2]."""
    if flight.held[body]:
        return (0.0, 0.0, 0.0)
    return plus(rules.gravity, scaled(bodies.inverse_mass[body], row(bodies.force, body)))


@kernel
def turning_rate(bodies: Bodies, flight: Flight, body: int, rules: Rules) -> float:
    """Return a bound on how fast contacts, and the frame, change the speed of a body's surface by its spin [m/s2]."""
    if flight.held[body]:
        return 0.0
    torque, radius = row(bodies.torque, body), bodies.turning_radius[body]
    bound = radius * flight.turning[body] * dot(torque, torque) ** 0.5
    if flight.joints[body] > 0:
        bound = swept(bodies, flight, body, torque)
    if rules.rate > 0.0:
        bound += radius * precession(flight.slenderness[body], spin_bound(bodies, flight, body), rules.rate)
    return bound


@kernel
def surge_bound(bodies: Bodies, flight: Flight, body: int, rules: Rules) -> float:
    """Return a bound on the acceleration of a body's surface while its plans hold [m/s2]."""
    along = acceleration_of(bodies, flight, body, rules)
    return dot(along, along) ** 0.5 + turning_rate(bodies, flight, body, rules) + flight.surge[body]


@kernel
def relative_surge(bodies: Bodies, flight: Flight, first: int, second: int, rules: Rules) -> float:
    """Return a bound on the acceleration of two surfaces against each other while their plans hold [m/s2]."""
    along = acceleration_of(bodies, flight, first, rules)
    bound = turning_rate(bodies, flight, first, rules) + flight.surge[first]
    if second >= 0:
        along = minus(along, acceleration_of(bodies, flight, second, rules))
        bound += turning_rate(bodies, flight, second, rules) + flight.surge[second]
    return bound + dot(along, along) ** 0.5


@kernel
def fly_to(bodies: Bodies, flight: Flight, body: int, now: float, rules: Rules) -> None:
    """Move a body under the steady forces of its contacts to an instant [s]. Writes to bodies and flight."""
    time = now - flight.time[body]
    if time <= 0.0:
        return
    flight.time[body] = now
    if flight.held[body]:
        flight.told[body] = now
        return
    before, spin = row(bodies.velocity, body), spin_bound(bodies, flight, body)
    sweep = turning_speed(bodies, flight, body) if flight.joints[body] > 0 else 0.0
    along = acceleration_of(bodies, flight, body, rules)
    after = fall(bodies, body, before, time, along, rules)
    # Under a steady torque the angular momentum moves on a straight line, as the velocity does.
    half = scaled(0.5 * time, row(bodies.torque, body))
    add(bodies.angular_momentum, body, 1.0, half)
    # In flight, with drag or without, the velocity moves on a straight line, on which its size is largest at an end.
    fastest = max(dot(before, before), dot(after, after)) ** 0.5
    begun, untold, tells = spin, now - flight.told[body], False
    if rules.rate > 0.0:
        fastest += bulge(before, after, along, time, rules.rate)
        spin += untold * precession(flight.slenderness[body], spin, rules.rate)
        tells = untold * rules.rate > TOLD_ANGLE
        if tells:
            precess(bodies, body, untold - time, rules.rotation)
            with_frame(bodies, body, 1.0, rules.rotation)
            flight.told[body] = now
    middle = spin_bound(bodies, flight, body)
    parts = 1 + int((middle + rules.rate) * time / LARGEST_TURN)
    for _ in range(parts):
        turn_freely(bodies, body, time / parts, tells, rules)
    if tells:
        with_frame(bodies, body, -1.0, rules.rotation)
    add(bodies.angular_momentum, body, 1.0, half)
    if flight.joints[body] > 0:
        precessed = spin - begun
        sweep = max(sweep, turning_speed(bodies, flight, body)) + bodies.turning_radius[body] * precessed
    else:
        sweep = bodies.turning_radius[body] * max(spin, spin_bound(bodies, flight, body))
    bodies.travel[body] += time * (fastest + sweep)


@kernel
def fall(bodies: Bodies, body: int, before: Vector, time: float, along: Vector, rules: Rules) -> Vector:
    """Move a body for a time [s] under an acceleration [m/s2], and drag or a turning frame; return its velocity then.

    Exact. Writes to bodies.
    """
    drag = rules.drag
    if rules.rate > 0.0:
        way, after = coasted(before, along, time, rules.rotation)
        add(bodies.position, body, 1.0, way)
    elif drag == 0.0:
        after = plus(before, scaled(time, along))
        add(bodies.position, body, time, plus(before, scaled(0.5 * time, along)))
    else:
        kept = np.exp(-drag * time)
        # What drag and gravity come to in the end.
        last = scaled(1.0 / drag, along)
        after = plus(last, scaled(kept, minus(before, last)))
        way = plus(scaled(time, last), scaled((1.0 - kept) / drag, minus(before, last)))
        add(bodies.position, body, 1.0, way)
        momentum = row(bodies.angular_momentum, body)
        # The motion is exact; the ledger takes the mean of the losses at both ends.
        turning = dot(momentum, spin_of(bodies, body)) * (1.0 + kept * kept)
        moving = bodies.mass[body] * (dot(before, before) + dot(after, after))
        bodies.dragged[body] += 0.5 * drag * time * (moving + turning)
        put(bodies.angular_momentum, body, scaled(kept, momentum))
    put(bodies.velocity, body, after)
    return after


@kernel
def turn_freely(bodies: Bodies, body: int, time: float, among_stars: bool, rules: Rules) -> None:
    """Turn a body freely for a time [s] by the spin at its middle, to the second order. Writes to bodies.

    among_stars: its angular momentum is that against the stars, under which the frame turns.
    """
    momentum, spin = row(bodies.angular_momentum, body), spin_of(bodies, body)
    if not bodies.isotropic[body]:
        # Euler's equations: the angular momentum stands still while the body turns under it.
        spin = plus(spin, scaled(0.5 * time, times(bodies.inverse_inertia, body, cross(momentum, spin))))
    if among_stars:
        turn_in_frame(bodies, body, spin, time, rules.rotation)
    else:
        turn_by(bodies, body, spin, time)


@kernel
def fly_all_to(bodies: Bodies, flight: Flight, now: float, rules: Rules) -> None:
    """Move all bodies to an instant [s] before which no contact is due. Writes to bodies and flight."""
    for body in range(len(bodies.mass)):
        fly_to(bodies, flight, body, now, rules)


@kernel
def place_at(bodies: Bodies, flight: Flight, body: int, now: float, rules: Rules) -> Vector:
    """Return where a body will be at an instant [s] unless its forces change before [m]."""
    if flight.held[body]:
        return row(bodies.position, body)
    time = now - flight.time[body]
    if rules.rate > 0.0:
        along = acceleration_of(bodies, flight, body, rules)
        return plus(row(bodies.position, body), coasted(row(bodies.velocity, body), along, time, rules.rotation)[0])
    way, drop = time, 0.5 * time * time
    drag = rules.drag
    if drag > 0.0:
        way = (1.0 - np.exp(-drag * time)) / drag
        drop = (time - way) / drag
    moved = plus(scaled(way, row(bodies.velocity, body)), scaled(drop, acceleration_of(bodies, flight, body, rules)))
    return plus(row(bodies.position, body), moved)


@kernel
def weight(rules: Rules) -> float:
    """Return the size of gravity [m/s2]."""
    return dot(rules.gravity, rules.gravity) ** 0.5


@kernel
def relative_weight(flight: Flight, first: int, second: int, rules: Rules) -> float:
    """Return a bound on the acceleration [m/s2] with which two fall against each other: none where both are held.

    Of two that move freely, one may fly while the other rests on a third.
    """
    both_held = second >= 0 and flight.held[first] and flight.held[second]
    return 0.0 if both_held else weight(rules)
