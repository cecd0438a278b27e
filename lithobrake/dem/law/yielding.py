"""Contacts that yield: Hertz up to a pressure, then a plastic core, and Hertz of a flatter contact on the way back.

Once the pressure at the middle has reached that at which the softer material yields, the force grows linearly. What is
deepest so far leaves a dent and flattens the contact; unloading, and loading again up to there, follow Hertz' law with
the flatter radius from the dent on. So a collision loses what the loop encloses, and never gains. The dent is kept
until the two are apart.

Source: [Thornton-1998]: force with a limiting contact pressure, and R_p F = R F_Hertz at the deepest overlap.
"""

import math
from typing import NamedTuple

from lithobrake.compilation.compiled import kernel
from lithobrake.dem.bodies.arrays import DAMPING, Pairs
from lithobrake.dem.law.restitution import PairLaw


class ElasticPart(NamedTuple):
    """What of a contact springs back: a Hertz contact of its own."""

    overlap: float  # m, not above 0 inside the dent
    radius: float  # m, R* of the flattened contact


class Dent(NamedTuple):
    """A contact that has yielded, at its deepest."""

    force: float  # N
    spring_back: float  # m, overlap that is elastic
    flatness: float  # R* over the radius of the flattened contact, at most 1
    lost: float  # J


@kernel
def dent_at(deepest: float, radius: float, law: PairLaw) -> Dent:
    """Return the dent that an overlap [m] leaves on a contact of a radius [m] that yields."""
    begins = radius * (0.5 * math.pi * law.yield_pressure / law.young_modulus) ** 2
    stiffness = 4.0 / 3.0 * law.young_modulus * radius**0.5
    if deepest <= begins:
        return Dent(stiffness * deepest**1.5, deepest, 1.0, 0.0)
    first, slope = stiffness * begins**1.5, math.pi * law.yield_pressure * radius
    more = deepest - begins
    force = first + slope * more
    flatness = force / (stiffness * deepest**1.5)
    spring_back = deepest * flatness
    work = 0.4 * first * begins + (first + 0.5 * slope * more) * more
    return Dent(force, spring_back, flatness, work - 0.4 * force * spring_back)


@kernel
def yield_to(pair: int, pairs: Pairs, overlap: float, radius: float, law: PairLaw) -> ElasticPart:
    """Deepen the dent of a contact at an overlap [m], book what that takes, and return what springs back.

    Writes to pairs.
    """
    before = pairs.deepest[pair]
    dent = dent_at(max(before, overlap), radius, law)
    if overlap > before:
        old = dent_at(before, radius, law)
        # Cohesion pulls over the whole way, and is given back over the elastic one.
        sunk = (overlap - dent.spring_back) - (before - old.spring_back)
        cohesion = law.cohesion_force + law.cohesion_line * radius
        pairs.lost[pair, DAMPING] += dent.lost - old.lost + cohesion * sunk
        pairs.deepest[pair] = overlap
    left = max(before, overlap) - dent.spring_back
    return ElasticPart(overlap - left, radius / dent.flatness)
