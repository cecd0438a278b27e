"""How long a step is: given, or a fiftieth of the shortest contact that the speeds at hand can make.

The largest step that is stable follows from the contacts themselves: stability.py.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lithobrake.dem.bodies.arrays import Floats
from lithobrake.dem.bodies.material import Material
from lithobrake.dem.bodies.rigid_body import Plane, RigidBody
from lithobrake.dem.law.material_pair import pair_law

# Steps in the shortest contact when a world chooses its own step.
STEPS_PER_CONTACT = 50.0
# Factor of the duration of an elastic Hertz collision, see contact_duration.
HERTZ_DURATION = 2.868


def checked_step(time_step: float, allowed: str = "a finite value above 0") -> float:
    """Return a time step [s]. Raises ValueError for one that is not finite and positive; `allowed` says what is."""
    if not 0.0 < time_step < math.inf:
        raise ValueError(f"World time_step is {time_step!r} s; allowed is {allowed}: change it")
    return float(time_step)


def checked_count(steps: float) -> int:
    """Return a number of steps. Raises ValueError for one that is not whole, or below 0."""
    if steps != int(steps) or steps < 0:
        raise ValueError(f"World.run steps is {steps!r}; allowed is a whole number of at least 0: change it")
    return int(steps)


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
        if duration is None or not 0.0 <= duration < math.inf:
            raise ValueError(
                f"World.run duration is {duration!r} s; allowed is a finite value of at least 0: change it"
            )
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
        raise ValueError("World time_step cannot be chosen while nothing moves or falls: give a time_step [s]")
    parts = [
        (part.material, mass, part.shape.contact_radius)
        for body in bodies
        for part, mass in zip(body.parts, body.smallest_masses_at_contact, strict=True)
    ]
    made_of = [plane.material for plane in planes]
    rules = options["shear_modulus_rule"], options["pair_rule"]
    duration = shortest_contact_duration(parts, made_of, speed, *rules)
    if duration == math.inf:
        raise ValueError("World time_step cannot be chosen while nothing can collide: give a time_step [s]")
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
