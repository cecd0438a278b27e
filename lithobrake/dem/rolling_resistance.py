"""Rolling resistance of a contact, and its resistance to twisting and spinning: couples on the bodies."""

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.arrays import Pairs
from lithobrake.dem.tangential_spring import spring_force, stored, tangential_part, turned_spring, unloaded
from lithobrake.dem.vectors import Vector, dot, put, row, scaled

# Stiffness of rolling over that of the normal contact times the lever squared.
ROLLING_STIFFNESS = 2.25


@kernel
def resist_twisting(
    pair: int, pairs: Pairs, spin: float, limit: float, stiffness: float, damping_ratio: float, inverse_inertia: float,
    time_step: float,
) -> tuple[float, float, float]:  # fmt: skip
    """Return the couple about the normal on the second body, and what its spring and its dashpot took.

    A patch of more than one point resists twisting as its points would, each with its part of the tangential spring;
    spinning friction is the same with a lever of that coefficient times the contact radius. Writes to pairs.
    """
    before, stiffness_before = pairs.twist[pair], pairs.twist_stiffness[pair]
    angle = spin * time_step
    couple = min(max(unloaded(stiffness_before, stiffness) * before - stiffness * angle, -limit), limit)
    given = stored(before * before, stiffness_before) - 0.5 * (before + couple) * angle
    slid = given - stored(couple * couple, stiffness)
    pairs.twist[pair], pairs.twist_stiffness[pair] = couple, stiffness
    dashpot = 2.0 * damping_ratio * (stiffness / inverse_inertia) ** 0.5
    total = min(max(couple - dashpot * spin, -limit), limit)
    return total, slid, (couple - total) * angle


@kernel
def resist_rolling(
    pair: int, pairs: Pairs, normal: Vector, spin: Vector, twist: float, lever: float, force: float, stiffness: float,
    damping_ratio: float, inverse_inertia: float, time_step: float,
) -> tuple[Vector, float]:  # fmt: skip
    """Return the rolling couple on the second body, and what it took [J].

    A spring of 2.25 times the normal stiffness times the lever squared, the lever being rolling friction times contact
    radius, up to lever times normal force, with a dashpot of the contact's damping ratio.
    Source: [Ai-2011], model C. Writes to pairs.
    """
    before = turned_spring(row(pairs.roll, pair), row(pairs.normal, pair), normal, twist * time_step)
    rolling = ROLLING_STIFFNESS * stiffness * lever * lever
    dashpot = 2.0 * damping_ratio * (rolling / inverse_inertia) ** 0.5
    rate = tangential_part(spin, normal)
    held = spring_force(
        before, pairs.roll_stiffness[pair], rolling, scaled(time_step, rate), rate, dashpot, lever * force
    )
    put(pairs.roll, pair, held.spring)
    pairs.roll_stiffness[pair] = rolling
    return held.total, held.slid + held.damped * time_step


@kernel
def end_couples(pair: int, pairs: Pairs) -> tuple[float, float]:
    """End the couples of a contact; return what the twisting and the rolling spring held. Writes to pairs."""
    roll = row(pairs.roll, pair)
    twisted = stored(pairs.twist[pair] ** 2, pairs.twist_stiffness[pair])
    rolled = stored(dot(roll, roll), pairs.roll_stiffness[pair])
    put(pairs.roll, pair, (0.0, 0.0, 0.0))
    pairs.twist[pair], pairs.twist_stiffness[pair], pairs.roll_stiffness[pair] = 0.0, 0.0, 0.0
    return twisted, rolled
