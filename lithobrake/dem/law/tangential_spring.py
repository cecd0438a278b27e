"""Springs with history: what rubs and what rolls is held by a spring and a dashpot, up to a limit.

The spring turns with the contact, loses force when its stiffness falls, and books as lost what it was given and did not
keep: by sliding, and by changes of its stiffness.
"""

from typing import NamedTuple

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.vectors import cross, dot, minus, plus, scaled
from lithobrake.vocabulary.array_types import Vector


class SpringForce(NamedTuple):
    spring: Vector  # N or N m, force of the spring alone
    total: Vector  # with the dashpot's
    slid: float  # J, lost by the spring
    damped: float  # W, lost in the dashpot, and by the limit on the total


@kernel
def turned_spring(spring: Vector, normal_before: Vector, normal: Vector, twist: float) -> Vector:
    """Return a spring's force turned with the contact frame: with the normal, and by an angle about it."""
    square = dot(spring, spring)
    if square == 0.0:
        return spring
    turn = plus(cross(normal_before, normal), scaled(twist, normal))
    spring = plus(spring, cross(turn, spring))
    spring = minus(spring, scaled(dot(spring, normal), normal))
    # A turn to first order lengthens the spring, and would give it energy from nowhere: its length is put back.
    left = dot(spring, spring)
    return scaled((square / left) ** 0.5, spring) if left > 0.0 else (0.0, 0.0, 0.0)


@kernel
def unloaded(stiffness_before: float, stiffness: float) -> float:
    """Return what is left of a spring's force when its stiffness falls: so no cycle of loading gains energy."""
    return min(1.0, stiffness / stiffness_before) if stiffness_before > 0.0 else 1.0


@kernel
def stored(force_squared: float, stiffness: float) -> float:
    return 0.5 * force_squared / stiffness if stiffness > 0.0 else 0.0


@kernel
def clipped(vector: Vector, limit: float) -> Vector:
    square = dot(vector, vector)
    return vector if square <= limit * limit else scaled(limit / square**0.5, vector)


@kernel
def spring_force(
    before: Vector, stiffness_before: float, stiffness: float, way: Vector, rate: Vector, dashpot: float, limit: float
) -> SpringForce:
    """Stretch a spring by a way, or an angle, and add a dashpot against its rate; neither passes the limit."""
    softness_before = 1.0 / stiffness_before if stiffness_before > 0.0 else 0.0
    kept = stiffness * softness_before if stiffness < stiffness_before else 1.0
    spring = minus(scaled(kept, before), scaled(stiffness, way))
    spring = clipped(spring, limit)
    # The mean of both forces times the way is the exact work of a linear spring; what of it is not stored afterwards
    # has been lost by sliding, or by a change of stiffness.
    given = 0.5 * dot(before, before) * softness_before - 0.5 * dot(plus(before, spring), way)
    total = clipped(minus(spring, scaled(dashpot, rate)), limit)
    slid = given - stored(dot(spring, spring), stiffness)
    return SpringForce(spring, total, slid, dot(minus(spring, total), rate))
