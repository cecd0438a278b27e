"""The energy ledger."""

import numpy as np

from lithobrake.dem.bodies.arrays import DAMPING, FRICTION, ROLLING, Floats, Pairs


def kinetic(mass: Floats | float, velocity: Floats, spin: Floats, angular_momentum: Floats) -> Floats:
    """Return the kinetic energy [J] of bodies, shape [...], from vectors of shape [..., 3]."""
    energy: Floats = 0.5 * (mass * (velocity * velocity).sum(axis=-1) + (spin * angular_momentum).sum(axis=-1))
    return energy


def ledger(
    moving: float, mass: Floats, position: Floats, gravity: Floats, pairs: Pairs, lost: Floats
) -> dict[str, float]:
    """Return the energies [J] of a world from that of its motion, `moving`: kinetic, potential, elastic, cohesive, what
    damping, friction and rolling took, and the total.

    A Hertz contact holds 2/5 force times overlap, cohesion minus force times overlap, a spring half its force squared
    over its stiffness.
    """
    potential = -float((mass[:, None] * position * gravity).sum())
    touching = pairs.tangential_stiffness > 0.0
    spring_square = (pairs.spring[touching] ** 2).sum(axis=1)
    elastic = 0.4 * float((pairs.elastic_force * pairs.overlap).sum())
    elastic += 0.5 * float((spring_square / pairs.tangential_stiffness[touching]).sum())
    twisting = pairs.twist_stiffness > 0.0
    elastic += 0.5 * float((pairs.twist[twisting] ** 2 / pairs.twist_stiffness[twisting]).sum())
    rolling = pairs.roll_stiffness > 0.0
    elastic += 0.5 * float(((pairs.roll[rolling] ** 2).sum(axis=1) / pairs.roll_stiffness[rolling]).sum())
    parts = {
        "kinetic": moving, "potential": potential, "elastic": elastic,
        "cohesive": -float((pairs.cohesion * pairs.overlap).sum()), "damping": float(lost[DAMPING]),
        "friction": float(lost[FRICTION]), "rolling": float(lost[ROLLING]),
    }  # fmt: skip
    return {**parts, "total": float(np.sum(list(parts.values())))}
