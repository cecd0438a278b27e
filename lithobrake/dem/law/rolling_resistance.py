"""Rolling resistance of a contact: a couple across the normal on the bodies, within a lever times the repulsion."""

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import ROLLING, Bodies, Pairs
from lithobrake.dem.bodies.vectors import plus, put, row, scaled, tangential_part
from lithobrake.dem.law.contact_motion import RelativeMotion, inverse_inertia_across
from lithobrake.dem.law.hertz_spring import ContactSprings
from lithobrake.dem.law.restitution import PairLaw
from lithobrake.dem.law.tangential_spring import spring_force, turned_spring
from lithobrake.vocabulary.array_types import Vector

# Stiffness of rolling over that of the normal contact times the lever squared.
ROLLING_STIFFNESS = 2.25


@kernel
def resist_rolling(
    pair: int, bodies: Bodies, pairs: Pairs, normal: Vector, law: PairLaw, motion: RelativeMotion,
    springs: ContactSprings, repulsion: float, torque: Vector, time_step: float,
) -> Vector:  # fmt: skip
    """Return the torque on the second body with the couple against rolling. Writes to pairs.

    A spring of 2.25 times the normal stiffness times the lever squared, the lever being rolling friction times contact
    radius, up to lever times repulsion, with a dashpot of the contact's damping ratio.
    Source: [Ai-2011], model C.
    """
    lever = law.rolling_friction * springs.radius
    if lever == 0.0:
        return torque
    before = turned_spring(row(pairs.roll, pair), row(pairs.normal, pair), normal, motion.twist * time_step)
    rolling = ROLLING_STIFFNESS * springs.secant * lever * lever
    # The inertia that the couple really meets: it rings down at the material's own rate, whatever the lever.
    inverse_inertia = inverse_inertia_across(bodies, pairs.first[pair], pairs.second[pair], normal)
    dashpot = 2.0 * law.damping_ratio * (rolling / inverse_inertia) ** 0.5
    rate = tangential_part(motion.spin, normal)
    held = spring_force(
        before, pairs.roll_stiffness[pair], rolling, scaled(time_step, rate), rate, dashpot, lever * repulsion
    )
    put(pairs.roll, pair, held.spring)
    pairs.roll_stiffness[pair] = rolling
    pairs.lost[pair, ROLLING] += held.slid + held.damped * time_step
    return plus(torque, held.total)
