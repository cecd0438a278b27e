"""From restitution to the damping ratio of a Hertz contact, from which exactly that restitution comes out."""

import math
from functools import cache

from scipy.optimize import brentq


def restitution_of(damping_ratio: float) -> float:
    """Return the restitution of a Hertz contact with this damping ratio and no attraction.

    With w = sqrt(4 K / 5 m) overlap^(5/4) the damped Hertz collision is the linear oscillator w' = v,
    v' = -w - 2 zeta v, in its own time; contact ends where the total force w + 2 zeta v turns negative.
    Source: substitution of [Schwager-1998], with the no-tension end of [Schwager-2008].
    """
    zeta = damping_ratio
    if zeta == 0.0:
        return 1.0
    if zeta < 1.0:
        omega = math.sqrt(1.0 - zeta * zeta)
        angle = math.atan2(2.0 * zeta * omega, 2.0 * zeta * zeta - 1.0)
        return -math.exp(-zeta * angle / omega) * (math.cos(angle) - zeta * math.sin(angle) / omega)
    if zeta == 1.0:
        return math.exp(-2.0)
    omega = math.sqrt(zeta * zeta - 1.0)
    angle, slowness = 2.0 * math.log(zeta + omega), zeta / omega
    # cosh(angle) - slowness sinh(angle), with 1 - slowness written so that nothing cancels.
    rising = math.exp(angle * (1.0 - slowness)) / (omega * (omega + zeta))
    return 0.5 * (rising - math.exp(-angle * (1.0 + slowness)) * (1.0 + slowness))


@cache
def damping_ratio_of(restitution: float) -> float:
    """Return the damping ratio from which exactly this restitution comes out, at every speed."""
    if restitution == 1.0:
        return 0.0
    upper = 1.0
    while restitution_of(upper) > restitution:
        upper *= 2.0
    return float(brentq(lambda zeta: restitution_of(zeta) - restitution, 0.0, upper, xtol=1e-15, rtol=1e-14))
