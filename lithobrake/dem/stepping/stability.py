"""How stiffly its contacts hold a body: what the time step must be short against.

A mode of frequency w [rad/s] and damping rate c [1/s] is stepped stably by the scheme of motion.py while
c dt + (w dt)^2 / 4 <= 1: there the root of its recurrence, 2 z (z - 1)^2 + 2 (w dt)^2 z^2 + 2 c dt z (z - 1)
+ c dt (z - 1)^2 = 0, leaves the unit circle at z = -1. No mode of bodies joined by contacts is faster than what the
contacts of two that touch add up to.

Source: [Anderson-1985], for the bound by two neighbours.
"""

import math
from typing import NamedTuple

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Floats, Laws, Pairs, Planes, Step
from lithobrake.dem.bodies.period import arm_to
from lithobrake.dem.bodies.vectors import Vector, dot, minus, plus, row, times
from lithobrake.dem.law.contact_motion import inverse_inertia_across, inverse_mass_at
from lithobrake.dem.law.material_pair import PairLaw, law_between

# Largest c dt + (w dt)^2 / 4 that is allowed; 1 is the limit of stability.
STABLE_FRACTION = 0.8
# Steps from look to look while no contact turns farther in a step than this phase [rad]; t_c / 50 turns by <= 0.08.
LOOK_STEPS, LOOK_PHASE = 16, 0.2


class ContactStiffness(NamedTuple):
    """How a contact holds its bodies against small changes."""

    normal: float  # N/m
    shear: float  # N/m
    tilt: float  # N m
    normal_dashpot: float  # N s/m
    shear_dashpot: float  # N s/m
    tilt_dashpot: float  # N m s


class ContactRates(NamedTuple):
    """A contact, and what it meets of its two bodies."""

    stiffness: ContactStiffness
    ours: Vector  # 1/kg along and across the normal, 1/(kg m2) for couples, of the first
    theirs: Vector  # the same of the second


@kernel
def inverse_masses(bodies: Bodies, body: int, arm: Vector, normal: Vector) -> tuple[float, float, float]:
    """Return what forces along and across (mean of both directions) the normal meet at an arm, 1/kg, and what couples
    across it meet in the mean, 1/(kg m2).
    """
    along = inverse_mass_at(bodies, body, arm, normal, False)
    couple = inverse_inertia_across(bodies, body, -1, normal)
    inverse, mass = bodies.inverse_inertia, bodies.inverse_mass[body]
    trace = inverse[body, 0, 0] + inverse[body, 1, 1] + inverse[body, 2, 2]
    turning_all_ways = trace * dot(arm, arm) - dot(arm, times(inverse, body, arm))
    return along, mass + 0.5 * (turning_all_ways - (along - mass)), couple


@kernel
def contact_stiffness(pair: int, pairs: Pairs, inverse_mass: float, couple: float, law: PairLaw) -> ContactStiffness:
    """Return how a pair that touches holds its bodies; inverse_mass and couple are what both show it together."""
    secant = pairs.elastic_force[pair] / pairs.overlap[pair]
    dashpot = 2.0 * law.damping_ratio * (1.25 * secant / inverse_mass) ** 0.5
    tilt, roll = pairs.tilt_stiffness[pair], pairs.roll_stiffness[pair]
    # The weights of tilting are at least 1.5 + 7 times those of its dashpot.
    tilt_dashpot = dashpot * tilt / (8.5 * secant) + 2.0 * law.damping_ratio * (roll / couple) ** 0.5
    shear_dashpot = dashpot * law.shear_damping
    return ContactStiffness(
        1.5 * secant, pairs.tangential_stiffness[pair], tilt + roll, dashpot, shear_dashpot, tilt_dashpot
    )


@kernel
def add_contact_rates(
    rates: Floats, body: int, stiffness: ContactStiffness, masses: tuple[float, float, float]
) -> None:
    """Add what a contact does to a body's w^2 and c, in the fastest of its directions. Writes to rates."""
    along, sideways, couple = masses
    rates[body, 0] += max(stiffness.normal * along + stiffness.tilt * couple, stiffness.shear * sideways)
    rates[body, 1] += max(
        stiffness.normal_dashpot * along + stiffness.tilt_dashpot * couple, stiffness.shear_dashpot * sideways
    )


@kernel
def pair_rates(pair: int, bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, paper_mass: bool) -> ContactRates:
    """Return what a contact that touches does to each of its bodies, as if there were no other."""
    first, second = pairs.first[pair], pairs.second[pair]
    point, normal = row(pairs.point, pair), row(pairs.normal, pair)
    ours = inverse_masses(bodies, first, minus(point, row(bodies.position, first)), normal)
    theirs = (0.0, 0.0, 0.0)
    inverse_mass = bodies.inverse_mass[first] if paper_mass else ours[0]
    if second >= 0:
        theirs = inverse_masses(bodies, second, arm_to(bodies, second, point), normal)
        inverse_mass += bodies.inverse_mass[second] if paper_mass else theirs[0]
    law = law_between(pair, bodies, planes, pairs, laws)
    stiffness = contact_stiffness(pair, pairs, inverse_mass, ours[2] + theirs[2], law)
    return ContactRates(stiffness, ours, theirs)


@large_kernel
def write_rates(bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, paper_mass: bool) -> None:
    """Sum up for every body how its contacts hold it. Writes to bodies."""
    bodies.rates[:] = 0.0
    for pair in range(len(pairs.first)):
        if pairs.overlap[pair] == 0.0:
            continue
        rates = pair_rates(pair, bodies, planes, pairs, laws, paper_mass)
        add_contact_rates(bodies.rates, pairs.first[pair], rates.stiffness, rates.ours)
        if pairs.second[pair] >= 0:
            add_contact_rates(bodies.rates, pairs.second[pair], rates.stiffness, rates.theirs)


@kernel
def pair_step(
    pair: int, bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, paper_mass: bool, fraction: float
) -> float:
    """Return the step [s] at which c dt + (w dt)^2 / 4 of one contact alone comes to a fraction."""
    rates = pair_rates(pair, bodies, planes, pairs, laws, paper_mass)
    (along, sideways, couple), held = plus(rates.ours, rates.theirs), rates.stiffness
    square = max(held.normal * along + held.tilt * couple, held.shear * sideways)
    damping = max(held.normal_dashpot * along + held.tilt_dashpot * couple, held.shear_dashpot * sideways)
    most = damping + (damping * damping + fraction * square) ** 0.5
    return 2.0 * fraction / most if most > 0.0 else math.inf


@large_kernel
def largest_step(bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, paper_mass: bool) -> float:
    """Return the largest safe time step [s], infinite where nothing touches: there c dt + (w dt)^2 / 4 of two that
    touch comes to the fraction that is allowed.

    Writes to bodies.
    """
    write_rates(bodies, planes, pairs, laws, paper_mass)
    rates, most = bodies.rates, 0.0
    for pair in range(len(pairs.first)):
        if pairs.overlap[pair] > 0.0:
            first, second = pairs.first[pair], pairs.second[pair]
            square, damping = rates[first, 0], rates[first, 1]
            if second >= 0:
                square, damping = square + rates[second, 0], damping + rates[second, 1]
            most = max(most, damping + (damping * damping + STABLE_FRACTION * square) ** 0.5)
    return 2.0 * STABLE_FRACTION / most if most > 0.0 else math.inf


@kernel
def step_is_too_large(
    bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, step: Step, taken: int, rate: float
) -> bool:
    """Whether the step is too large; looks at every so many steps, and where a contact alone turns far in one: `rate`
    is the largest square of a rate [1/s2].

    Writes to bodies.
    """
    if taken % LOOK_STEPS > 0 and rate * step.time_step * step.time_step < LOOK_PHASE * LOOK_PHASE:
        return False
    return step.time_step > largest_step(bodies, planes, pairs, laws, step.paper_mass)
