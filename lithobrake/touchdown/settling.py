"""When a bed is at rest, and how it gets there. Every criterion is relative to the weight and size of its grains."""

import math
from collections.abc import Callable

import numpy as np

from lithobrake.dem import Material, StepTooLargeError, World
from lithobrake.vocabulary.array_types import Floats

CONTACT_DAMPING = 0.1  # damping ratio of a grain's small oscillation while a bed takes on another gravity or material
FREE_FALL_DAMPING = 0.5  # drag while a bed comes to rest, in units of sqrt(gravity / diameter)
RAMP_PERIODS = 2.0  # time constant of a ramp of gravity, in periods of a grain at rest under the gravity it ends at
RAMP_STEPS = 20  # changes of gravity a time constant
RAMP_LEFT = 1e-3  # of the gravity it ends at, where a ramp makes its last step
KINETIC_RATIO = 1e-5  # of the energy that lifts every grain by its own diameter
UNBALANCED_FORCE = 1e-2  # of the mean contact force
PERIODS_HELD = 10.0  # settled: both hold for so many periods of a grain's small oscillation at its rest overlap
PERIODS_RELAXED = 5.0
PERIODS_PATIENCE = 1200.0  # after so many the bed is given up
QUIET_FRACTION = 0.95  # of the largest safe step, while nothing collides
QUIET_STEPS = 16  # between looks at what the largest safe step has become
TOO_LARGE = 2.0  # largest safe steps: one step so large changes the speed of a bounce by a few hundredths
CHECKS_PER_PERIOD = 5


class CreepingBedError(ValueError):
    """A bed whose grains lie, and in which one creeps on: it does not come to rest."""


def rest_period(material: Material, diameter: float, gravity: float) -> float:
    """Return the period [s] of a grain's small oscillation about its rest on another, under gravity [m/s2].

    Linearised Hertz: omega^2 = 3/2 g / overlap, with the overlap that carries the weight of one grain.
    """
    modulus = material.young_modulus / (2.0 * (1.0 - material.poisson_ratio**2))
    weight = material.density * math.pi / 6.0 * diameter**3 * gravity
    overlap = (0.75 * weight / (modulus * math.sqrt(diameter / 4.0))) ** (2.0 / 3.0)
    return 2.0 * math.pi * math.sqrt(overlap / (1.5 * gravity))


def contact_drag(period: float) -> float:
    """Return a drag [1/s] that damps a grain's small oscillation of a period [s]."""
    return 2.0 * CONTACT_DAMPING * 2.0 * math.pi / period


def free_fall_drag(gravity: float, diameter: float) -> float:
    """Return a drag [1/s] at which what nothing holds up still falls fast enough to be seen by the criteria of rest."""
    return FREE_FALL_DAMPING * math.sqrt(gravity / diameter)


def kinetic_ratio(world: World, diameter: float, gravity: float) -> float:
    """Return the kinetic energy over that of lifting all bodies by a diameter [m] under gravity [m/s2]."""
    return float(world.kinetic_energy.sum()) / (float(world.mass.sum()) * gravity * diameter)


def unbalanced_force(world: World) -> float:
    """Return the mean resultant force on a body over the mean contact force; infinite where nothing touches.

    Drag does not count: what it alone holds up is not at rest.
    """
    contacts = world.contacts()
    if len(contacts) == 0:
        return math.inf
    force = contacts["normal_force"][:, None] * contacts["normal"] + contacts["tangential_force"]
    # Summed up from the contacts and not read from the engine, whose forces hold the drag.
    resultant = world.mass[:, None] * world.gravity
    np.subtract.at(resultant, contacts["body_a"], force)
    on_body = contacts["body_b"] >= 0
    np.add.at(resultant, contacts["body_b"][on_body], force[on_body])
    carried = float(np.linalg.norm(force, axis=1).mean())
    return float(np.linalg.norm(resultant, axis=1).mean()) / carried if carried > 0.0 else math.inf


def run_quietly(world: World, chunk: float, longest: float = math.inf) -> None:
    """Run for a chunk [s] in steps that are safe for the contacts at their present overlaps.

    At least four, and none above the longest [s], which is for what touches nothing yet.
    """
    longest = min(longest, chunk / 4.0)
    left = chunk
    while left > 0.0:
        steps = math.ceil(left / min(longest, QUIET_FRACTION * world.largest_step))
        taken, start = min(steps, QUIET_STEPS), world.time
        world.time_step = left / steps
        try:
            world.run(steps=taken)
        except StepTooLargeError:
            # A grain that topples meets others harder than any touched at the last look: the next look knows it.
            if world.time_step > TOO_LARGE * world.largest_step:
                raise
            taken = round((world.time - start) / world.time_step)
        left *= (steps - taken) / steps


def ramp(world: World, gravity: Floats, period: float) -> None:
    """Bring the gravity of a world exponentially to another [m/s2], slowly against a grain's period [s] there.

    Changed at once, what was compressed would throw up the grains.
    """
    start = world.gravity.copy()
    change = float(np.linalg.norm(start - gravity) / np.linalg.norm(gravity))
    chunk = RAMP_PERIODS * period / RAMP_STEPS
    chunks = math.ceil(RAMP_STEPS * math.log(change / RAMP_LEFT)) if change > RAMP_LEFT else 0
    for k in range(1, chunks + 1):
        world.gravity = gravity + (start - gravity) * math.exp(-k / RAMP_STEPS) * (k < chunks)
        run_quietly(world, chunk)
    world.gravity = gravity.copy()


def rests(
    world: World,
    period: float,
    periods_held: float,
    at_rest: Callable[[], bool],
    each_check: Callable[[float], None] = lambda held: None,
) -> bool:
    """Run until the world has been at rest for so many periods [s]; tell whether it was within its patience.

    Calls each_check with the number of periods for which it has been at rest.
    """
    calm = 0
    for _ in range(int(PERIODS_PATIENCE * CHECKS_PER_PERIOD)):
        run_quietly(world, period / CHECKS_PER_PERIOD)
        calm = calm + 1 if at_rest() else 0
        each_check(calm / CHECKS_PER_PERIOD)
        if calm >= periods_held * CHECKS_PER_PERIOD:
            return True
    return False


def restless(world: World) -> str:
    return (
        f"the bed did not come to rest within {PERIODS_PATIENCE:.0f} periods of a grain's small oscillation under "
        f"{np.linalg.norm(world.gravity):.3g} m/s2: its slope may be too steep, its friction too low, or "
        "its gravity far from that it was made under; lower surface.slope_deg, raise grain.friction, or pour anew"
    )
