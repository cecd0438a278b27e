"""What a change of a force that acts on a body does to its motion."""

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import Bodies
from lithobrake.dem.bodies.vectors import add, put
from lithobrake.dem.local_stepping.free_motion import Flight
from lithobrake.vocabulary.array_types import Vector


@kernel
def push(bodies: Bodies, flight: Flight, body: int, sign: float, time: float, force: Vector, torque: Vector) -> None:
    """Change the force and torque on a body, from a time [s] ago on in the mean. Writes to bodies."""
    add(bodies.force, body, sign, force)
    add(bodies.torque, body, sign, torque)
    if not flight.held[body]:
        add(bodies.velocity, body, sign * time * bodies.inverse_mass[body], force)
        add(bodies.angular_momentum, body, sign * time, torque)


@kernel
def count_contact(bodies: Bodies, flight: Flight, body: int, planned: float, interval: float) -> None:
    """Count a contact that has begun or ended; what touches nothing feels exactly nothing.

    Writes to bodies and flight.
    """
    if planned == 0.0 and interval > 0.0:
        flight.touching[body] += 1
    elif planned > 0.0 and interval == 0.0:
        flight.touching[body] -= 1
        if flight.touching[body] == 0:
            put(bodies.force, body, (0.0, 0.0, 0.0))
            put(bodies.torque, body, (0.0, 0.0, 0.0))
