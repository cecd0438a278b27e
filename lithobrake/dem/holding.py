"""Bodies out of reach of the watched one are held: they stand still until it comes near, and act as walls meanwhile.

A held body keeps its momentum and goes on with it when it is let go. What touches nothing is never held.
"""

import numpy as np

from lithobrake.compiled import kernel, large_kernel
from lithobrake.dem.agenda import Agenda, put_on
from lithobrake.dem.arrays import Bodies, Pairs
from lithobrake.dem.contact_plans import Plans, replan, touches
from lithobrake.dem.free_flight import Flight, Rules, fly_to, spin_of
from lithobrake.dem.vectors import dot, minus, put, row


@kernel
def book_motion(bodies: Bodies, body: int, sign: float) -> None:
    """Book the energy of a body's motion as lost, or with sign -1 as gained. Writes to bodies."""
    velocity = row(bodies.velocity, body)
    turning = dot(row(bodies.angular_momentum, body), spin_of(bodies, body))
    bodies.dragged[body] += sign * 0.5 * (bodies.mass[body] * dot(velocity, velocity) + turning)


@kernel
def hold(
    bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, body: int, now: float, rules: Rules
) -> None:
    """Hold a body; its contacts with planes and other held bodies wait. Writes to bodies, flight, plans and agenda."""
    book_motion(bodies, body, 1.0)
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
            plans.interval[pair] = 0.0
            put_on(agenda, len(bodies.mass) + pair, np.inf)
        entry = plans.link[entry]


@kernel
def let_go(
    bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, body: int, now: float, rules: Rules
) -> None:
    """Let a held body go on as it went before. Writes to bodies, flight, plans and agenda."""
    flight.held[body] = False
    put(bodies.velocity, body, row(flight.held_velocity, body))
    put(bodies.angular_momentum, body, row(flight.held_momentum, body))
    book_motion(bodies, body, -1.0)
    entry = flight.head[body]
    while entry >= 0:
        pair, item = entry >> 1, len(bodies.mass) + (entry >> 1)
        if agenda.due[item] == np.inf:
            plans.last[pair] = now
            put_on(agenda, item, now)
        entry = plans.link[entry]
    replan(bodies, pairs, flight, plans, agenda, body, now, rules)


@large_kernel
def hold_what_is_far(
    bodies: Bodies, pairs: Pairs, flight: Flight, plans: Plans, agenda: Agenda, watched: int, reach: float,
    now: float, rules: Rules,
) -> None:  # fmt: skip
    """Hold what touches something and has its centroid out of reach [m] of the watched body's, and let go what has not.

    All bodies must have been moved to now [s]. Writes to bodies, flight, plans and agenda.
    """
    here = row(bodies.position, watched)
    for body in range(len(bodies.mass)):
        between = minus(row(bodies.position, body), here)
        far = dot(between, between) > reach * reach
        if flight.held[body]:
            if not far:
                flight.time[body] = now
                let_go(bodies, pairs, flight, plans, agenda, body, now, rules)
        elif far and touches(pairs, flight, plans, body):
            fly_to(bodies, flight, body, now, rules)
            hold(bodies, pairs, flight, plans, agenda, body, now, rules)
