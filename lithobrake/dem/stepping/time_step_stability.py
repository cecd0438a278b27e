"""How long a time step may be: from the shortest contact, and how stiffly contacts hold a body."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lithobrake.compilation.compiled import kernel, large_kernel
from lithobrake.dem.bodies.arrays import Bodies, Laws, Pairs, Planes, Step, curvature_of
from lithobrake.dem.bodies.rigid_body import Plane, RigidBody
from lithobrake.dem.bodies.vectors import arm_to, dot, minus, plus, row, times
from lithobrake.dem.law.contact_motion import inverse_inertia_across, inverse_mass_at
from lithobrake.dem.law.hertz_spring import dashpot_along
from lithobrake.dem.law.restitution import PairLaw, law_between, pair_law
from lithobrake.vocabulary.array_types import Floats, Vector
from lithobrake.vocabulary.field_errors import FieldError, field_number, value_within
from lithobrake.vocabulary.material_properties import Material

# Steps in the shortest contact when a world chooses its own step.
STEPS_PER_CONTACT = 50.0
# Factor of the duration of an elastic Hertz collision, see contact_duration.
HERTZ_DURATION = 2.868
# Largest c dt + (w dt)^2 / 4 that is allowed; 1 is the limit of stability.
STABLE_FRACTION = 0.8
# Steps from look to look while no contact turns farther in a step than this phase [rad]; t_c / 50 turns by <= 0.08.
LOOK_STEPS, LOOK_PHASE = 16, 0.2


# Of one call [s], and its steps: 30 years, which no contact of microseconds is followed over.
LONGEST_RUN, MOST_STEPS = 1e9, 1e12


def checked_step(time_step: float, allowed: str = "is a finite value above 0") -> float:
    """Return a time step [s]. Raises ValueError for one that is not finite and positive; `allowed` says what is."""
    return field_number("World.time_step", time_step, allowed, "s", above=0.0)


def checked_count(count: float, name: str = "World.run steps", least: int = 0, most: float = MOST_STEPS) -> int:
    """Return a number of steps, or of another name. Raises ValueError for one that is not whole, or out of range."""
    allowed = f"is a whole number from {least} to {most:g}"
    number = field_number(name, count, allowed)
    if number % 1.0 != 0.0 or not least <= number <= most:
        raise FieldError(name, count, allowed)
    return int(number)


@dataclass
class Clock:
    """Simulated time and the step that advances it: one that was given stays, a chosen one until something is added."""

    time: float  # s
    given_time_step: float | None  # s; None: to be chosen
    time_step: float | None  # s, in use; None: not chosen yet

    def give(self, time_step: float) -> None:
        """Take steps of this length [s] from now on. Raises ValueError for one that is not finite and positive."""
        self.time_step = self.given_time_step = checked_step(time_step)

    def choose_anew(self) -> None:
        """Let go of a step that was chosen for what there was before."""
        self.time_step = self.given_time_step

    def steps_in(self, duration: float | None, chosen: Callable[[], float]) -> int:
        """Return the number of steps in a duration [s]; one not yet `chosen` [s] is made to fit into it.

        Raises ValueError for a duration that is not finite, or below 0.
        """
        allowed = value_within(0.0, LONGEST_RUN)
        duration = field_number("World.run duration", duration, allowed, "s")
        if not 0.0 <= duration <= LONGEST_RUN:
            raise FieldError("World.run duration", duration, allowed, unit="s")
        if duration == 0.0:
            return 0
        if self.time_step is None:
            self.time_step = duration / math.ceil(duration / chosen())
        return round(duration / self.time_step)


def contact_duration(mass: float, radius: float, young_modulus: float, speed: float) -> float:
    """Return the duration [s] of an elastic Hertz collision from effective mass, radius and modulus (SI).

    Source: [Hertz-1882]; [Johnson-1985], Eq 11.24, for F = 4/3 E* sqrt(R*) overlap^(3/2).
    """
    return HERTZ_DURATION * (mass * mass / (radius * young_modulus**2 * speed)) ** 0.2


def shortest_contact_duration(
    bodies: list[tuple[Material, float, float]],
    planes: list[Material],
    speed: float,
    shear_modulus_rule: str,
    pair_rule: str,
) -> float:
    """Return the duration [s] of the shortest possible collision at a speed [m/s], between bodies or with planes.

    bodies holds material, smallest mass at contact [kg] and contact radius [m] of each. Infinite where none can meet.
    Strong damping (restitution below about 0.3) counts as shortening, in proportion.
    """
    # Of each material only the lightest and the smallest matter, so pairs of materials are tried and not pairs of
    # thousands of grains.
    smallest: dict[Material, tuple[float, float, int]] = {}
    for material, mass, radius in bodies:
        known_mass, known_radius, count = smallest.get(material, (math.inf, math.inf, 0))
        smallest[material] = (min(mass, known_mass), min(radius, known_radius), count + 1)
    shortest = math.inf
    for material, (mass, radius, count) in smallest.items():
        partners = [(other, m, r) for other, (m, r, _) in smallest.items() if other != material or count > 1]
        partners += [(plane, math.inf, math.inf) for plane in planes]
        for other, other_mass, other_radius in partners:
            law = pair_law(material, other, shear_modulus_rule, pair_rule)
            pair_mass, pair_radius = 1.0 / (1.0 / mass + 1.0 / other_mass), 1.0 / (1.0 / radius + 1.0 / other_radius)
            duration = contact_duration(pair_mass, pair_radius, law.young_modulus, speed)
            # A dashpot above half of the critical damping is stiffer than its spring: explicit steps must follow it.
            shortest = min(shortest, duration / max(1.0, 2.0 * law.damping_ratio))
    return shortest


def shortest_contact(bodies: list[RigidBody], planes: list[Plane], options: dict[str, str], speed: float) -> float:
    """Return the duration [s] of the shortest collision of any of these bodies and planes at a relative speed [m/s].

    options: see material.contact_options. Raises ValueError for a speed of zero, and where no two things can meet.
    """
    if not speed > 0.0:
        raise ValueError("World.time_step cannot be chosen while nothing moves or falls: give a time_step [s]")
    parts = [
        (part.material, mass, part.shape.contact_radius)
        for body in bodies
        for part, mass in zip(body.parts, body.smallest_masses_at_contact, strict=True)
    ]
    made_of = [plane.material for plane in planes]
    rules = options["shear_modulus_rule"], options["pair_rule"]
    duration = shortest_contact_duration(parts, made_of, speed, *rules)
    if duration == math.inf:
        raise ValueError("World.time_step cannot be chosen while nothing can collide: give a time_step [s]")
    return duration


def meeting_speed_bound(
    position: Floats, velocity: Floats, spin: Floats, bodies: list[RigidBody], planes: list[Plane], gravity: Floats
) -> float:  # fmt: skip
    """Return a bound on the speeds [m/s] at which bodies meet: now, and after falling through all that there is.

    position, velocity, spin [body_count, 3] are those of the bodies.
    """
    reach = np.array([body.bounding_radius for body in bodies])
    speed = np.linalg.norm(velocity, axis=1) + np.linalg.norm(spin, axis=1) * reach
    down = gravity / max(float(np.linalg.norm(gravity)), np.finfo(float).tiny)
    points = np.vstack(
        [position - reach[:, None] * down, position + reach[:, None] * down, *(plane.point for plane in planes)]
    )
    fall = float(np.ptp(points @ gravity))
    relative = 2.0 * float(speed.max()) if len(speed) > 1 else float(speed.max())
    return max(relative, math.sqrt(2.0 * fall))


def chosen_step(
    position: Floats, velocity: Floats, spin: Floats, bodies: list[RigidBody], planes: list[Plane], gravity: Floats,
    options: dict[str, str],
) -> float:  # fmt: skip
    """Return the step [s] of a world that was given none; arguments of meeting_speed_bound and shortest_contact."""
    speed = meeting_speed_bound(position, velocity, spin, bodies, planes, gravity)
    return shortest_contact(bodies, planes, options, speed) / STEPS_PER_CONTACT


class ContactStiffness(NamedTuple):
    normal: float  # N/m
    shear: float  # N/m
    tilt: float  # N m
    normal_dashpot: float  # N s/m
    shear_dashpot: float  # N s/m
    tilt_dashpot: float  # N m s


class ContactRates(NamedTuple):
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
def contact_stiffness(
    pair: int, pairs: Pairs, inverse_mass: float, couple: float, radius: float, law: PairLaw
) -> ContactStiffness:
    """Return how a pair that touches holds its bodies; inverse_mass and couple are what both show it together.

    radius: R* [m].
    """
    secant = pairs.elastic_force[pair] / pairs.overlap[pair]
    dashpot = dashpot_along(law, secant, inverse_mass, radius)
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
    radius = 1.0 / curvature_of(pair, bodies, pairs)
    stiffness = contact_stiffness(pair, pairs, inverse_mass, ours[2] + theirs[2], radius, law)
    return ContactRates(stiffness, ours, theirs)


@large_kernel
def write_rates(bodies: Bodies, planes: Planes, pairs: Pairs, laws: Laws, paper_mass: bool) -> None:
    """Sum up for every body how its contacts hold it. Writes to bodies."""
    # All contacts of a body together: a light body clamped between two others has several, and each alone would let a
    # step pass at which it jitters.
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
