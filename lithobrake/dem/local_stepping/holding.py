"""Bodies that are slow beside the watched one, and out of its reach, are held: they stand still, as walls.

What moves a body that is held is lost with its motion, and the forces that act on it then count as balanced. It is let
go when they have changed by more than a part of its weight, or the watched body comes near.
What touches nothing is never held.
"""

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Pairs
from lithobrake.dem.bodies.vectors import dot, minus, put, row, times, way_between
from lithobrake.dem.local_stepping.agenda import Agenda, Plans, put_on, replan, touches
from lithobrake.dem.local_stepping.free_motion import Flight, Rules, spin_of

# Part of its weight that its contacts carry of a body that is held, and less than which lets it go.
CARRIED, DROPPED = 0.5, 0.3


@kernel
def hold(
    bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, body: int, now: float, rules: Rules
) -> None:  # fmt: skip
    """Hold a body; its contacts with planes and other held bodies wait. Writes to bodies, flight and agenda."""
    velocity, momentum = row(bodies.velocity, body), row(bodies.angular_momentum, body)
    turning = dot(momentum, times(bodies.inverse_inertia, body, momentum))
    bodies.dragged[body] += 0.5 * (bodies.mass[body] * dot(velocity, velocity) + turning)
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
            put_on(agenda, len(bodies.mass) + pair, np.inf)
        entry = plans.link[entry]


@kernel
def let_go(
    bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, body: int, now: float, rules: Rules
) -> None:  # fmt: skip
    """Let a held body go on from rest. Writes to flight, plans and agenda."""
    flight.held[body] = False
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
def speed_of_surface(bodies: Bodies, body: int) -> float:
    """Return the speed of a body's centroid and that of its farthest point about it, summed [m/s]."""
    velocity, spin = row(bodies.velocity, body), spin_of(bodies, body)
    return dot(velocity, velocity) ** 0.5 + bodies.turning_radius[body] * dot(spin, spin) ** 0.5


@kernel
def carries(bodies: Bodies, body: int, rules: Rules, part: float) -> bool:
    """Tell whether contacts carry more than a part of the weight of a body."""
    against = dot(row(bodies.force, body), rules.gravity) * bodies.inverse_mass[body]
    return against < -part * dot(rules.gravity, rules.gravity)


@kernel
def is_stirred(pair: int, bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, body: int, rules: Rules) -> bool:
    """Tell whether a contact that was looked at moves a held body, or what carries the body has gone.

    A blow is a half sine of the contact's rate: it leaves a body with twice its greatest force over mass and rate.
    """
    if not carries(bodies, body, rules, DROPPED):
        return True
    force, torque = minus(row(bodies.force, body), row(flight.force, body)), row(flight.torque, body)
    torque, overlap = minus(row(bodies.torque, body), torque), pairs.overlap[pair]
    turning = bodies.turning_radius[body] * flight.turning[body] * dot(torque, torque) ** 0.5
    change = bodies.inverse_mass[body] * dot(force, force) ** 0.5 + turning
    square = 1.5 * pairs.elastic_force[pair] * plans.inverse_mass[pair]
    return overlap > 0.0 and 4.0 * change * change * overlap > square * flight.fastest_held[0] ** 2


@large_kernel
def hold_what_is_slow(
    bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, watched: int, calm: float,
    limit: float, reach: float, now: float, rules: Rules,
) -> None:  # fmt: skip
    """Hold what touches something, is slow, and has its centroid beyond a reach [m] of the watched body's.

    calm: speed of its surface [m/s] below which it is slow; limit: with which a blow has it let go [m/s]. What comes
    near is let go; with a limit of 0, all.
    All must have been moved to now [s]. Writes to bodies, flight, plans and agenda.
    """
    flight.fastest_held[0] = limit
    for body in range(len(bodies.mass)):
        between = way_between(bodies, watched, body)
        far = limit > 0.0 and dot(between, between) > reach * reach
        if flight.held[body]:
            if not far:
                flight.time[body] = now
                let_go(bodies, pairs, flight, plans, agenda, body, now, rules)
        # What touches nothing flies, however slowly, and held it would hang above the ground; what has a joint swings.
        elif (
            far and flight.joints[body] == 0 and speed_of_surface(bodies, body) < calm
            and touches(pairs, flight, plans, body) and carries(bodies, body, rules, CARRIED)
        ):  # fmt: skip
            hold(bodies, pairs, flight, plans, agenda, body, now, rules)
