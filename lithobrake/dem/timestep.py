"""How long the shortest contact lasts: what a time step is measured by."""

import math

import numpy as np

from lithobrake.dem.arrays import Floats
from lithobrake.dem.material import Material, pair_law
from lithobrake.dem.rigid_body import Plane, RigidBody

# Steps in the shortest contact when a world chooses its own step.
STEPS_PER_CONTACT = 50.0
# Factor of the duration of an elastic Hertz collision, see contact_duration.
HERTZ_DURATION = 2.868


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
    Strong damping (restitution below about .3) counts as shortening, in proportion.
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
    parts = [(b.material, b.smallest_mass_at_contact, b.shape.contact_radius) for b in bodies]
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
    reach = np.array([body.shape.bounding_radius for body in bodies])
    speed = np.linalg.norm(velocity, axis=1) + np.linalg.norm(spin, axis=1) * reach
    down = gravity / max(float(np.linalg.norm(gravity)), np.finfo(float).tiny)
    points = np.vstack(
        [position - reach[:, None] * down, position + reach[:, None] * down, *(plane.point for plane in planes)]
    )
    fall = float(np.ptp(points @ gravity))
    relative = 2.0 * float(speed.max()) if len(speed) > 1 else float(speed.max())
    return max(relative, math.sqrt(2.0 * fall))
