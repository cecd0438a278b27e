"""Bodies that are slow beside the watched one, and out of its reach, are held: they stand still, as walls.

A held body keeps its momentum, and what its moving neighbours give it adds to that: once this makes it fast beside the
watched body, or that comes near, it goes on with it. So a blow frees as far as it reaches, and no momentum is lost.
What touches nothing is never held.
"""

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Pairs, Reactions
from lithobrake.dem.bodies.vectors import add, dot, plus, put, row, scaled, times, way_between
from lithobrake.dem.local_stepping.agenda import Agenda, Plans, put_on, replan, touches
from lithobrake.dem.local_stepping.free_motion import Flight, Rules, surface_speed
from lithobrake.vocabulary.array_types import Vector

# A body is held when it is slower than this part of the speed at which it would be let go again.
CALM = 0.5


@kernel
def give_impulse(bodies: Bodies, flight: Flight, body: int, sign: float, impulse: Vector, moment: Vector) -> None:
    """Add an impulse [N s] and a moment [N m s] to a body, or to what a held one will go on with.

    Writes to bodies and flight.
    """
    if flight.held[body]:
        add(flight.held_velocity, body, sign * bodies.inverse_mass[body], impulse)
        add(flight.held_momentum, body, sign, moment)
    else:
        add(bodies.velocity, body, sign * bodies.inverse_mass[body], impulse)
        add(bodies.angular_momentum, body, sign, moment)


@kernel
def kick_in_advance(pair: int, plans: Plans, now: float) -> float:
    """Return the time [s] from now for which a contact's last kick has already given its force."""
    return 0.5 * plans.interval[pair] - (now - plans.last[pair]) if plans.interval[pair] > 0.0 else 0.0


@kernel
def book_motion(
    bodies: Bodies, reactions: Reactions, flight: Flight, plans: Plans, body: int, now: float, sign: float
) -> None:
    """Book the energy of a body's motion as lost, or with sign -1 as gained, without what kicks gave in advance.

    The work of that is done only as the body moves on. Writes to bodies.
    """
    velocity, momentum = row(bodies.velocity, body), row(bodies.angular_momentum, body)
    entry = flight.head[body]
    while entry >= 0:
        pair, is_second = entry >> 1, entry & 1
        time = kick_in_advance(pair, plans, now) * (-1.0 if is_second else 1.0)
        torque = row(reactions.second_torque if is_second else reactions.first_torque, pair)
        velocity = plus(velocity, scaled(time * bodies.inverse_mass[body], row(reactions.force, pair)))
        momentum = plus(momentum, scaled(time, torque))
        entry = plans.link[entry]
    turning = dot(momentum, times(bodies.inverse_inertia, body, momentum))
    bodies.dragged[body] += sign * 0.5 * (bodies.mass[body] * dot(velocity, velocity) + turning)


@kernel
def suspend(
    pair: int, bodies: Bodies, pairs: Pairs, reactions: Reactions, flight: Flight, plans: Plans, agenda: Agenda,
    now: float,
) -> None:  # fmt: skip
    """Let a contact wait, and take back what its last kick gave in advance. Writes to bodies, flight, plans, agenda."""
    first, second, time = pairs.first[pair], pairs.second[pair], -kick_in_advance(pair, plans, now)
    impulse = scaled(time, row(reactions.force, pair))
    give_impulse(bodies, flight, first, -1.0, impulse, scaled(time, row(reactions.first_torque, pair)))
    if second >= 0:
        give_impulse(bodies, flight, second, 1.0, impulse, scaled(time, row(reactions.second_torque, pair)))
    plans.interval[pair] = 0.0
    put_on(agenda, len(bodies.mass) + pair, np.inf)


@kernel
def hold(
    bodies: Bodies, pairs: Pairs, reactions: Reactions, flight: Flight, plans: Plans, agenda: Agenda, body: int,
    now: float, rules: Rules,
) -> None:  # fmt: skip
    """Hold a body; its contacts with planes and other held bodies wait. Writes to bodies, flight, plans and agenda."""
    book_motion(bodies, reactions, flight, plans, body, now, 1.0)
    put(flight.held_velocity, body, row(bodies.velocity, body))
    put(flight.held_momentum, body, row(bodies.angular_momentum, body))
    put(bodies.velocity, body, (0.0, 0.0, 0.0))
    put(bodies.angular_momentum, body, (0.0, 0.0, 0.0))
    flight.held[body] = True
    replan(bodies, pairs, flight, plans, agenda, body, now, rules)
    put_on(agenda, body, np.inf)
    entry = flight.head[body]
    while entry >= 0:
        pair = entry >> 1
        other = pairs.second[pair] if pairs.first[pair] == body else pairs.first[pair]
        if other < 0 or flight.held[other]:
            suspend(pair, bodies, pairs, reactions, flight, plans, agenda, now)
        entry = plans.link[entry]


@kernel
def let_go(
    bodies: Bodies, pairs: Pairs, reactions: Reactions, flight: Flight, plans: Plans, agenda: Agenda, body: int,
    now: float, rules: Rules,
) -> None:  # fmt: skip
    """Let a held body go on with the momentum it has by now. Writes to bodies, flight, plans and agenda."""
    flight.held[body] = False
    put(bodies.velocity, body, row(flight.held_velocity, body))
    put(bodies.angular_momentum, body, row(flight.held_momentum, body))
    book_motion(bodies, reactions, flight, plans, body, now, -1.0)
    entry = flight.head[body]
    while entry >= 0:
        pair, item = entry >> 1, len(bodies.mass) + (entry >> 1)
        # A contact that waited has not slid all that time: its next step begins now.
        if agenda.due[item] == np.inf:
            plans.last[pair] = now
            put_on(agenda, item, now)
        entry = plans.link[entry]
    replan(bodies, pairs, flight, plans, agenda, body, now, rules)


@kernel
def is_stirred(bodies: Bodies, flight: Flight, body: int) -> bool:
    """Tell whether a held body has too much momentum to be held."""
    velocity, momentum = row(flight.held_velocity, body), row(flight.held_momentum, body)
    turning = bodies.turning_radius[body] * flight.turning[body] * dot(momentum, momentum) ** 0.5
    return dot(velocity, velocity) ** 0.5 + turning > flight.fastest_held[0]


@large_kernel
def hold_what_is_slow(
    bodies: Bodies, pairs: Pairs, reactions: Reactions, flight: Flight, plans: Plans, agenda: Agenda, watched: int,
    limit: float, reach: float, now: float, rules: Rules,
) -> None:  # fmt: skip
    """Hold what touches something, is slow, and has its centroid beyond a reach [m] of the watched body's.

    Slow: its surface, below CALM times a limit [m/s]. What comes near, or has momentum for more than the limit, is let
    go; with a limit of 0, all.
    All must have been moved to now [s]. Writes to bodies, flight, plans and agenda.
    """
    flight.fastest_held[0] = limit
    for body in range(len(bodies.mass)):
        between = way_between(bodies, watched, body)
        far = limit > 0.0 and dot(between, between) > reach * reach
        if flight.held[body]:
            if not far or is_stirred(bodies, flight, body):
                flight.time[body] = now
                let_go(bodies, pairs, reactions, flight, plans, agenda, body, now, rules)
        # What touches nothing flies, however slowly, and held it would hang above the ground.
        elif far and surface_speed(bodies, flight, body) < CALM * limit and touches(pairs, flight, plans, body):
            hold(bodies, pairs, reactions, flight, plans, agenda, body, now, rules)
